// Is what a receiver wrote what a sender sent?
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/formats/media/live/soak_truth.h"

namespace animeme::test {

struct TextFrame {
  std::int64_t number = 0;
  Values values{};
};

/// Frames of a FAP text, which may end anywhere: a program that was killed wrote it.
inline std::vector<TextFrame> read_frames(const std::string& path) {
  std::ifstream in(path);
  std::string line, mask_line;
  std::getline(in, line);
  std::vector<TextFrame> frames;
  while (std::getline(in, mask_line) && std::getline(in, line)) {
    std::istringstream mask(mask_line), numbers(line);
    TextFrame frame;
    numbers >> frame.number;
    bool whole = true;
    for (int fap = 1; fap <= kFaps; ++fap) {
      int there = 0;
      whole = whole && bool(mask >> there);
      if (there == 0) continue;
      const int count = fap == 1 ? 4 : fap == 2 ? 6 : 1;
      for (int i = 0, value = 0; i < count; ++i) {
        whole = whole && bool(numbers >> value);
        if (fap > 2) frame.values[std::size_t(fap)] = value;
      }
    }
    if (whole) frames.push_back(frame);
  }
  return frames;
}

/// What there is to say of recordings.
struct Verdict {
  std::int64_t frames = 0, right = 0;
  std::int64_t unknown = 0;  ///< at the edge of a run of the sender, where the truth ends, too
  std::int64_t wrong = 0;
  std::set<std::size_t> runs;      ///< of the sender, that were heard
  std::vector<std::int64_t> late;  ///< planes of a run before the first that was heard
  std::vector<std::string> notes;
};

/// Walks along the frames of a recording and the planes that were sent. Frames follow planes one by
/// one; where they do not, a plane must be found from which on they do again.
class Judge {
 public:
  Judge(const std::vector<SentPlanes>& runs, Verdict& verdict) : runs_(runs), verdict_(verdict) {}

  void look_at(const std::string& path) {
    frames_ = read_frames(path);
    path_ = path;
    run_ = 0;
    plane_ = 0;
    followed_ = false;
    for (std::size_t i = 0; i < frames_.size();) {
      if (follows(i) || found(i)) {
        ++verdict_.right;
        last_ = frames_[i++].number;
        continue;
      }
      i = pass_over(i);
    }
    verdict_.frames += std::int64_t(frames_.size());
  }

 private:
  // The truth may miss what a sender said in its last instants, and what it said before the
  // connection was there.
  static constexpr std::int64_t kEdge = 10;  // planes
  static constexpr std::size_t kSure = 4;    // frames that must agree

  bool follows(std::size_t i) {
    if (!followed_) return false;
    const std::int64_t step = frames_[i].number - last_;
    const std::int64_t plane = plane_ + step;
    const auto& planes = runs_[run_].planes;
    if (step <= 0 || plane >= std::int64_t(planes.size())) return false;
    if (planes[std::size_t(plane)] != frames_[i].values) return false;
    plane_ = plane;
    return true;
  }
  /// How many frames from `i` on are the planes from `plane` on. Those behind the end of what is
  /// known of the run make it sure, too.
  std::size_t agreeing(std::size_t run, std::int64_t plane, std::size_t i) const {
    const auto& planes = runs_[run].planes;
    for (std::size_t k = 0; i + k < frames_.size(); ++k) {
      const std::int64_t at = plane + frames_[i + k].number - frames_[i].number;
      const bool beyond = at >= std::int64_t(planes.size());
      if (!beyond && planes[std::size_t(at)] == frames_[i + k].values) continue;
      const bool ends = beyond || at + kEdge >= std::int64_t(planes.size());
      return k > 0 && ends ? std::max(k, kSure) : k;
    }
    return std::max(frames_.size() - i, kSure);
  }
  /// Frame `i` in what was sent, where most of what follows agrees: a face at rest is found
  /// everywhere. Ahead of what was reached, if it is there.
  bool found(std::size_t i) {
    std::size_t most = 0, best_run = 0;
    std::int64_t best_plane = 0;
    const auto search = [&](std::size_t first_run, std::int64_t first_plane) {
      for (std::size_t run = first_run; run < runs_.size(); ++run) {
        const auto& planes = runs_[run].planes;
        std::int64_t plane = run == first_run ? first_plane : 0;
        for (; plane < std::int64_t(planes.size()); ++plane) {
          const std::size_t count = agreeing(run, plane, i);
          if (count <= most) continue;
          most = count;
          best_run = run;
          best_plane = plane;
        }
      }
    };
    search(run_, followed_ ? plane_ + 1 : 0);
    if (most <= kSure) search(0, 0);
    if (most < kSure) return false;
    const bool next = followed_ && best_run == run_ + 1;
    run_ = best_run;
    plane_ = best_plane;
    followed_ = true;
    verdict_.runs.insert(run_);
    if (next) verdict_.late.push_back(plane_);
    return true;
  }
  /// Frames that nobody is known to have sent; the next one that is.
  std::size_t pass_over(std::size_t i) {
    const std::size_t begin = i;
    const bool at_end = followed_ && plane_ + 1 + kEdge >= std::int64_t(runs_[run_].planes.size());
    do {
      ++i;
    } while (i < frames_.size() && !found(i));
    const auto count = std::int64_t(i - begin);
    // Before the truth listened: a run whose first plane is missing there.
    const bool at_begin = i < frames_.size() && runs_[run_].first > 0.02 && plane_ <= kEdge;
    if ((at_end && count <= kEdge) || at_begin || (i == frames_.size() && count <= kEdge)) {
      verdict_.unknown += count;
    } else {
      verdict_.wrong += count;
      std::ostringstream note;
      note << path_ << ": " << count << " frames from number " << frames_[begin].number
           << " on are none of the sender's; reached plane " << plane_ << " of "
           << runs_[run_].planes.size() << " of run " << run_;
      verdict_.notes.push_back(note.str());
    }
    if (i < frames_.size()) {  // found() stands there
      ++verdict_.right;
      last_ = frames_[i++].number;
    }
    return i;
  }

  const std::vector<SentPlanes>& runs_;
  Verdict& verdict_;
  std::vector<TextFrame> frames_;
  std::string path_;
  std::size_t run_ = 0;
  std::int64_t plane_ = 0, last_ = 0;  // plane of the frame `last_`
  bool followed_ = false;
};

}  // namespace animeme::test

#include "dam/speaking/viseme_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

#include "dam/speaking/shown_phones_internal.h"
#include "dam/speaking/viseme_curves.h"
#include "fap/tables.h"
#include "fap/viseme.h"

namespace animeme::dam {
namespace {

constexpr std::array<int, 13> kMouthFaps = {3, 4, 5, 6, 8, 10, 12, 51, 52, 53, 55, 57, 59};
constexpr int kBlendStep = 3;  // 0, 3 ... 63: finer than players show
constexpr int kFullBlend = 63;
constexpr std::size_t kMostStates = 64;  // a frame; the nearest ones
constexpr double kSpeedWeight = 2;       // of a jump against an error that stays
constexpr double kContact = 1e6;         // FAP units squared, for a contact that is not made
constexpr double kBeside = 0.05;         // seconds: sounds so near are candidates
// FAP units squared, for a viseme that is shown though the script does not say it, or the reverse:
// lips that are less round than those of the table are still no N.
constexpr double kSaid = 3e5;

using Mouth = std::array<double, kMouthFaps.size()>;

struct Sound {
  double start = 0;
  double end = 0;
  int viseme = 0;
  bool contact = false;
};

// What is shown in a frame, and the state of the frame before that leads here; small, since those
// of the whole clip are kept.
struct Step {
  std::uint8_t first = 0;
  std::uint8_t second = 0;
  std::uint8_t blend = 0;  // of first
  std::uint8_t from = 0;
};

struct State {
  Step step;
  Mouth error{};  // shown - wanted
  double cost = 0;
};

Mouth mouth_of(const fap::Frame& frame) {
  Mouth mouth{};
  for (std::size_t i = 0; i < mouth.size(); ++i) {
    mouth[i] = frame.value[std::size_t(kMouthFaps[i])];
  }
  return mouth;
}

double square(const Mouth& a) { return std::inner_product(a.begin(), a.end(), a.begin(), 0.0); }

double square_of_difference(const Mouth& a, const Mouth& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

std::vector<Sound> sounds_of(const Script& script) {
  std::vector<Sound> sounds;
  for (const internal::ShownPhone& phone : internal::shown_phones(script)) {
    if (phone.first == phone.last) {
      const bool contact = phone.own != nullptr && (phone.first == 1 || phone.first == 2);
      sounds.push_back({phone.start, phone.end, phone.first, contact});
      continue;
    }
    const double middle = (phone.start + phone.end) / 2;
    sounds.push_back({phone.start, middle, phone.first, false});
    sounds.push_back({middle, phone.end, phone.last, false});
  }
  return sounds;
}

bool cheaper(const State& a, const State& b) { return a.cost < b.cost; }

class VisemePath {
 public:
  VisemePath(const Script& script, const fap::Sequence& clip)
      : clip_(clip), sounds_(sounds_of(script)), said_(script) {
    for (int v = 0; v < fap::kVisemeCount; ++v) {
      shapes_[std::size_t(v)] = mouth_of(fap::viseme_shape(v));
    }
    find_contacts();
  }

  std::vector<fap::Viseme> best() {
    if (clip_.frames.empty()) return {};
    rest_ = mouth_of(clip_.frames.front());
    std::vector<std::vector<Step>> steps(clip_.frames.size());
    std::vector<State> before;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      std::vector<State> now = states(i);
      if (i > 0) reach(before, now);
      steps[i].reserve(now.size());
      for (const State& state : now) steps[i].push_back(state.step);
      before = std::move(now);
    }
    const auto best = std::min_element(before.begin(), before.end(), cheaper);
    return way_back(steps, std::size_t(best - before.begin()));
  }

 private:
  // The frame nearest to the middle of a contact has to show it in full; -1 in all others.
  void find_contacts() {
    contact_.assign(clip_.frames.size(), -1);
    for (const Sound& sound : sounds_) {
      if (!sound.contact) continue;
      const double middle = (sound.start + sound.end) / 2 * clip_.rate.frames_per_second();
      const auto at = std::size_t(std::max(0LL, std::llround(middle)));
      if (at < contact_.size()) contact_[at] = sound.viseme;
    }
    if (contact_.empty() || sounds_.empty()) return;
    // The clip begins and ends at rest.
    if (sounds_.front().viseme == 0) contact_.front() = 0;
    if (sounds_.back().viseme == 0) contact_.back() = 0;
  }

  std::vector<int> candidates(double time) {
    std::vector<int> visemes;
    while (near_ + 1 < sounds_.size() && sounds_[near_].end <= time) ++near_;
    const auto add = [&](std::size_t i) {
      if (i >= sounds_.size()) return;
      const int viseme = sounds_[i].viseme;
      if (std::find(visemes.begin(), visemes.end(), viseme) == visemes.end()) {
        visemes.push_back(viseme);
      }
    };
    add(near_);
    add(near_ - 1);
    add(near_ + 1);
    // Further ones if the sounds between are shorter than a glance.
    for (std::size_t i = near_ + 2; i < sounds_.size() && sounds_[i].start < time + kBeside; ++i) {
      add(i);
    }
    for (std::size_t i = near_ - 2; i < sounds_.size() && sounds_[i].end > time - kBeside; --i) {
      add(i);
    }
    if (visemes.size() < 2) visemes.push_back(visemes.empty() || visemes[0] != 0 ? 0 : 1);
    if (visemes.size() < 2) visemes.push_back(1);
    return visemes;
  }

  std::vector<State> states(std::size_t frame) {
    Mouth wanted = mouth_of(clip_.frames[frame]);
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] -= rest_[i];
    const double time = clip_.rate.seconds(double(clip_.frames[frame].number));
    const std::vector<int> visemes = candidates(time);
    const fap::VisemeWeights said = said_.at(time);
    std::vector<State> all;
    for (std::size_t a = 0; a < visemes.size(); ++a) {
      for (std::size_t b = a + 1; b < visemes.size(); ++b) {
        for (int blend = 0; blend <= kFullBlend; blend += kBlendStep) {
          all.push_back(make(visemes[a], visemes[b], blend, wanted, said, contact_[frame]));
        }
      }
    }
    if (all.size() > kMostStates) {
      std::stable_sort(all.begin(), all.end(), cheaper);
      all.resize(kMostStates);
    }
    return all;
  }

  State make(int first, int second, int blend, const Mouth& wanted, const fap::VisemeWeights& said,
             int contact) const {
    State state;
    state.step = {std::uint8_t(first), std::uint8_t(second), std::uint8_t(blend), 0};
    const double share = double(blend) / kFullBlend;
    const Mouth& a = shapes_[std::size_t(first)];
    const Mouth& b = shapes_[std::size_t(second)];
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      state.error[i] = share * a[i] + (1 - share) * b[i] - wanted[i];
    }
    state.cost = square(state.error) + kSaid * difference(first, second, share, said);
    if (contact >= 0) {
      const double shown = (first == contact ? share : 0) + (second == contact ? 1 - share : 0);
      state.cost += kContact * (1 - shown);
    }
    return state;
  }

  // Squares of what each viseme has too much or too little of.
  static double difference(int first, int second, double share, const fap::VisemeWeights& said) {
    double sum = 0;
    for (int v = 0; v < fap::kVisemeCount; ++v) {
      const double shown = v == first ? share : v == second ? 1 - share : 0;
      sum += (shown - said[std::size_t(v)]) * (shown - said[std::size_t(v)]);
    }
    return sum;
  }

  static void reach(const std::vector<State>& before, std::vector<State>& now) {
    for (State& state : now) {
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < before.size(); ++i) {
        const double cost =
            before[i].cost + kSpeedWeight * square_of_difference(before[i].error, state.error);
        if (cost >= best) continue;
        best = cost;
        state.step.from = std::uint8_t(i);
      }
      state.cost += best;
    }
  }

  static std::vector<fap::Viseme> way_back(const std::vector<std::vector<Step>>& steps,
                                           std::size_t at) {
    std::vector<fap::Viseme> track(steps.size());
    for (std::size_t frame = steps.size(); frame-- > 0;) {
      const Step& step = steps[frame][at];
      track[frame] = {step.first, step.second, step.blend, false};
      at = step.from;
    }
    for (std::size_t frame = 1; frame < track.size(); ++frame) {
      keep_order(track[frame - 1], track[frame]);
    }
    return track;
  }

  static void keep_order(const fap::Viseme& before, fap::Viseme& now) {
    const bool crossed = before.select1 == now.select2 || before.select2 == now.select1;
    const bool straight = before.select1 == now.select1 || before.select2 == now.select2;
    if (!crossed || straight) return;
    std::swap(now.select1, now.select2);
    now.blend = kFullBlend - now.blend;
  }

  const fap::Sequence& clip_;
  std::vector<Sound> sounds_;
  VisemeCurves said_;
  std::array<Mouth, fap::kVisemeCount> shapes_{};
  Mouth rest_{};
  std::vector<int> contact_;
  std::size_t near_ = 0;
};

}  // namespace

std::vector<fap::Viseme> viseme_track(const Script& script, const fap::Sequence& clip) {
  return VisemePath(script, clip).best();
}

void show_visemes(const Script& script, fap::Sequence& clip, VisemePlace place) {
  const std::vector<fap::Viseme> track = viseme_track(script, clip);
  for (std::size_t i = 0; i < track.size(); ++i) {
    fap::Frame& frame = clip.frames[i];
    for (const fap::FapInfo& fap : fap::kFaps) {
      const bool mouth = fap.group == 2 || fap.group == 6 || fap.group == 8;
      if (place != VisemePlace::instead || !mouth) continue;
      frame.mask.reset(std::size_t(fap.number));
      frame.value[std::size_t(fap.number)] = 0;
    }
    frame.mask.set(1);
    frame.viseme = track[i];
  }
}

}  // namespace animeme::dam

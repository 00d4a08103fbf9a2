#include "tools/characters/capture/build_corpus.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "tools/characters/capture/corpus_sentence_internal.h"
#include "tools/characters/capture/corpus_signal.h"
#include "tools/characters/capture/cut.h"
#include "tools/characters/capture/tracked_cache.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/file_lock.h"
#include "tools/formats/files/files.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/speech/voice/align.h"

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

constexpr double kLeastMeasured = 0.5;  // of the frames of a sentence
class Builder {
 public:
  Builder(const CorpusPlan& plan, const Log& log, const Progress& progress)
      : plan_(plan), log_(log), progress_(progress), capture_(plan.capture) {}

  Result<CorpusReport> build() {
    auto takes = find_takes(plan_.places);
    if (!takes) return std::move(takes).error();
    report_.folder = plan_.output;
    report_.left_out = std::move(takes->left_out);
    if (auto ok = somebody_tracks(takes->takes); !ok) return ok.error();
    if (auto ok = make_folder(plan_.output, ""); !ok) return ok.error();
    const auto lock = FileLock::take(plan_.output + "/corpus");
    if (!lock) return lock.error();
    if (auto ok = read(takes->takes); !ok) return ok.error();
    if (auto ok = measure(); !ok) return ok.error();
    listen();
    same_rate();
    cut();
    check();
    if (sentences_.empty()) return nothing_left();
    if (auto ok = write_corpus(plan_, sentences_, rest_, report_); !ok) return ok.error();
    return std::move(report_);
  }

 private:
  // Videos alone, nobody who tracks them, and nothing that was tracked before: said once.
  Result<void> somebody_tracks(const std::vector<Take>& takes) const {
    std::error_code none;
    if (plan_.capture.tracker || takes.empty() ||
        fs::is_directory(fs::path(plan_.output) / "tracked", none) ||
        std::any_of(takes.begin(), takes.end(), [](const Take& t) { return !t.table.empty(); })) {
      return {};
    }
    auto refused = read_capture_table(takes[0].video, plan_.capture, log_);
    if (refused) return {};
    return std::move(refused).error();
  }

  void leave_out(const Take& take, const char* stage, const Error& error) {
    report_.left_out.push_back({take.id, stage, error.describe()});
    log_.warn(take.id + ": left out: " + error.describe());
  }

  // The tables, from files or trackers: most of the time goes here.
  Result<void> read(const std::vector<Take>& takes) {
    for (std::size_t i = 0; i < takes.size(); ++i) {
      if (progress_.stop()) {
        return make_error(Code::io, "stopped; what was tracked is kept, the same command goes on");
      }
      const auto at = [&, i](double share) {
        progress_.at(0.9 * (double(i) + share) / double(takes.size()));
      };
      at(0);
      capture_.tracking = {at, progress_.stop};
      Sentence sentence{takes[i], {}, {}, 0, {}, {}, {}};
      sentence.report.id = takes[i].id;
      const char* stage = "track";
      if (auto ok = read_one(sentence, stage); !ok) {
        leave_out(takes[i], stage, ok.error());
      } else {
        sentences_.push_back(std::move(sentence));
      }
    }
    return {};
  }

  Result<void> read_one(Sentence& sentence, const char*& stage) {
    const Take& take = sentence.take;
    TrackedTable table;
    std::optional<VideoFile> video;
    if (!take.video.empty()) {
      auto seen = look_at_video(take.video);
      if (!seen && take.table.empty()) return seen.error();
      if (seen) video = *seen;
    }
    if (video) sentence.shift = video->picture_after_sound;
    TrackedCache cache{plan_.output + "/tracked", plan_.track_again};
    if (!take.table.empty()) {
      auto read = read_capture_table(take.table, plan_.capture, log_);
      if (!read) return read.error();
      table.text = std::move(read->text);
      sentence.report.source = "table";
    } else if (auto before = cache.find(take.id, take.video, plan_.capture)) {
      table.text = std::move(*before);
      sentence.report.source = "tracked before";
    } else {
      auto read = read_capture_table(take.video, capture_, log_);
      if (!read) return read.error();
      table.text = std::move(read->text);
      sentence.report.source = "tracked";
    }
    table.video = video;
    stage = "import";
    const std::string& name = take.table.empty() ? take.video : take.table;
    auto capture = parse_capture(table, name, plan_.capture);
    if (!capture) return capture.error();
    sentence.capture = std::move(*capture);
    if (sentence.report.source != "tracked") return {};
    stage = "track";
    return cache.keep(take.id, take.video, plan_.capture, table.text);
  }

  // FAPs of all, against one neutral face.
  Result<void> measure() {
    if (sentences_.empty()) return nothing_left();
    std::vector<Capture> captures;
    for (const Sentence& sentence : sentences_) captures.push_back(sentence.capture);
    leave_out_other_points(captures);
    const auto rest = neutral_face(plan_.neutral, captures, plan_.capture, log_);
    if (!rest) return rest.error();
    rest_ = *rest;
    report_.neutral = !plan_.neutral.face_file.empty() ? "of " + plan_.neutral.face_file
                      : !plan_.neutral.from.empty()    ? "of " + plan_.neutral.from
                                                       : "of all recordings together";
    keep([&](Sentence& sentence) { return measure_one(sentence); }, "import");
    return {};
  }

  // One neutral face is for the same points: those that most recordings have.
  void leave_out_other_points(std::vector<Capture>& captures) {
    std::map<std::vector<std::string>, std::size_t> counts;
    for (const Capture& capture : captures) {
      if (capture.points) ++counts[capture.points->track.points];
    }
    if (counts.size() < 2 || !plan_.neutral.face_file.empty() || !plan_.neutral.from.empty()) {
      return;
    }
    const auto most =
        std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        })->first;
    captures.clear();
    keep(
        [&](Sentence& sentence) -> Result<void> {
          const auto& points = sentence.capture.points;
          if (points && points->track.points != most) {
            return make_error(Code::invalid_argument,
                              "it has other points than most recordings; --face-file or "
                              "use --neutral-from to include it");
          }
          captures.push_back(sentence.capture);
          return {};
        },
        "import");
  }

  Result<void> measure_one(Sentence& sentence) {
    if (rest_ && sentence.capture.points) {
      // What it would have been measured in alone.
      const auto own = exchange::common_face({*sentence.capture.points}, plan_.capture.landmarks);
      if (own) sentence.report.own_units = own->fapu;
    }
    const bool points = sentence.capture.points.has_value();
    auto face = face_of_capture(std::move(sentence.capture), plan_.capture, rest_);
    if (!face) return face.error();
    sentence.report.warnings = face->warnings;
    if (points && !rest_) rest_ = face->points->face.rest;
    if (points && !report_.units) report_.units = rest_->fapu;
    return take_curves(sentence, *face);
  }

  Result<void> take_curves(Sentence& sentence, const CapturedFace& face) {
    const Take& take = sentence.take;
    const std::string sound = !take.sound.empty() ? take.sound : take.video;
    if (!sound.empty()) {
      auto pcm = speech::read_voice(sound, log_, voice::kAlignRate);
      const bool silent = !pcm && pcm.error().code == Code::not_found && take.sound.empty();
      if (!pcm && !silent) return pcm.error();
      if (pcm && !pcm->samples.empty()) sentence.sound = std::move(*pcm);
    }
    // Times of a capture that lie within the sound are those of the recording.
    const double length = face.clip.rate.seconds(double(face.clip.frames.back().number + 1));
    double start = face.start.value_or(0);
    const double end = sentence.sound ? sentence.sound->duration() + kSlackOfScript : length;
    if (start < 0 || start + length > end + kSlackOfScript) start = 0;
    const double seconds = sentence.sound ? sentence.sound->duration() : 0;
    auto signal = curves_of(face, start + sentence.shift, seconds);
    if (!signal) return signal.error();
    sentence.signal = std::move(*signal);
    return check_measured(sentence);
  }

  Result<void> check_measured(const Sentence& sentence) {
    const double share =
        double(measured_frames(sentence.signal)) / double(sentence.signal.frames());
    if (share >= kLeastMeasured) return {};
    return make_error(Code::truncated,
                      format("there is a face in %.0f %% of its frames only", 100 * share));
  }

  // Scripts, given or by the aligner.
  void listen() {
    std::size_t done = 0;
    const std::size_t count = sentences_.size();
    keep(
        [&](Sentence& sentence) {
          progress_.at(0.9 + 0.1 * double(done++) / double(count));
          return get_script(plan_, sentence);
        },
        "align");
  }

  // The rate and the curves that all sentences have.
  void same_rate() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> counts;
    for (const Sentence& s : sentences_) ++counts[{s.signal.rate.num, s.signal.rate.den}];
    if (counts.empty()) return;
    const auto most =
        std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        })->first;
    report_.rate = fap::Rate{most.first, most.second};
    std::vector<dam::Signal*> signals;
    std::size_t widest = 0;
    for (Sentence& sentence : sentences_) {
      if (!(sentence.signal.rate == report_.rate)) {
        sentence.report.warnings.push_back(
            format("its %g frames a second are made %g, as most recordings have",
                   sentence.signal.rate.frames_per_second(), report_.rate.frames_per_second()));
        sentence.signal = at_rate(sentence.signal, report_.rate);
      }
      widest = std::max(widest, sentence.signal.names.size());
      signals.push_back(&sentence.signal);
    }
    report_.controls = keep_common_controls(signals);
    if (report_.controls.size() < widest) {
      report_.warnings.push_back(format("%zu curves that not all recordings have are left out",
                                        widest - report_.controls.size()));
    }
  }

  // Long recordings become sentences, ID_001 and so on.
  void cut() {
    std::vector<Sentence> all;
    for (Sentence& sentence : sentences_) {
      const dam::Signal& signal = sentence.signal;
      const auto parts =
          cut_at_pauses(sentence.script, signal.rate, signal.frames(), plan_.longest);
      if (parts.size() == 1) {
        all.push_back(std::move(sentence));
        continue;
      }
      for (std::size_t i = 0; i < parts.size(); ++i) {
        all.push_back(part_of(sentence, parts[i], i));
      }
    }
    sentences_ = std::move(all);
    keep([&](Sentence& sentence) { return check_measured(sentence); }, "check");
  }

  void check() {
    std::vector<double> rates;
    for (const Sentence& sentence : sentences_) rates.push_back(phone_rate(sentence.script));
    std::sort(rates.begin(), rates.end());
    const double usual = rates.size() < 5 ? 0 : rates[rates.size() / 2];
    keep(
        [&](Sentence& sentence) -> Result<void> {
          SentenceReport& report = sentence.report;
          report.closures = closures_of(sentence.signal, sentence.script);
          for (std::string& text : doubts_about(sentence.script, report.closures, usual)) {
            report.doubts.push_back(std::move(text));
          }
          report.frames = sentence.signal.frames();
          report.filled = report.frames - measured_frames(sentence.signal);
          report.seconds = sentence.signal.rate.seconds(double(report.frames));
          report.phones = sentence.script.phones.size();
          if (plan_.strict && !report.doubts.empty()) {
            return make_error(Code::invalid_argument, "doubtful: " + report.doubts.front());
          }
          return {};
        },
        "check");
    std::vector<const dam::Signal*> signals;
    std::vector<const dam::Script*> scripts;
    for (const Sentence& sentence : sentences_) {
      signals.push_back(&sentence.signal);
      scripts.push_back(&sentence.script);
    }
    report_.lag = lag_of_lips(signals, scripts);
  }

  // Takes out what `work` fails for.
  template <class Work>
  void keep(Work work, const char* stage) {
    std::vector<Sentence> kept;
    for (Sentence& sentence : sentences_) {
      if (auto ok = work(sentence); !ok) {
        leave_out(sentence.take, stage, ok.error());
      } else {
        kept.push_back(std::move(sentence));
      }
    }
    sentences_ = std::move(kept);
  }

  Error nothing_left() const {
    std::string why;
    if (!report_.left_out.empty()) {
      // Files without a partner may not have been meant.
      const auto tried = std::find_if(report_.left_out.begin(), report_.left_out.end(),
                                      [](const LeftOut& one) { return one.stage != "files"; });
      const LeftOut& first = tried == report_.left_out.end() ? report_.left_out.front() : *tried;
      why = "; " + first.id + ": " + first.why;
      if (report_.left_out.size() > 1) {
        why += format(" (and %zu more)", report_.left_out.size() - 1);
      }
    }
    return make_error(Code::not_found, "no recording is left" + why);
  }

  const CorpusPlan& plan_;
  const Log& log_;
  const Progress& progress_;
  CaptureSettings capture_;  // with the progress of the tracker
  std::vector<Sentence> sentences_;
  std::optional<fap::RestingFace> rest_;
  CorpusReport report_;
};

}  // namespace

Result<CorpusReport> build_corpus(const CorpusPlan& plan, const Log& log,
                                  const Progress& progress) {
  return Builder(plan, log, progress).build();
}

}  // namespace animeme::tools

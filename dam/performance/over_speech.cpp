#include "dam/performance/over_speech.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dam/maths/raised_cosine.h"
#include "dam/signal/fap_signal.h"
#include "fap/edit.h"
#include "fap/tables.h"

namespace animeme::dam {
namespace {

constexpr double kOverFade = 0.6, kOverLidFade = 0.3, kOverLongestFade = 4;  // seconds
constexpr double kOverOfFastest = 0.25;  // of the performance, in a fade
constexpr double kOverSmileFade = 1.5;   // seconds
// Of the fastest motion of the lips in the speech; FAP units a second.
constexpr double kOverOfSpeech = 0.1, kOverOfPlayed = 0.5, kOverLeastSpeed = 200;
constexpr double kOverSpokenPuff = 0.2;  // cheeks keep of their air in speech

bool is_lid(int fap) { return fap >= 19 && fap <= 22; }
bool is_puff(int fap) { return fap == 39 || fap == 40; }

// A raised cosine is steepest in its middle: pi / 2 of its mean speed.
double fade_seconds(double offset, double fastest, int fap) {
  constexpr double kOverSteepest = 1.5708;
  const double least = is_lid(fap) ? kOverLidFade : kOverFade;
  if (!(fastest > 0)) return least;
  return std::clamp(kOverSteepest * std::abs(offset) / (kOverOfFastest * fastest), least,
                    kOverLongestFade);
}

// What is kept of a performance at all.
fap::Mask kept_faps(const Performance& performance, const KeptShares& keep) {
  fap::Mask kept;
  for (std::size_t fap = fap::kFirstLowLevel; fap < kept.size(); ++fap)
    kept[fap] = performance.faps()[fap] && keep.of[fap] > 0;
  return kept & ~fap::region_faps("tongue").value_or(fap::Mask());
}

// The mouth of a performance at a moment, without its speech.
MoodPose slow_mouth(const Performance& performance, const KeptShares& keep, const fap::Mask& kept,
                    double moment, double share) {
  MoodPose pose;
  if (!(share > 0)) return pose;
  for (std::size_t fap = fap::kFirstLowLevel; fap < kept.size(); ++fap) {
    if (kept[fap] && spoken_faps()[fap])
      pose.fap[fap] = share * keep.of[fap] * performance.slow(int(fap), moment);
  }
  return pose;
}

// Sampling at another rate must not miss a blink.
double lid_window(const Performance& performance, const fap::Rate& rate) {
  return performance.rate() == rate ? 0 : rate.seconds(0.5);
}

double coded_range(int fap) {
  const fap::FapInfo& info = fap::info(fap);
  return double(info.default_i_range) * double(info.quant_step);
}

/// FapColumns of a signal by FAP; adds those that are missing.
class FapColumns {
 public:
  FapColumns(Signal& signal, const fap::Mask& wanted) : before_(signal.names.size()) {
    at_.fill(-1);
    for (std::size_t c = 0; c < before_; ++c) {
      const int fap = fap_of_channel(signal.names[c]);
      if (fap > 0) at_[std::size_t(fap)] = std::ptrdiff_t(c);
    }
    const std::size_t frames = signal.frames();
    for (std::size_t fap = fap::kFirstLowLevel; fap < at_.size(); ++fap) {
      if (!wanted[fap] || at_[fap] >= 0) continue;
      at_[fap] = std::ptrdiff_t(signal.names.size());
      signal.names.push_back(fap_channel(int(fap)));
    }
    std::vector<double> values(frames * signal.names.size(), 0.0);
    for (std::size_t i = 0; i < frames; ++i)
      std::copy_n(&signal.values[i * before_], before_, &values[i * signal.names.size()]);
    signal.values = std::move(values);
  }
  /// Was there before.
  bool own(std::size_t fap) const { return at_[fap] >= 0 && std::size_t(at_[fap]) < before_; }
  bool has(std::size_t fap) const { return at_[fap] >= 0; }
  std::size_t at(std::size_t fap) const { return std::size_t(at_[fap]); }

 private:
  std::size_t before_;
  std::array<std::ptrdiff_t, fap::kFapCount + 1> at_{};
};

Result<void> check_shares(const OverOptions& options) {
  if (!(options.bend >= 0 && options.bend <= kMostBend))
    return make_error(Code::invalid_argument, "the bend of time must lie between 0 and 0.25");
  for (const double share : options.keep.of)
    if (!(share >= 0 && share <= 1))
      return make_error(Code::invalid_argument, "what is kept must lie between 0 and 1");
  return {};
}

// Curves of ARKit become FAPs.
Result<void> need_faps(Signal& signal) {
  if (std::any_of(signal.names.begin(), signal.names.end(),
                  [](const std::string& name) { return fap_of_channel(name) != 0; }))
    return {};
  const auto clip = to_sequence(signal);
  if (!clip && clip.error().code == Code::not_found)
    return make_error(Code::unsupported,
                      "the controls of this model are neither FAPs nor ARKit shapes, so no "
                      "performance of a face can be put over them");
  if (!clip) return clip.error();
  auto converted = to_signal(*clip);
  if (!converted) return converted.error();
  signal = std::move(*converted);
  return {};
}

/// The mouth that a performance adds to speech. It comes and goes no faster than a tenth of the
/// fastest motion of the speech (of FAPs that the speech does not move: half of the fastest of the
/// performance), so that no step of the lips stands out: where sounds take it back, as closures do,
/// it has gone before.
class AddedMouth {
 public:
  AddedMouth(const Signal& signal, const FapColumns& columns, const fap::Mask& kept,
             const Performance& performance)
      : frames_(signal.frames()) {
    std::vector<double> played;  // largest step
    for (std::size_t fap = fap::kFirstLowLevel; fap < kept.size(); ++fap)
      if (kept[fap] && spoken_faps()[fap]) {
        columns_.push_back(columns.at(fap));
        played.push_back(kOverOfPlayed * performance.fastest(int(fap)) * signal.rate.seconds(1));
      }
    added_.resize(frames_ * columns_.size());
    most_.assign(columns_.size(), 0.0);
    for (std::size_t i = 1; i < frames_; ++i) {
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        const double step = signal.at(i, columns_[c]) - signal.at(i - 1, columns_[c]);
        most_[c] = std::max(most_[c], kOverOfSpeech * std::abs(step));
      }
    }
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (most_[c] == 0) most_[c] = played[c];
      most_[c] = std::max(most_[c], kOverLeastSpeed * signal.rate.seconds(1));
    }
  }
  /// What `layer` makes of the pose in frame `i`.
  void take(std::size_t i, const MoodLayer& layer, const MoodPose& pose,
            const MoodMouth::Shares& shares, std::span<const double> row) {
    moved_.assign(row.begin(), row.end());
    layer.add(pose, shares, moved_);
    for (std::size_t c = 0; c < columns_.size(); ++c)
      added_[i * columns_.size() + c] = moved_[columns_[c]] - row[columns_[c]];
  }
  void add_to(Signal& signal) const {
    std::vector<double> size(frames_);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const auto added = [&](std::size_t i) { return added_[i * columns_.size() + c]; };
      for (std::size_t i = 0; i < frames_; ++i) {
        size[i] = std::abs(added(i));
        if (i > 0) size[i] = std::min(size[i], size[i - 1] + most_[c]);
      }
      for (std::size_t i = frames_; i-- > 0;) {
        if (i + 1 < frames_) size[i] = std::min(size[i], size[i + 1] + most_[c]);
        signal.at(i, columns_[c]) += std::clamp(added(i), -size[i], size[i]);
      }
    }
  }

 private:
  std::size_t frames_;
  std::vector<std::size_t> columns_;
  std::vector<double> added_;  // frames x columns
  std::vector<double> most_;   // a frame, by column
  std::vector<double> moved_;
};

/// Idle motion frame by frame; nothing where it is off.
class IdleFace {
 public:
  static Result<IdleFace> make(const Signal& signal, const SpeechPlan& plan,
                               const OverOptions& over) {
    IdleFace idle;
    if (!over.idle || over.idle->liveliness <= 0) return idle;
    BehaviourOptions wanted{signal.rate, over.idle->seed, over.idle->liveliness, over.idle->still,
                            over.idle->look};
    wanted.end = signal.rate.seconds(double(signal.frames()));
    auto behaviour = Behaviour::make(wanted);
    if (!behaviour) return behaviour.error();
    behaviour->speak(plan);
    idle.behaviour_ = std::move(*behaviour);
    for (const int fap : behaviour_faps(wanted)) idle.faps_.set(std::size_t(fap));
    return idle;
  }
  const fap::Mask& faps() const { return faps_; }
  void step() {
    if (behaviour_) moment_ = behaviour_->next();
  }
  double value(std::size_t fap) const {
    return faps_[fap] ? behaviour_value(moment_, int(fap)) : 0.0;
  }

 private:
  std::optional<Behaviour> behaviour_;
  FaceMoment moment_;
  fap::Mask faps_;
};

}  // namespace

Result<OverReport> speak_over(Signal& signal, const Script& script, const Performance& performance,
                              const OverOptions& options) {
  if (signal.first_frame != 0)
    return make_error(Code::invalid_argument, "a performance can be put over whole clips only");
  if (auto ok = check_shares(options); !ok) return ok.error();
  if (auto ok = need_faps(signal); !ok) return ok.error();
  const Prosody* prosody = options.idle ? options.idle->prosody : nullptr;
  const SpeechPlan plan = plan_speech(script, prosody);
  auto idle = IdleFace::make(signal, plan, options);
  if (!idle) return idle.error();

  OverReport report;
  BendOptions bend;
  bend.length = performance.seconds();
  bend.wanted = signal.rate.seconds(double(signal.frames()));
  bend.rate = signal.rate;
  bend.most = options.bend;
  bend.fixed = performance.own_pace();
  report.time = bend_time(performance.plan(), plan, bend);
  report.end = std::min(report.time.moments().back().time, bend.wanted);
  report.kept = kept_faps(performance, options.keep);
  const FapColumns columns(signal, report.kept | idle->faps());
  for (std::size_t fap = fap::kFirstLowLevel; fap < report.filled.size(); ++fap)
    report.filled[fap] = idle->faps()[fap] && !report.kept[fap] && !columns.own(fap);

  const MoodMouth mouth(script);
  const MoodLayer layer(signal.names);
  AddedMouth added(signal, columns, report.kept, performance);
  const double window = lid_window(performance, signal.rate);
  const double last = performance.seconds() - performance.rate().seconds(1);
  std::array<double, fap::kFapCount + 1> pose_at_end{}, fade{};
  bool ended = false;
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const double time = signal.time(i);
    const double moment = report.time.source(time);
    const std::span<double> row(&signal.values[i * signal.names.size()], signal.names.size());
    const MoodMouth::Shares shares = mouth.at(time);
    idle->step();
    // Its last frame is the last pose that is known.
    const bool ends = moment > last + 1e-6 && !ended;
    for (std::size_t fap = fap::kFirstLowLevel; fap < report.kept.size(); ++fap) {
      if (report.filled[fap]) row[columns.at(fap)] = idle->value(fap);
      if (!report.kept[fap] || spoken_faps()[fap]) continue;
      double& value = row[columns.at(fap)];
      if (!columns.own(fap)) value = idle->value(fap);
      if (ends) {
        pose_at_end[fap] = performance.value(int(fap), last);
        fade[fap] = fade_seconds(pose_at_end[fap] - value, performance.fastest(int(fap)), int(fap));
      }
      const double share = options.keep.of[fap];
      double kept = 0;
      if (!ended && !ends) {
        kept = performance.value(int(fap), moment, window) - value;
      } else {
        kept = (pose_at_end[fap] - value) * raised_bell((time - report.end) / fade[fap]);
      }
      if (is_puff(int(fap))) kept *= 1 - (1 - kOverSpokenPuff) * shares.speech;
      value += share * kept;
    }
    ended = ended || ends;
    const double smile = ended ? raised_bell((time - report.end) / kOverSmileFade) : 1;
    const MoodPose pose =
        slow_mouth(performance, options.keep, report.kept, std::min(moment, last), smile);
    added.take(i, layer, pose, shares, row);
  }
  added.add_to(signal);
  return report;
}

PerformanceLoop::PerformanceLoop(std::shared_ptr<const Performance> performance,
                                 const KeptShares& keep, const fap::Rate& rate)
    : performance_(std::move(performance)),
      keep_(keep),
      kept_(kept_faps(*performance_, keep)),
      frame_(rate.seconds(1)) {}

double PerformanceLoop::kept_value(int fap, double moment) const {
  const double rate = performance_->rate().frames_per_second();
  const bool same = std::abs(rate * frame_ - 1) < 1e-9;
  return performance_->value(fap, moment, same ? 0 : frame_ / 2);
}

void PerformanceLoop::next(const MoodMouth::Shares& shares, fap::Frame& frame) {
  double moment = frame_ * double(count_);
  if (moment > performance_->seconds() - performance_->rate().seconds(1) + 1e-6 && count_ > 0) {
    count_ = 0;
    moment = 0;
    repeated_ = true;
    for (std::size_t fap = fap::kFirstLowLevel; fap < kept_.size(); ++fap) {
      if (!kept_[fap]) continue;
      const bool slow = spoken_faps()[fap];
      const double first = slow ? performance_->slow(int(fap), 0) : kept_value(int(fap), 0);
      fades_[fap].pose = shown_[fap];
      fades_[fap].seconds =
          slow ? kOverSmileFade
               : fade_seconds(shown_[fap] - first, performance_->fastest(int(fap)), int(fap));
    }
  }
  MoodPose pose;
  for (std::size_t fap = fap::kFirstLowLevel; fap < kept_.size(); ++fap) {
    if (!kept_[fap]) continue;
    const bool slow = spoken_faps()[fap];
    double value = slow ? performance_->slow(int(fap), moment) : kept_value(int(fap), moment);
    if (repeated_) {
      // The first frame behind the joint has already left the last pose.
      const double since = moment + frame_;
      value += (fades_[fap].pose - value) * raised_bell(since / fades_[fap].seconds);
    }
    shown_[fap] = value;
    if (slow) {
      pose.fap[fap] = keep_.of[fap] * value;
      continue;
    }
    if (is_puff(int(fap))) value *= 1 - (1 - kOverSpokenPuff) * shares.speech;
    const double own = frame.value[fap], share = keep_.of[fap];
    const double range = coded_range(int(fap));
    frame.set(int(fap),
              std::int32_t(std::lround(std::clamp(own + share * (value - own), -range, range))));
  }
  add_mood(pose, shares, frame);
  frame.mask |= kept_;
  ++count_;
}

}  // namespace animeme::dam

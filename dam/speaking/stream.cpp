#include "dam/speaking/stream.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dam/maths/raised_cosine.h"
#include "dam/model/kind_internal.h"
#include "dam/script/phones.h"
#include "dam/signal/mouth_opening.h"
#include "dam/speaking/frames_internal.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/tongue.h"

namespace animeme::dam {
namespace {

constexpr double kClosureReach = 0.5;  // seconds: half a phone, its search, hold and slopes
constexpr double kBehind = 0.7;        // seconds made anew before a piece, for the closures in it
constexpr double kMoodReach = 0.4;  // seconds beside speech in which a mood has less of the mouth
constexpr std::size_t kNeighbours = 2;  // phones on each side that a phone's shape depends on
constexpr double kForever = std::numeric_limits<double>::infinity();

/// Seconds beside a phone beyond which neither it nor the rest of a pause is felt.
double reach_of(const Model& model) {
  return std::max(kind_of(model.method).reach(model), model.pause_edge);
}

Result<void> check(const StreamOptions& options) {
  if (auto ok = validate(options.synthesis); !ok) return ok;
  if (options.look_ahead && !(*options.look_ahead >= 0 && *options.look_ahead <= 60))
    return make_error(Code::invalid_argument, "the look-ahead must lie between 0 and 60 s");
  if (!(options.cross_fade >= 0 && options.cross_fade <= 1))
    return make_error(Code::invalid_argument, "the cross-fade must lie between 0 and 1 s");
  return {};
}

Error bad_phone(const Phone& phone, const std::string& what) {
  return make_error(Code::invalid_argument, "the phone " + phone.label + " at " +
                                                std::to_string(phone.start) + " s " + what);
}

Result<void> check_next(const Phone& phone, double known) {
  if (!std::isfinite(phone.start) || !std::isfinite(phone.end) || !(phone.end > phone.start) ||
      phone.end > kMaxScriptSeconds)
    return bad_phone(phone, "has no duration or ends out of range");
  if (phone.start < known - kTimeTolerance)
    return bad_phone(phone, "begins before the previous one ends");
  if (find_phone(phone.label) == nullptr)
    return bad_phone(phone, "is not known; see dam/script/phones.h");
  return {};
}

}  // namespace

double exact_look_ahead(const Model& model) { return reach_of(model) + kClosureReach; }

SpeechStream::SpeechStream(const Model& model, const StreamOptions& options)
    : model_(&model), options_(options), reach_(reach_of(model)) {
  if (articulation_of(model, options.synthesis) > 0) reach_ = std::max(reach_, kOpeningReach);
  if (!options.mood.neutral()) reach_ = std::max(reach_, kMoodReach);
  if (options.synthesis.tongue) reach_ = std::max(reach_, kTongueReach);
}

Result<void> SpeechStream::push(const Phone& phone) {
  if (auto ok = check(options_); !ok) return ok;
  if (finished_) return bad_phone(phone, "comes after the end of the stream");
  const double known = phones_.empty() ? 0 : phones_.back().end;
  if (auto ok = check_next(phone, known); !ok) return ok;
  if (phone.start > known + kTimeTolerance)
    phones_.push_back({known, phone.start, std::string(kSilence), {}});
  phones_.push_back(phone);
  return {};
}

Result<Signal> SpeechStream::pull() {
  if (auto ok = check(options_); !ok) return ok.error();
  double known = 0, wait = 0;  // seconds
  if (options_.look_ahead) {
    known = phones_.empty() ? 0 : phones_.back().end;
    wait = *options_.look_ahead;
  } else {
    if (phones_.size() > kNeighbours) known = phones_[phones_.size() - kNeighbours - 1].end;
    wait = reach_ + kClosureReach;
  }
  const double rate = options_.synthesis.rate.frames_per_second();
  const double end = std::floor((known - wait) * rate);
  return make(std::max(next_, std::size_t(std::max(0.0, end))), kForever);
}

Result<Signal> SpeechStream::finish() {
  if (auto ok = check(options_); !ok) return ok.error();
  finished_ = true;
  const fap::Rate rate = options_.synthesis.rate;
  const double seconds = (phones_.empty() ? 0 : phones_.back().end) + options_.synthesis.tail;
  const auto count =
      std::size_t(std::max(0.0, std::ceil(seconds * rate.frames_per_second() - 1e-6)));
  return make(std::max(next_, count), rate.seconds(double(count) - 1));
}

Result<Signal> SpeechStream::make(std::size_t end, double last_frame) {
  auto signal = piece(next_, end, last_frame);
  if (!signal) return signal;
  if (signal->frames() == 0) {
    if (auto ok = add_mood(*signal); !ok) return ok.error();  // the names of its channels
    return signal;
  }
  const std::size_t controls = signal->names.size();
  last_.assign(signal->values.end() - std::ptrdiff_t(controls), signal->values.end());
  next_ = end;
  if (auto ok = add_mood(*signal); !ok) return ok.error();
  forget();
  return signal;
}

Result<void> SpeechStream::add_mood(Signal& signal) const {
  if (options_.mood.neutral()) return {};
  return add_moods(signal, {phones_}, MoodTrack(options_.mood));
}

/// Frames [first, end), made with enough before and behind them that closures come out right.
Result<Signal> SpeechStream::piece(std::size_t first, std::size_t end, double last_frame) const {
  const SynthesisOptions& options = options_.synthesis;
  const double rate = options.rate.frames_per_second();
  const auto margin = std::size_t(std::ceil(kBehind * rate));
  FramePlan plan;
  plan.first = first - std::min(first, margin);
  plan.last_frame = last_frame;
  const bool open = std::isinf(last_frame);
  plan.count = first == end ? 0 : end + (open ? margin : 0) - plan.first;
  SynthesisReport report;
  auto signal = synthesise_frames(*model_, {phones_}, options, plan, report);
  if (!signal) return signal;
  const std::size_t controls = signal->names.size();
  if (options_.look_ahead && !last_.empty() && end > first) lead_over(*signal);
  std::vector<double>& values = signal->values;
  const auto at = [&](std::size_t frame) {
    return values.begin() + std::ptrdiff_t((frame - plan.first) * controls);
  };
  values = first == end ? std::vector<double>{} : std::vector<double>(at(first), at(end));
  signal->first_frame = first;
  return signal;
}

/// What was given out last and what it would be now differ: the difference fades.
void SpeechStream::lead_over(Signal& signal) const {
  const std::size_t controls = signal.names.size();
  const std::size_t before = next_ - 1 - signal.first_frame;
  std::vector<double> offset(controls);
  for (std::size_t c = 0; c < controls; ++c) offset[c] = last_[c] - signal.at(before, c);
  const double fade = options_.cross_fade * signal.rate.frames_per_second();
  for (std::size_t i = before + 1; i < signal.frames(); ++i) {
    const double x = double(i - before) / std::max(fade, 1e-9);
    if (x >= 1) break;
    const double share = raised_bell(x);
    for (std::size_t c = 0; c < controls; ++c) signal.at(i, c) += share * offset[c];
  }
}

/// Drops the phones that no later frame can feel.
void SpeechStream::forget() {
  const double time = options_.synthesis.rate.seconds(double(next_)) - kBehind - kClosureReach;
  std::size_t felt = 0;
  while (felt < phones_.size() && phones_[felt].end < time - 2 * reach_ - kLongestSince) ++felt;
  const std::size_t drop = felt - std::min(felt, kNeighbours + 1);
  phones_.erase(phones_.begin(), phones_.begin() + std::ptrdiff_t(drop));
}

}  // namespace animeme::dam

#include "dam/synthesise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dam/closure.h"
#include "dam/detail/timeline.h"
#include "dam/kinds/kind.h"

namespace animeme::dam {
namespace {

constexpr double kMaxFrames = 1e7;
constexpr double kEndRamp = 0.1;           // seconds in which a clip leaves and reaches rest
constexpr double kShortestEndRamp = 0.08;  // also if the speech begins earlier

/// 0 at x <= 0, 1 at x >= 1, a raised cosine between.
double smooth_step(double x) {
  if (x <= 0) return 0;
  return x >= 1 ? 1.0 : 0.5 * (1 - std::cos(std::numbers::pi * x));
}

Result<std::size_t> frame_count(const Script& script, const SynthesisOptions& options) {
  const auto range = [](const char* what) {
    return make_error(Code::invalid_argument, std::string("synthesis option ") + what);
  };
  if (!options.rate.valid() || !(options.rate.frames_per_second() <= 1000))
    return range("rate must be above 0 and at most 1000 frames a second");
  if (!(options.tail >= 0 && options.tail <= 60)) return range("tail must lie between 0 and 60 s");
  if (!(options.context_weight >= 0 && options.context_weight <= 1e12))
    return range("context_weight must not be negative");
  if (!(options.smoothness_weight >= 0 && options.smoothness_weight <= 1e12))
    return range("smoothness_weight must not be negative");
  const double seconds = script.duration() + options.tail;
  const double frames = options.frames > 0
                            ? double(options.frames)
                            : std::ceil(seconds * options.rate.frames_per_second() - 1e-6);
  if (!(frames <= kMaxFrames))
    return make_error(Code::out_of_range,
                      "the clip has more than 10 million frames; cut the script");
  return std::size_t(std::max(0.0, frames));
}

/// How much of the deviation from rest is shown: fades in long pauses and at the ends of the clip.
class Gate {
 public:
  Gate(const Script& script, const Model& model, bool rest_at_ends, double last_frame_time)
      : stretches_(speech_stretches(script)),
        edge_(model.pause_edge),
        ends_(rest_at_ends),
        end_(last_frame_time) {
    if (stretches_.empty()) return;
    lead_in_ = std::clamp(stretches_.front().start, kShortestEndRamp, kEndRamp);
    lead_out_ = std::clamp(end_ - stretches_.back().end, kShortestEndRamp, kEndRamp);
  }

  double operator()(double time) const {
    const double distance = distance_to_speech(stretches_, time);
    double gate = smooth_step((edge_ - distance) / (edge_ / 3));
    if (ends_) gate *= smooth_step(time / lead_in_) * smooth_step((end_ - time) / lead_out_);
    return gate;
  }

 private:
  std::vector<Stretch> stretches_;
  double edge_;
  bool ends_;
  double end_;
  double lead_in_ = kEndRamp, lead_out_ = kEndRamp;
};

void to_control_units(const Model& model, const Gate& gate, Signal& signal) {
  const std::size_t controls = model.controls.size();
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const double shown = gate(signal.rate.seconds(double(i)));
    for (std::size_t c = 0; c < controls; ++c) {
      double& value = signal.values[i * controls + c];
      value = model.controls[c].rest + model.controls[c].sd * shown * value;
    }
  }
}

/// The outer contour follows the inner one as far as the two move together in the training data.
ClosureOptions closure_options(const Model& model) {
  const auto share = [&](std::string_view outer, std::string_view inner, double otherwise) {
    const auto o = model.find_control(outer), i = model.find_control(inner);
    if (o < 0 || i < 0 || !(model.controls[std::size_t(i)].sd > 0)) return otherwise;
    return std::clamp(model.controls[std::size_t(o)].sd / model.controls[std::size_t(i)].sd, 0.0,
                      1.0);
  };
  ClosureOptions options;
  options.target = model.closure_gap;
  options.upper_follow =
      share("fap51_lower_t_midlip_o", "fap4_lower_t_midlip", options.upper_follow);
  options.lower_follow =
      share("fap52_raise_b_midlip_o", "fap5_raise_b_midlip", options.lower_follow);
  return options;
}

}  // namespace

Result<Signal> synthesise(const Model& model, const Script& script, const SynthesisOptions& options,
                          SynthesisReport* report) {
  if (auto ok = check_script(script); !ok) return ok.error();
  const auto frames = frame_count(script, options);
  if (!frames) return frames.error();
  SynthesisReport own;
  SynthesisReport& out = report != nullptr ? *report : own;
  out = {};
  const auto spoken = replace_unknown_phones(model, script, &out);
  if (!spoken) return spoken.error();
  auto timeline = make_timeline(*spoken, model.pause_edge);
  // A model may lack silence only if it was made by hand; the mouth then rests in pauses.
  std::erase_if(timeline, [&](const Occurrence& o) { return model.find_phone(o.label) < 0; });
  std::vector<std::int32_t> phone;
  for (const Occurrence& o : timeline) phone.push_back(model.find_phone(o.label));
  out.phones = timeline.size();
  Signal signal;
  signal.rate = options.rate;
  for (const Control& control : model.controls) signal.names.push_back(control.name);
  signal.values.assign(*frames * model.controls.size(), 0.0);
  kind_of(model.method)
      .speak({model, timeline, phone, options, options.rate, 0, *frames}, signal.values, out);
  const double last = options.rate.seconds(double(*frames) - 1);
  to_control_units(model, Gate(*spoken, model, options.rest_at_ends, last), signal);
  if (options.closure) {
    const ClosureOptions closure = closure_options(model);
    out.closures = apply_closure(signal, script, closure);
    apply_contact(signal, closure);
  }
  return signal;
}

}  // namespace animeme::dam

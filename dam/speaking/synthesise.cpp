#include "dam/speaking/synthesise.h"

#include <algorithm>
#include <cmath>

#include "dam/maths/raised_cosine.h"
#include "dam/model/kind_internal.h"
#include "dam/script/timeline_internal.h"
#include "dam/signal/closure.h"
#include "dam/signal/mouth_opening.h"
#include "dam/signal/rounding.h"
#include "dam/signal/symmetry.h"
#include "dam/speaking/frames_internal.h"
#include "dam/speaking/tongue.h"

namespace animeme::dam {
namespace {

constexpr double kMostFrames = 1e7;

/// Seconds in which a clip leaves and reaches rest, and the least, if the speech begins earlier.
constexpr double kEndRamp = 0.1, kShortestEndRamp = 0.08;

/// How much of the deviation from rest is shown: fades from two thirds of `edge` seconds from
/// speech to nothing at `edge`, and, if wanted, over the first and the last frames of the clip.
class RestGate {
 public:
  /// `last_frame` in seconds; infinity while the end is not known.
  RestGate(const Script& script, double edge, bool rest_at_ends, double last_frame)
      : stretches_(speech_stretches(script)), edge_(edge), ends_(rest_at_ends), end_(last_frame) {
    if (stretches_.empty()) return;
    lead_in_ = std::clamp(stretches_.front().start, kShortestEndRamp, kEndRamp);
    lead_out_ = std::clamp(end_ - stretches_.back().end, kShortestEndRamp, kEndRamp);
  }
  /// 0..1 at a time in seconds.
  double operator()(double time) const {
    const double distance = distance_to_speech(stretches_, time);
    double gate = raised_step((edge_ - distance) / (edge_ / 3));
    if (ends_) gate *= raised_step(time / lead_in_) * raised_step((end_ - time) / lead_out_);
    return gate;
  }

 private:
  std::vector<Stretch> stretches_;
  double edge_;
  bool ends_;
  double end_;
  double lead_in_ = kEndRamp, lead_out_ = kEndRamp;
};

std::vector<double> resting_mouth(const Model& model, const Signal& signal, bool symmetric) {
  std::vector<double> rest;
  for (const Control& control : model.controls) rest.push_back(control.rest);
  if (!symmetric) return rest;
  std::vector<double> both;
  for (const MirroredChannel& other : mirrored_channels(signal.names))
    both.push_back(0.5 * (rest[both.size()] + other.sign * rest[other.channel]));
  return both;
}

void to_control_units(const Model& model, const RestGate& gate, const SynthesisOptions& options,
                      Signal& signal) {
  const std::size_t controls = model.controls.size();
  const std::vector<double> rest = resting_mouth(model, signal, options.symmetric_rest);
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const double shown = options.style * gate(signal.time(i));
    for (std::size_t c = 0; c < controls; ++c) {
      double& value = signal.values[i * controls + c];
      value = rest[c] + model.controls[c].sd * shown * value;
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
  options.duration = model.closure_duration;
  options.upper_follow =
      share("fap51_lower_t_midlip_o", "fap4_lower_t_midlip", options.upper_follow);
  options.lower_follow =
      share("fap52_raise_b_midlip_o", "fap5_raise_b_midlip", options.lower_follow);
  return options;
}

/// Phones that the model knows, in time order, with pauses cut and drawn-out sounds held.
std::vector<Occurrence> timeline_of(const Model& model, const Script& spoken) {
  auto timeline = make_timeline(spoken, model.pause_edge);
  // A model may lack silence only if it was made by hand; the mouth then rests in pauses. The
  // script has no other unknown phones.
  const auto unknown = [&](const std::string& label) { return model.find_phone(label) < 0; };
  if (unknown(std::string(kSilence))) {
    std::erase_if(timeline, [&](const Occurrence& o) { return unknown(o.label); });
    // The neighbours of such a pause are now next to the resting mouth, which is no phone.
    for (Occurrence& o : timeline) {
      if (unknown(o.left)) o.left.clear();
      if (unknown(o.right)) o.right.clear();
    }
  }
  hold_drawn_out(timeline, [&](const std::string& label) {
    return model.phones[std::size_t(model.find_phone(label))].longest;
  });
  return timeline;
}

}  // namespace

void touch_lips(const Model& model, const Script& script, const SynthesisOptions& options,
                Signal& signal, SynthesisReport& report) {
  if (!options.closure) return;
  const ClosureOptions closure = closure_options(model);
  if (model.lip_tooth_raise)
    report.lip_tooth_contacts =
        apply_lip_tooth_contact(signal, script, *model.lip_tooth_raise, closure);
  report.closures = apply_closure(signal, script, closure);
  apply_contact(signal, closure);
}

Result<void> validate(const SynthesisOptions& options) {
  const auto range = [](const char* what) {
    return make_error(Code::invalid_argument, std::string("synthesis option ") + what);
  };
  if (!options.rate.valid() || !(options.rate.frames_per_second() <= 1000))
    return range("rate must be above 0 and at most 1000 frames per second");
  if (!(options.tail >= 0 && options.tail <= 60)) return range("tail must lie between 0 and 60 s");
  if (!(options.style >= 0 && options.style <= kMostStyle))
    return range("style must lie between 0 and 1.5");
  if (!(options.sharpness >= 0 && options.sharpness <= kMostSharpness))
    return range("sharpness must lie between 0 and 3");
  const double articulation = options.articulation.value_or(0);
  if (!(articulation >= 0 && articulation <= kMostArticulation))
    return range("articulation must lie between 0 and 2");
  if (!(options.context_weight >= 0 && options.context_weight <= 1e12))
    return range("context_weight must not be negative");
  if (!(options.smoothness_weight >= 0 && options.smoothness_weight <= 1e12))
    return range("smoothness_weight must not be negative");
  return {};
}

Result<Signal> synthesise_frames(const Model& model, const Script& script,
                                 const SynthesisOptions& options, const FramePlan& plan,
                                 SynthesisReport& report) {
  const auto spoken = replace_unknown_phones(model, script, &report);
  if (!spoken) return spoken.error();
  const auto timeline = timeline_of(model, *spoken);
  std::vector<std::int32_t> phone;
  for (const Occurrence& o : timeline) phone.push_back(model.find_phone(o.label));
  report.phones = timeline.size();
  Signal signal;
  signal.rate = options.rate;
  signal.first_frame = plan.first;
  for (const Control& control : model.controls) signal.names.push_back(control.name);
  signal.values.assign(plan.count * model.controls.size(), 0.0);
  kind_of(model.method)
      .speak({model, timeline, phone, options, options.rate, plan.first, plan.count}, signal.values,
             report);
  const RestGate gate(*spoken, model.pause_edge, options.rest_at_ends, plan.last_frame);
  to_control_units(model, gate, options, signal);
  const double articulation = articulation_of(model, options);
  if (articulation > 0) open_mouth(MouthOpening(script), articulation, options.style, signal);
  touch_lips(model, script, options, signal, report);
  apply_limits(signal, model.limits);
  if (articulation > 0) {
    add_rounding(
        LipRounding(script), articulation, [&](double time) { return options.style * gate(time); },
        signal);
  }
  if (options.tongue) add_tongue(signal, script);
  return signal;
}

Result<Signal> synthesise(const Model& model, const Script& script, const SynthesisOptions& options,
                          SynthesisReport* report) {
  if (auto ok = check_script(script); !ok) return ok.error();
  if (auto ok = validate(options); !ok) return ok.error();
  const double seconds = script.duration() + options.tail;
  const double frames = options.frames > 0
                            ? double(options.frames)
                            : std::ceil(seconds * options.rate.frames_per_second() - 1e-6);
  if (!(frames <= kMostFrames))
    return make_error(Code::out_of_range,
                      "the clip has more than 10 million frames; cut the script");
  SynthesisReport own;
  SynthesisReport& out = report != nullptr ? *report : own;
  out = {};
  const auto count = std::size_t(std::max(0.0, frames));
  const double last = options.rate.seconds(double(count) - 1);
  return synthesise_frames(model, script, options, {0, count, last}, out);
}

}  // namespace animeme::dam

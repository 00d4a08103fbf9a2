#include "dam/speaking/idle_motion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dam/signal/arkit_signal.h"
#include "dam/signal/fap_signal.h"
#include "fap/arkit.h"

namespace animeme::dam {
namespace {

/// A row of a signal with room for what is added.
class Wider {
 public:
  Wider(Signal& signal, const std::vector<std::string>& added)
      : signal_(signal), before_(signal.names.size()) {
    const std::size_t frames = signal.frames();
    signal.names.insert(signal.names.end(), added.begin(), added.end());
    std::vector<double> values(frames * signal.names.size(), 0.0);
    for (std::size_t i = 0; i < frames; ++i)
      std::copy_n(&signal.values[i * before_], before_, &values[i * signal.names.size()]);
    signal.values = std::move(values);
  }
  template <class Visit>
  void each(const Visit& visit) {
    for (std::size_t i = 0; i < signal_.frames(); ++i)
      visit(&signal_.values[i * signal_.names.size()]);
  }

 private:
  Signal& signal_;
  std::size_t before_;
};

/// A behaviour that attends to others.
class AttentiveBehaviour {
 public:
  AttentiveBehaviour(Behaviour& behaviour, const Attention* attention)
      : behaviour_(behaviour), attention_(attention) {}
  FaceMoment next() {
    if (attention_ != nullptr) attend(behaviour_.time());
    return behaviour_.next();
  }

 private:
  void attend(double time) {
    const std::vector<HeardSpan>& heard = attention_->heard;
    while (heard_ < heard.size() && heard[heard_].end <= time) ++heard_;
    const bool hears = heard_ < heard.size() && heard[heard_].start <= time;
    if (!heard.empty()) behaviour_.hear(hears);
    for (; look_ < attention_->looks.size(); ++look_) {
      const TimedLook& look = attention_->looks[look_];
      if (look.time > time) break;
      if (look_ > 0) behaviour_.look(look.look);
    }
  }

  Behaviour& behaviour_;
  const Attention* attention_;
  std::size_t heard_ = 0, look_ = 0;  // the next ones
};

void move_faps(Signal& signal, const std::vector<int>& known, const std::vector<int>& moving,
               AttentiveBehaviour& behaviour) {
  std::vector<int> added;
  for (const int fap : moving)
    if (std::find(known.begin(), known.end(), fap) == known.end()) added.push_back(fap);
  std::vector<std::string> names;
  for (const int fap : added) names.push_back(fap_channel(fap));
  const std::size_t first = signal.names.size();
  Wider(signal, names).each([&](double* row) {
    const FaceMoment moment = behaviour.next();
    for (std::size_t a = 0; a < added.size(); ++a)
      row[first + a] = behaviour_value(moment, added[a]);
  });
}

/// What a shape at 1 does to a FAP, in its units.
double full(int shape, int fap) {
  fap::ArkitFrame weights{};
  weights[std::size_t(shape)] = 1;
  return fap::arkit_to_fap(weights, fap::kAllArkit).value[std::size_t(fap)];
}

/// A channel of ARKit that moves by itself.
struct LivingShape {
  enum class How : std::uint8_t { larger, less, sum, unless_known } how;
  int channel;
  double (*value)(const FaceMoment&, std::size_t side);
  std::size_t side = 0;
  std::size_t at = 0;  ///< column
  bool own = false;    ///< the signal has it already
};

constexpr int kArkitNumbers = fap::kArkitChannelCount;

int number_of_shape(std::string_view name) {
  return fap::find_arkit(name).value_or(kArkitNumbers - 1);
}

/// Weights of browInnerUp and browOuterUp of a side: each raises the other end of the brow a
/// little, too.
struct BrowWeights {
  double inner = 0;
  double outer[2] = {};
};

BrowWeights brow_weights(const FaceMoment& m) {
  static const int inner = number_of_shape("browInnerUp"),
                   left = number_of_shape("browOuterUpLeft");
  static const double inner_31 = full(inner, 31), inner_35 = full(inner, 35);
  static const double outer_31 = full(left, 31), outer_35 = full(left, 35);
  const double in = 0.5 * (m.inner_brow[0] + m.inner_brow[1]);
  const double out = 0.5 * (m.outer_brow[0] + m.outer_brow[1]);
  const double scale = 1 / (inner_31 * outer_35 - inner_35 * outer_31);
  BrowWeights weights;
  weights.inner = std::max(0.0, scale * (in * outer_35 - out * outer_31));
  for (std::size_t side = 0; side < 2; ++side) {
    const double both = scale * (out * inner_31 - in * inner_35);
    weights.outer[side] = std::max(0.0, both + (m.outer_brow[side] - out) / outer_35);
  }
  return weights;
}

double brow_down(const FaceMoment& m, std::size_t side) {
  static const int shape = number_of_shape("browDownLeft");
  static const double inner = full(shape, 31), middle = full(shape, 33);
  return std::max(0.0, 0.5 * (m.inner_brow[side] / inner + m.middle_brow[side] / middle));
}

double cheek_squint(const FaceMoment& m, std::size_t) {
  static const double lift = full(number_of_shape("cheekSquintLeft"), 41);
  return m.cheek / lift;
}

// Angles are to the person's left: the left eye turns out, the right one in.
double look_in(const FaceMoment& m, std::size_t side) {
  static const double most = full(number_of_shape("eyeLookOutLeft"), 23) * 1e-5;
  return std::max(0.0, (side == 0 ? -1 : 1) * m.eye_yaw[side] / most);
}
double look_out(const FaceMoment& m, std::size_t side) {
  static const double most = full(number_of_shape("eyeLookOutLeft"), 23) * 1e-5;
  return std::max(0.0, (side == 0 ? 1 : -1) * m.eye_yaw[side] / most);
}
double look_down(const FaceMoment& m, std::size_t side) {
  static const double most = full(number_of_shape("eyeLookDownLeft"), 25) * 1e-5;
  return std::max(0.0, m.eye_pitch[side] / most);
}
double look_up(const FaceMoment& m, std::size_t side) {
  static const double most = full(number_of_shape("eyeLookUpLeft"), 25) * 1e-5;
  return std::max(0.0, m.eye_pitch[side] / most);
}

std::vector<LivingShape> living_shapes(const StillParts& still) {
  using enum LivingShape::How;
  std::vector<LivingShape> shapes;
  const auto add = [&](LivingShape::How how, std::string_view name,
                       double (*value)(const FaceMoment&, std::size_t)) {
    shapes.push_back({how, number_of_shape(name), value});
  };
  const auto add_sides = [&](LivingShape::How how, const std::string& name,
                             double (*value)(const FaceMoment&, std::size_t)) {
    shapes.push_back({how, number_of_shape(name + "Left"), value, 0});
    shapes.push_back({how, number_of_shape(name + "Right"), value, 1});
  };
  if (!still.blinks) {
    add_sides(larger, "eyeBlink",
              [](const FaceMoment& m, std::size_t) { return std::min(m.blink, 1.0); });
    add_sides(less, "eyeWide",
              [](const FaceMoment& m, std::size_t) { return std::min(m.blink, 1.0); });
  }
  if (!still.gaze) {
    add_sides(unless_known, "eyeLookIn", look_in);
    add_sides(unless_known, "eyeLookOut", look_out);
    add_sides(unless_known, "eyeLookUp", look_up);
    add_sides(unless_known, "eyeLookDown", look_down);
  }
  if (!still.brows) {
    add(sum, "browInnerUp", [](const FaceMoment& m, std::size_t) { return brow_weights(m).inner; });
    add_sides(sum, "browOuterUp",
              [](const FaceMoment& m, std::size_t side) { return brow_weights(m).outer[side]; });
    add_sides(sum, "browDown", brow_down);
    add_sides(sum, "cheekSquint", cheek_squint);
  }
  if (!still.head) {
    // Live Link Face turns to the right where FAPs turn to the left, and tilts likewise.
    add(unless_known, "headPitch", [](const FaceMoment& m, std::size_t) { return m.head_pitch; });
    add(unless_known, "headYaw", [](const FaceMoment& m, std::size_t) { return -m.head_yaw; });
    add(unless_known, "headRoll", [](const FaceMoment& m, std::size_t) { return -m.head_roll; });
  }
  return shapes;
}

void move_shape(const LivingShape& shape, const FaceMoment& moment, double& value) {
  const double moved = shape.value(moment, shape.side);
  switch (shape.how) {
    case LivingShape::How::larger:
      value = std::max(value, moved);
      return;
    case LivingShape::How::less:
      value *= 1 - moved;
      return;
    case LivingShape::How::sum:
      value = std::max(value, std::min(1.0, value + moved));
      return;
    case LivingShape::How::unless_known:
      if (!shape.own) value = moved;
      return;
  }
}

// Brows that rise.
std::vector<LivingShape> questions_only() {
  std::vector<LivingShape> shapes =
      living_shapes({.gaze = true, .head = true, .brows = false, .blinks = true});
  std::erase_if(shapes, [](const LivingShape& shape) {
    const std::string_view name = fap::kArkitNames[std::size_t(shape.channel)];
    return name != "browInnerUp" && !name.starts_with("browOuterUp");
  });
  return shapes;
}

void move_arkit(Signal& signal, const ArkitLayout& layout, std::vector<LivingShape> shapes,
                AttentiveBehaviour& behaviour) {
  // Eyes that never open wide need not give way.
  std::erase_if(shapes, [&](const LivingShape& shape) {
    return shape.how == LivingShape::How::less && !layout.has[std::size_t(shape.channel)];
  });
  std::vector<std::string> added;
  for (LivingShape& shape : shapes) {
    const auto column = std::find(layout.channel.begin(), layout.channel.end(), shape.channel);
    shape.own = column != layout.channel.end();
    shape.at = shape.own ? std::size_t(column - layout.channel.begin())
                         : signal.names.size() + added.size();
    if (!shape.own) added.push_back(arkit_spelling(shape.channel, signal.names));
  }
  Wider(signal, added).each([&](double* row) {
    const FaceMoment moment = behaviour.next();
    for (const LivingShape& shape : shapes) move_shape(shape, moment, row[shape.at]);
  });
}

}  // namespace

Result<IdleMotionReport> add_idle_motion(Signal& signal, const Script& script,
                                         const IdleMotionOptions& options) {
  if (signal.first_frame != 0)
    return make_error(Code::invalid_argument, "idle motion can be added to whole clips only");
  BehaviourOptions wanted{signal.rate, options.seed, options.liveliness, options.still,
                          options.look};
  if (options.attention != nullptr && !options.attention->looks.empty())
    wanted.look = options.attention->looks.front().look;
  wanted.end = signal.rate.seconds(double(signal.frames()));
  Result<Behaviour> behaviour = Behaviour::make(wanted);
  if (!behaviour) return behaviour.error();
  std::vector<int> known;
  for (const std::string& name : signal.names) known.push_back(fap_of_channel(name));
  const bool faps = std::any_of(known.begin(), known.end(), [](int fap) { return fap != 0; });
  const auto arkit = find_arkit_layout(signal.names);
  if (!faps && !arkit)
    return make_error(
        Code::unsupported,
        "the controls are neither FAPs nor ARKit shapes, so blinks and nods cannot be "
        "added; use ARKit names such as eyeBlinkLeft");
  const SpeechPlan plan = plan_speech(script, options.prosody);
  const auto asks = [](const SpeechPhrase& phrase) { return phrase.question; };
  const bool still = options.liveliness <= 0;
  if (still &&
      (options.still.brows || std::none_of(plan.phrases.begin(), plan.phrases.end(), asks))) {
    return IdleMotionReport{};
  }
  behaviour->speak(plan);
  AttentiveBehaviour attentive(*behaviour, options.attention);
  if (faps)
    move_faps(signal, known, behaviour_faps(wanted), attentive);
  else
    move_arkit(signal, *arkit, still ? questions_only() : living_shapes(options.still), attentive);
  return behaviour->counts();
}

}  // namespace animeme::dam

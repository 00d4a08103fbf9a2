#include "tools/live/engines/detail/unified.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace animeme::engines {
namespace {

constexpr std::string_view kParameters = "/avatar/parameters/";
constexpr std::string_view kGaze = "/tracking/eye/LeftRightPitchYaw";
constexpr std::string_view kClosed = "/tracking/eye/EyesClosedAmount";
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kWholeSeconds = 1;
constexpr std::size_t kBlinks[] = {0, 7};
constexpr std::size_t kLeftYaw = 55, kLeftPitch = 56, kRightYaw = 58, kRightPitch = 59;

// A parameter a line: sums of shapes; # is Left and Right in turn.
constexpr std::string_view kTable = R"(
EyeSquint# eyeSquint#
EyeWide# eyeWide#
EyeOpen# 1 -1*eyeBlink#
EyeClosed# eyeBlink#
EyeLid# 0.75 -0.75*eyeBlink# 0.25*eyeWide#
EyeLid 0.75 -0.375*eyeBlinkLeft -0.375*eyeBlinkRight 0.125*eyeWideLeft 0.125*eyeWideRight
EyeLeftX eyeLookInLeft -1*eyeLookOutLeft
EyeRightX eyeLookOutRight -1*eyeLookInRight
Eye#Y eyeLookUp# -1*eyeLookDown#
EyeX 0.5*eyeLookInLeft -0.5*eyeLookOutLeft 0.5*eyeLookOutRight -0.5*eyeLookInRight
EyeY 0.5*eyeLookUpLeft -0.5*eyeLookDownLeft 0.5*eyeLookUpRight -0.5*eyeLookDownRight
BrowPinch# browDown#
BrowLowerer# browDown#
BrowDown# browDown#
BrowDown 0.5*browDownLeft 0.5*browDownRight
BrowInnerUp# browInnerUp
BrowInnerUp browInnerUp
BrowOuterUp# browOuterUp#
BrowOuterUp 0.5*browOuterUpLeft 0.5*browOuterUpRight
BrowUp# 0.6*browOuterUp# 0.4*browInnerUp
BrowUp 0.3*browOuterUpLeft 0.3*browOuterUpRight 0.4*browInnerUp
BrowExpression# 0.5*browInnerUp 0.5*browOuterUp# -1*browDown#
BrowExpression 0.5*browInnerUp 0.25*browOuterUpLeft 0.25*browOuterUpRight -0.5*browDownLeft -0.5*browDownRight
CheekSquint# cheekSquint#
CheekSquint 0.5*cheekSquintLeft 0.5*cheekSquintRight
CheekPuff# cheekPuff
CheekPuffSuck# cheekPuff
CheekPuffSuck cheekPuff
JawOpen jawOpen
JawLeft jawLeft
JawRight jawRight
JawForward jawForward
JawX jawRight -1*jawLeft
JawZ jawForward
MouthClosed mouthClose
LipSuckUpper# mouthRollUpper
LipSuckLower# mouthRollLower
LipSuckUpper mouthRollUpper
LipSuckLower mouthRollLower
LipSuck 0.5*mouthRollUpper 0.5*mouthRollLower
LipFunnelUpper# mouthFunnel
LipFunnelLower# mouthFunnel
LipFunnelUpper mouthFunnel
LipFunnelLower mouthFunnel
LipFunnel mouthFunnel
LipPuckerUpper# mouthPucker
LipPuckerLower# mouthPucker
LipPuckerUpper mouthPucker
LipPuckerLower mouthPucker
LipPucker mouthPucker
LipSuckFunnelUpper mouthRollUpper -1*mouthFunnel
LipSuckFunnelLower mouthRollLower -1*mouthFunnel
MouthUpperUp# mouthUpperUp#
MouthUpperDeepen# mouthUpperUp#
MouthUpperUp 0.5*mouthUpperUpLeft 0.5*mouthUpperUpRight
MouthLowerDown# mouthLowerDown#
MouthLowerDown 0.5*mouthLowerDownLeft 0.5*mouthLowerDownRight
MouthOpen 0.25*mouthUpperUpLeft 0.25*mouthUpperUpRight 0.25*mouthLowerDownLeft 0.25*mouthLowerDownRight
NoseSneer# noseSneer#
NoseSneer 0.5*noseSneerLeft 0.5*noseSneerRight
MouthUpper# mouth#
MouthLower# mouth#
MouthUpperX mouthRight -1*mouthLeft
MouthLowerX mouthRight -1*mouthLeft
MouthX mouthRight -1*mouthLeft
MouthCornerPull# mouthSmile#
MouthCornerSlant# mouthSmile#
MouthSmile# mouthSmile#
MouthFrown# mouthFrown#
MouthStretch# mouthStretch#
MouthStretch 0.5*mouthStretchLeft 0.5*mouthStretchRight
MouthDimple# mouthDimple#
MouthDimple 0.5*mouthDimpleLeft 0.5*mouthDimpleRight
MouthPress# mouthPress#
MouthPress 0.5*mouthPressLeft 0.5*mouthPressRight
MouthRaiserUpper mouthShrugUpper
MouthRaiserLower mouthShrugLower
SmileFrown# mouthSmile# -1*mouthFrown#
SmileFrown 0.5*mouthSmileLeft 0.5*mouthSmileRight -0.5*mouthFrownLeft -0.5*mouthFrownRight
MouthCornerY# mouthSmile# -1*mouthFrown#
TongueOut tongueOut
Head/Yaw -1*headYaw
Head/Pitch -1*headPitch
Head/Roll -1*headRoll
)";

std::string replaced(std::string text, std::string_view side) {
  for (std::size_t at = text.find('#'); at != std::string::npos; at = text.find('#')) {
    text.replace(at, 1, side);
  }
  return text;
}

// Words of a line of the table. What it names exists: tests/live/engines looks.
UnifiedParameter parameter_of(const std::string& line) {
  UnifiedParameter out;
  std::size_t at = line.find(' ');
  out.name = line.substr(0, at);
  while (at != std::string::npos) {
    const std::size_t begin = at + 1;
    at = line.find(' ', begin);
    const std::string word = line.substr(begin, at - begin);
    const std::size_t star = word.find('*');
    const bool number = word.find_first_not_of("-.0123456789") == std::string::npos;
    if (number) {
      out.constant = std::strtod(word.c_str(), nullptr);
      continue;
    }
    const std::string name = star == std::string::npos ? word : word.substr(star + 1);
    const double weight = star == std::string::npos ? 1 : std::strtod(word.c_str(), nullptr);
    if (const auto channel = fap::find_arkit(name)) {
      out.terms.push_back({std::size_t(*channel), weight});
    }
  }
  return out;
}

std::vector<UnifiedParameter> parameters_of_table() {
  std::vector<UnifiedParameter> all;
  std::string_view rest = kTable.substr(1);
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::string line(rest.substr(0, end));
    rest.remove_prefix(end + 1);
    if (line.find('#') == std::string::npos) {
      all.push_back(parameter_of(line));
      continue;
    }
    all.push_back(parameter_of(replaced(line, "Left")));
    all.push_back(parameter_of(replaced(line, "Right")));
  }
  return all;
}

OscMessage gaze_message(const fap::ArkitFrame& frame) {
  OscMessage message{std::string(kGaze), {}};
  for (const std::size_t channel : {kLeftPitch, kLeftYaw, kRightPitch, kRightYaw}) {
    message.values.emplace_back(float(frame[channel] / kDegree));
  }
  return message;
}

bool is_angle(const UnifiedParameter& parameter) {
  return parameter.terms.front().channel >= fap::kArkitShapeCount;
}

// What a parameter says of one of its channels, if all that pull its way do so alike.
double estimate(const UnifiedParameter& parameter, const UnifiedParameter::Term& term,
                double value) {
  const double rest = value - parameter.constant;
  if (is_angle(parameter)) return rest / term.weight;
  double sum = 0;
  for (const auto& other : parameter.terms) {
    if ((other.weight > 0) == (term.weight > 0)) sum += other.weight;
  }
  return std::clamp(rest / sum, 0.0, 1.0);
}

}  // namespace

double UnifiedParameter::value(const fap::ArkitFrame& frame) const {
  double sum = constant;
  for (const Term& term : terms) sum += term.weight * frame[term.channel];
  return sum;
}

bool UnifiedParameter::has_sign() const {
  double least = constant;
  for (const Term& term : terms) least += std::min(term.weight, 0.0);
  return is_angle(*this) || least < -1e-6;
}

std::span<const UnifiedParameter> unified_parameters() {
  static const std::vector<UnifiedParameter> all = parameters_of_table();
  return all;
}

UnifiedWriter::UnifiedWriter(const std::string& prefix, bool gaze, int bits)
    : begin_(std::string(kParameters) + prefix + "/"), gaze_(gaze), bits_(bits) {}

// As VRCFaceTracking does it: rounded down, and all of them from 0.99999 on.
void UnifiedWriter::write_bits(const UnifiedParameter& parameter, double value,
                               std::vector<OscMessage>& out) const {
  if (bits_ == 0 || is_angle(parameter)) return;
  constexpr double kWhole = 0.99999;
  const int most = (1 << bits_) - 1;
  const double size = std::abs(value);
  const int number = size > kWhole ? most : int(size * most);
  for (int bit = 0; bit < bits_; ++bit) {
    out.push_back({begin_ + parameter.name + std::to_string(1 << bit), {(number >> bit & 1) != 0}});
  }
  if (parameter.has_sign()) out.push_back({begin_ + parameter.name + "Negative", {value < 0}});
}

std::vector<OscMessage> UnifiedWriter::write(const fap::ArkitFrame& frame, double seconds) {
  std::vector<OscMessage> all;
  for (const UnifiedParameter& parameter : unified_parameters()) {
    const double value = parameter.value(frame);
    all.push_back({begin_ + parameter.name, {float(value)}});
    write_bits(parameter, value, all);
  }
  if (gaze_) {
    all.push_back({std::string(kClosed), {float((frame[kBlinks[0]] + frame[kBlinks[1]]) / 2)}});
    all.push_back(gaze_message(frame));
  }
  const bool whole = last_.empty() || !whole_ || seconds >= *whole_ + kWholeSeconds;
  std::vector<OscMessage> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (whole || all[i].values != last_[i].values) out.push_back(all[i]);
  }
  if (whole) whole_ = seconds;
  last_ = std::move(all);
  return out;
}

bool UnifiedState::take(const OscMessage& message) {
  if (message.address == kGaze) {
    constexpr std::array<std::size_t, 4> kChannels{kLeftPitch, kLeftYaw, kRightPitch, kRightYaw};
    if (message.values.size() < kChannels.size()) return false;
    for (std::size_t i = 0; i < kChannels.size(); ++i) {
      eyes_[kChannels[i]] = message.number(i).value_or(0) * kDegree;
    }
    return eyes_heard_ = true;
  }
  if (!message.address.starts_with(kParameters)) return message.address == kClosed;
  const auto value = message.number(0);
  if (!value) return false;
  const std::string_view name = message.address;
  const auto all = unified_parameters();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!name.ends_with(all[i].name)) continue;
    if (name[name.size() - all[i].name.size() - 1] != '/') continue;
    heard_[i] = *value;
    return true;
  }
  return false;
}

fap::ArkitChannels UnifiedState::channels() const {
  fap::ArkitChannels out;
  for (const auto& [place, value] : heard_) {
    for (const auto& term : unified_parameters()[place].terms) out.set(term.channel);
  }
  for (const std::size_t channel : {kLeftYaw, kLeftPitch, kRightYaw, kRightPitch}) {
    if (eyes_heard_) out.set(channel);
  }
  return out;
}

fap::ArkitFrame UnifiedState::values() const {
  fap::ArkitFrame out = eyes_;
  std::array<std::size_t, fap::kArkitChannelCount> fewest{}, count{};
  fap::ArkitFrame sum{};
  for (const auto& [place, value] : heard_) {
    const UnifiedParameter& parameter = unified_parameters()[place];
    for (const auto& term : parameter.terms) {
      const std::size_t others = parameter.terms.size();
      const std::size_t channel = term.channel;
      if (count[channel] > 0 && others > fewest[channel]) continue;
      if (count[channel] == 0 || others < fewest[channel]) {
        sum[channel] = 0;
        count[channel] = 0;
        fewest[channel] = others;
      }
      sum[channel] += estimate(parameter, term, value);
      ++count[channel];
    }
  }
  for (std::size_t channel = 0; channel < out.size(); ++channel) {
    if (count[channel] > 0) out[channel] = sum[channel] / double(count[channel]);
  }
  return out;
}

}  // namespace animeme::engines

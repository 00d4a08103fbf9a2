#include "dam/behaviour/look.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "fap/detail/real_text.h"

namespace animeme::dam {
namespace {

constexpr double kLeastAhead = 0.1, kMostAway = 1000;  // metres

Error no_target(std::string_view text) {
  return make_error(Code::syntax, "\"" + std::string(text.substr(0, 40)) +
                                      "\" is no target of the eyes; it is camera, away, YAW,PITCH "
                                      "in degrees (20,-5: left and down), or X,Y,Z in metres");
}

std::optional<double> look_number(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = fap::detail::read_real(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

Result<void> within_reach(double yaw, double pitch) {
  if (std::abs(yaw) <= kMostLookYaw && std::abs(pitch) <= kMostLookPitch) return {};
  return make_error(Code::out_of_range,
                    "eyes and head reach 60 degrees to each side, and 40 degrees up and down");
}

std::string short_number(double value) {
  std::string text;
  fap::detail::append_shortest(text, value);
  return text;
}

}  // namespace

Result<Look> parse_look(std::string_view text) {
  Look look;
  if (text == "camera") return look;
  if (text == "away") {
    look.kind = Look::Kind::away;
    return look;
  }
  std::array<double, 3> values = {};
  std::size_t count = 0;
  for (std::string_view rest = text;; ++count) {
    const std::size_t comma = rest.find(',');
    const std::optional<double> value = look_number(rest.substr(0, comma));
    if (!value || count >= values.size()) return no_target(text);
    values[count] = *value;
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (count == 0) return no_target(text);
  if (count == 1) {
    look.kind = Look::Kind::direction;
    look.yaw = values[0];
    look.pitch = values[1];
    if (auto ok = within_reach(look.yaw, look.pitch); !ok) return ok.error();
    return look;
  }
  look.kind = Look::Kind::point;
  look.x = values[0];
  look.y = values[1];
  look.z = values[2];
  if (!(look.z >= kLeastAhead && look.z <= kMostAway))
    return make_error(Code::out_of_range, "a point to look at is 0.1 to 1000 m before the face");
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double yaw = std::atan2(look.x, look.z) * kDegrees;
  const double pitch = std::atan2(look.y, std::hypot(look.x, look.z)) * kDegrees;
  if (auto ok = within_reach(yaw, pitch); !ok) return ok.error();
  return look;
}

std::string format_look(const Look& look) {
  switch (look.kind) {
    case Look::Kind::camera:
      return "camera";
    case Look::Kind::away:
      return "away";
    case Look::Kind::direction:
      return short_number(look.yaw) + "," + short_number(look.pitch);
    case Look::Kind::point:
      break;
  }
  return short_number(look.x) + "," + short_number(look.y) + "," + short_number(look.z);
}

}  // namespace animeme::dam

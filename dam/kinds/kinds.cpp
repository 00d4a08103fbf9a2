#include "dam/model/kind_internal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dam/kinds/animeme/animemes.h"
#include "dam/kinds/refined/refined.h"
#include "dam/kinds/table/table.h"
#include "dam/kinds/trajectory/trajectory.h"

namespace animeme::dam {
namespace {

constexpr Kind kKinds[] = {
    {Method::dam, "dam", validate_refined, write_refined, read_refined, fit_refined, speak_refined,
     reach_of_refined},
    {Method::dam_paper, "dam-paper", validate_animemes, write_animemes, read_animemes, fit_animemes,
     speak_animemes, reach_of_animemes},
    {Method::cohen_massaro, "cohen-massaro", validate_animemes, write_animemes, read_animemes,
     fit_animemes, speak_animemes, reach_of_animemes},
    {Method::mmm, "mmm", validate_trajectory, write_trajectory, read_trajectory, fit_trajectory,
     speak_trajectory, reach_of_trajectory},
    {Method::triphone, "triphone", validate_triphones, write_triphones, read_triphones,
     fit_triphones, speak_triphones, reach_of_triphones},
    {Method::viseme, "viseme", validate_visemes, write_visemes, read_visemes, fit_visemes,
     speak_visemes, reach_of_visemes},
    {Method::mean, "mean", validate_mean, write_mean, read_mean, fit_mean, speak_mean,
     reach_of_mean},
};
constexpr auto kMethods = [] {
  std::array<Method, std::size(kKinds)> list{};
  for (std::size_t i = 0; i < list.size(); ++i) list[i] = kKinds[i].method;
  return list;
}();

}  // namespace

std::span<const Kind> kinds() { return kKinds; }

const Kind& kind_of(Method method) {
  for (const Kind& kind : kKinds)
    if (kind.method == method) return kind;
  return kKinds[0];
}

std::string_view method_name(Method method) {
  for (const Kind& kind : kKinds)
    if (kind.method == method) return kind.name;
  return "";
}

std::optional<Method> find_method(std::string_view name) {
  for (const Kind& kind : kKinds)
    if (kind.name == name) return kind.method;
  return std::nullopt;
}

std::span<const Method> methods() { return kMethods; }

std::pair<std::size_t, std::size_t> Speech::frames_between(double low, double high) const {
  const double per_second = rate.frames_per_second();
  const auto made = [&](double frame) {
    return std::size_t(std::clamp(frame - double(first_frame), 0.0, double(frames)));
  };
  return {made(std::ceil(low * per_second)), made(std::floor(high * per_second) + 1)};
}

Error invalid_model(const std::string& what) {
  return make_error(Code::invalid_argument, "the model is not valid: " + what);
}

}  // namespace animeme::dam

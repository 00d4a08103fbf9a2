#include "dam/kinds/kind.h"

#include <array>

#include "dam/kinds/animeme/animemes.h"
#include "dam/kinds/refined/refined.h"

namespace animeme::dam {
namespace {

constexpr Kind kKinds[] = {
    {Method::dam, "dam", validate_refined, write_refined, read_refined, fit_refined, speak_refined,
     reach_of_refined},
    {Method::dam_paper, "dam-paper", validate_animemes, write_animemes, read_animemes, fit_animemes,
     speak_animemes},
    {Method::cohen_massaro, "cohen-massaro", validate_animemes, write_animemes, read_animemes,
     fit_animemes, speak_animemes, reach_of_animemes},
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

Error invalid_model(const std::string& what) {
  return make_error(Code::invalid_argument, "the model is not valid: " + what);
}

}  // namespace animeme::dam

#include "dam/kinds/table/contexts.h"

#include <algorithm>

#include "dam/maths/raised_cosine.h"

namespace animeme::dam {

std::array<CurveKey, kCurveLevels> curve_keys(const Model& model, std::int32_t phone,
                                              std::int32_t left, std::int32_t right) {
  const auto group = [&](std::int32_t neighbour) {
    return neighbour < 0
               ? kRestContext
               : std::int32_t(model.phones[std::size_t(neighbour)].context_class & 0xFFFF);
  };
  const std::int32_t left_class = group(left), right_class = group(right);
  return {{{phone, CurveLevel::phone, kAnyContext, kAnyContext},
           {phone, CurveLevel::left_class, left_class, kAnyContext},
           {phone, CurveLevel::right_class, kAnyContext, right_class},
           {phone, CurveLevel::left, left, kAnyContext},
           {phone, CurveLevel::right, kAnyContext, right},
           {phone, CurveLevel::classes, left_class, right_class},
           {phone, CurveLevel::triphone, left, right}}};
}

double fade(double u, double reach) {
  const double outside = std::max(-u, u - 1);  // negative inside
  return raised_step(0.5 * (1 - outside / reach));
}

}  // namespace animeme::dam

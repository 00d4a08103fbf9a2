#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tools/view/plot/scale_internal.h"

namespace animeme::plot {
namespace {

// 1, 2 or 5 times a power of ten: three to seven ticks.
double tick_step(double range) {
  const double power = std::pow(10, std::floor(std::log10(range)));
  for (const double step : {0.2, 0.5, 1.0}) {
    if (range <= 5 * step * power) return step * power;
  }
  return 2 * power;
}

}  // namespace

std::vector<Scale> scales_of(const Panel& panel, const Axis& axis) {
  std::map<std::string, Scale> of_units;
  for (const Row& row : panel.rows) {
    Scale& scale = of_units[row.unit];
    for (const Points& curve : row.curves) {
      for (const auto& [time, value] : curve) {
        if (!axis.shows(time) || std::isnan(value)) continue;
        scale.low = std::min(scale.low, value);
        scale.high = std::max(scale.high, value);
      }
    }
  }
  for (auto& entry : of_units) {
    Scale& scale = entry.second;
    scale.high = std::max(scale.high, scale.low + 1);
    scale.step = tick_step(scale.high - scale.low);
    scale.low = std::floor(scale.low / scale.step + 1e-9) * scale.step;
    scale.high = std::ceil(scale.high / scale.step - 1e-9) * scale.step;
  }
  std::vector<Scale> scales;
  for (const Row& row : panel.rows) scales.push_back(of_units[row.unit]);
  return scales;
}

}  // namespace animeme::plot

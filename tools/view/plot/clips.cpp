#include "tools/view/plot/clips.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "fap/tables.h"

namespace animeme::plot {

namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 1e-5 * 180 / std::numbers::pi;  // of the unit of angles

Points points_of(int fap, const TimedClip& shown) {
  Points points;
  const bool angle = fap::info(fap).unit == fap::Unit::angle;
  const double unit = angle ? kDegrees : 1;
  for (const fap::Frame& frame : shown.clip.frames) {
    const bool there = frame.mask[std::size_t(fap)];
    points.emplace_back(shown.start + shown.clip.rate.seconds(double(frame.number)),
                        there ? unit * frame.value[std::size_t(fap)] : kAbsent);
  }
  return points;
}

std::string unit_of(int fap) {
  const fap::Unit unit = fap::info(fap).unit;
  if (unit == fap::Unit::angle) return "degrees";
  return "1/1024 " + std::string(fap::unit_name(unit));
}

}  // namespace

Row fap_row(int fap, const std::vector<TimedClip>& clips) {
  Row row{"FAP " + std::to_string(fap), std::string(fap::info(fap).name), unit_of(fap), {}};
  bool there = clips.empty();
  for (const TimedClip& clip : clips) {
    row.curves.push_back(points_of(fap, clip));
    there = there || std::any_of(row.curves.back().begin(), row.curves.back().end(),
                                 [](const auto& point) { return !std::isnan(point.second); });
  }
  if (!there) row.subtitle += ", absent";
  return row;
}

Row difference_row(int fap, const TimedClip& a, const TimedClip& b) {
  Row row{"FAP " + std::to_string(fap), "difference", unit_of(fap), {{}}, 2};
  const Points shown = points_of(fap, b);
  std::size_t at = 0;
  for (const auto& [time, value] : points_of(fap, a)) {
    while (at + 1 < shown.size() && shown[at + 1].first <= time + 1e-6) ++at;
    if (!shown.empty()) row.curves[0].emplace_back(time, shown[at].second - value);
  }
  return row;
}

}  // namespace animeme::plot

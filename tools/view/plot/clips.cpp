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

// Of equally spaced values, over the frequency.
Points spectrum(const std::vector<double>& values, double rate, double most) {
  constexpr double kSeconds = 4, kLeast = 0.1, kFloor = -20;
  const std::size_t length =
      std::min(values.size(), std::size_t(std::max(std::lround(kSeconds * rate), 1L)));
  if (double(length) < kLeast * rate || length < 4) return {};
  std::vector<double> window(length), power(length / 2 + 1, 0.0);
  double energy = 0;
  for (std::size_t i = 0; i < length; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (double(i) + 0.5) / double(length));
    energy += window[i] * window[i];
  }
  // Of all angles that there are.
  std::vector<double> sine(length), cosine(length);
  for (std::size_t i = 0; i < length; ++i) {
    sine[i] = std::sin(2 * std::numbers::pi * double(i) / double(length));
    cosine[i] = std::cos(2 * std::numbers::pi * double(i) / double(length));
  }
  std::size_t count = 0;
  for (std::size_t first = 0; first + length <= values.size(); first += (length + 1) / 2) {
    double mean = 0;
    for (std::size_t i = 0; i < length; ++i) mean += values[first + i] / double(length);
    for (std::size_t k = 1; k < power.size(); ++k) {
      double re = 0, im = 0;
      for (std::size_t i = 0, angle = 0; i < length; ++i, angle = (angle + k) % length) {
        const double value = window[i] * (values[first + i] - mean);
        im += value * sine[angle];
        re += value * cosine[angle];
      }
      power[k] += re * re + im * im;
    }
    ++count;
  }
  Points points;
  for (std::size_t k = 1; k < power.size(); ++k) {
    const double hertz = double(k) * rate / double(length);
    if (hertz > most + 1e-9) break;
    const bool last = 2 * k == length;
    const double density = (last ? 1 : 2) * power[k] / (energy * rate * double(count));
    points.emplace_back(hertz, std::max(kFloor, 10 * std::log10(std::max(density, 1e-9))));
  }
  return points;
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

Row spectrum_row(int fap, const std::vector<TimedClip>& clips, double most) {
  Row row{"FAP " + std::to_string(fap), std::string(fap::info(fap).name), "dB", {}};
  for (const TimedClip& clip : clips) {
    std::vector<double> values;
    double last = 0;
    for (const auto& [time, value] : points_of(fap, clip)) {
      if (!std::isnan(value)) last = value;
      values.push_back(last);
    }
    row.curves.push_back(spectrum(values, clip.clip.rate.frames_per_second(), most));
  }
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

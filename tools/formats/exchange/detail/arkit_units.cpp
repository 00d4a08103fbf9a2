#include "tools/formats/exchange/detail/arkit_units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace animeme::exchange {
namespace {

constexpr double kBeyond = 1.5;       // a share of 1 that trackers do not exceed
constexpr double kAtRest = 0.05;      // smaller weights do not say which unit they have
constexpr double kMostPercent = 200;  // more is no percentage
constexpr double kShareOfWeights = 0.1;
constexpr double kShareOfAngles = 0.01;

std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Weights that are not at rest, those beyond kBeyond, and the largest.
struct Extent {
  std::size_t moved = 0;
  std::size_t beyond = 0;
  double largest = 0;
  std::size_t channel = 0;  // of the largest
};

Extent extent_of(std::span<const fap::ArkitFrame> rows, std::size_t first, std::size_t last,
                 double rest, double most) {
  Extent extent;
  for (const fap::ArkitFrame& row : rows) {
    for (std::size_t i = first; i < last; ++i) {
      const double size = std::abs(row[i]);
      extent.moved += size > rest ? 1 : 0;
      extent.beyond += size > most ? 1 : 0;
      if (size > extent.largest) extent.channel = i;
      extent.largest = std::max(extent.largest, size);
    }
  }
  return extent;
}

void scale_channels(std::span<fap::ArkitFrame> rows, std::size_t first, std::size_t last,
                    double factor) {
  for (fap::ArkitFrame& row : rows) {
    for (std::size_t i = first; i < last; ++i) row[i] *= factor;
  }
}

void weights_to_shares(std::span<fap::ArkitFrame> rows, std::vector<std::string>& warnings) {
  const Extent extent = extent_of(rows, 0, fap::kArkitShapeCount, kAtRest, kBeyond);
  if (extent.beyond == 0) return;
  const bool percent = extent.largest <= kMostPercent &&
                       double(extent.beyond) >= kShareOfWeights * double(extent.moved);
  if (percent) {
    scale_channels(rows, 0, fap::kArkitShapeCount, 0.01);
    warnings.push_back("the weights of the shapes go up to " + short_number(extent.largest) +
                       " and are taken as percent");
    return;
  }
  warnings.push_back("weights of shapes should be 0 to 1, and " + std::to_string(extent.beyond) +
                     " exceed that (" + std::string(fap::kArkitNames[extent.channel]) + " is " +
                     short_number(extent.largest) +
                     "); if a column has another unit, give its factor (--column "
                     "NAME=jawOpen*0.01)");
}

}  // namespace

void to_usual_units(std::span<fap::ArkitFrame> rows, bool degrees,
                    std::vector<std::string>& warnings) {
  weights_to_shares(rows, warnings);
  const Extent extent =
      extent_of(rows, fap::kArkitShapeCount, fap::kArkitChannelCount, 0, std::numbers::pi);
  const bool turned =
      double(extent.beyond) > 0 && double(extent.beyond) >= kShareOfAngles * double(extent.moved);
  if (!degrees && turned) {
    warnings.push_back("angles of head and eyes go up to " + short_number(extent.largest) +
                       " and are taken as degrees");
  }
  if (degrees || turned) {
    scale_channels(rows, fap::kArkitShapeCount, fap::kArkitChannelCount, std::numbers::pi / 180);
  }
}

}  // namespace animeme::exchange

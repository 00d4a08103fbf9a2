// Curves over time as SVG, with the phones that are spoken.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dam/script.h"

namespace animeme::tools {

/// Seconds and value.
using PlotPoints = std::vector<std::pair<double, double>>;

/// One curve a colour, in the order of the legend; together they share a scale.
struct PlotRow {
  std::string title;
  std::string subtitle;
  std::vector<PlotPoints> curves;  ///< at most two
};

/// Rows over one time axis.
struct PlotPanel {
  std::string heading;  ///< empty: none
  double seconds = 0;
  const dam::Script* script = nullptr;  ///< phones behind the rows; nullptr: none
  bool names_below = false;             ///< the phones' names stand below the rows, not above
  std::vector<PlotRow> rows;
};

/// The panels one below the other, and whose colour is whose. Longer than this cannot be drawn.
inline constexpr double kLongestPlot = 600;  // seconds
std::string curves_svg(const std::vector<PlotPanel>& panels,
                       const std::vector<std::string>& legend);

}  // namespace animeme::tools

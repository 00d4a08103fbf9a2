/// @file
/// Curves over time as SVG, with the phones that are spoken.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::tools {

/// Seconds and value.
using PlotPoints = std::vector<std::pair<double, double>>;

/// One curve a colour, in the order of the legend; together they share a scale.
struct PlotRow {
  std::string title;               ///< beside the curves
  std::string subtitle;            ///< below it, smaller
  std::string unit;                ///< of the values; empty: none is told
  std::vector<PlotPoints> curves;  ///< first_colour + their number: three at most
  std::size_t first_colour = 0;    ///< place in the legend of the first curve
};

/// Rows over one time axis.
struct PlotPanel {
  std::string heading;                  ///< empty: none
  double begin = 0;                     ///< seconds; what lies before is not shown
  double seconds = 0;                   ///< where it ends
  const dam::Script* script = nullptr;  ///< phones behind the rows; nullptr: none
  bool names_below = false;             ///< the phones' names stand below the rows, not above
  std::vector<PlotRow> rows;            ///< from the top
};

/// The panels one below the other, and whose colour is whose; the colours differ for colour-blind
/// people, too, and the second curve is dashed. A second is 260 pixels wide, with phones 320; less
/// in long clips, which are 2400 pixels wide, with phones 8000, and never less than 19 a second;
/// more in short ones, which are 600 pixels wide. A phone without room for its name has none.
/// Longer than this should not be drawn.
inline constexpr double kLongestPlot = 600;  // seconds
/// See PlotPanel.
std::string curves_svg(const std::vector<PlotPanel>& panels,
                       const std::vector<std::string>& legend);

/// Whether write_drawing() can write a file of this name: .svg, .png, or "-" (SVG).
bool is_drawing(const std::string& path);

/// Writes a drawing as .png or, with any other name, as it is. Errors: io, and those of
/// media::svg_to_png().
Result<void> write_drawing(const std::string& path, const std::string& svg);

}  // namespace animeme::tools

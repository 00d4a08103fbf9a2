/// @file
/// Curves over time as SVG, with the phones that are spoken.
///
///     plot::Panel panel;
///     panel.seconds = clip.duration();
///     panel.rows.push_back({"FAP 3", "open_jaw", "1/1024 MNS", {points}});
///     const std::string svg = plot::curves_svg({panel}, {"measured"});
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::plot {

/// Seconds and value.
using Points = std::vector<std::pair<double, double>>;

/// Begin and end, in seconds.
using Stretches = std::vector<std::pair<double, double>>;

/// One curve a colour, in the order of the legend. Rows of a panel that have the same unit share a
/// scale. A curve is broken where a value is no number.
struct Row {
  std::string title;             ///< of the row
  std::string subtitle;          ///< smaller, behind it
  std::string unit;              ///< of the values; empty: none is told
  std::vector<Points> curves;    ///< first_colour + their number: three at most
  std::size_t first_colour = 0;  ///< place in the legend of the first curve
  /// Bars below the curves, one list for each of the first curves, in its colour: when something is
  /// the case.
  std::vector<Stretches> bars;
};

/// Rows over one time axis.
struct Panel {
  std::string heading;                  ///< empty: none
  double begin = 0;                     ///< seconds; what lies before is not shown
  double seconds = 0;                   ///< where it ends
  const dam::Script* script = nullptr;  ///< phones behind the rows; nullptr: none
  bool names_below = false;             ///< the phones' names stand below the rows, not above
  std::vector<Row> rows;                ///< from the top
};

/// Longer than this nothing should be drawn, seconds.
inline constexpr double kLongest = 600;

/// The panels one below the other, and whose colour is whose; the colours differ for colour-blind
/// people, too, and the second curve is dashed. `legend` has a name for each colour, three at most.
/// A second is 260 pixels wide, with phones 320; less in long clips, which are 2400 pixels wide,
/// with phones 8000, and never less than 19 a second; more in short ones, which are 600 pixels
/// wide. A phone without room for its name has none.
std::string curves_svg(const std::vector<Panel>& panels, const std::vector<std::string>& legend);

/// Whether drawing_bytes() knows this kind of file: .svg, .png, or "-" (SVG).
bool is_drawing(const std::string& path);

/// A drawing as a file of this name holds it: PNG for .png, else the SVG itself. Errors: those of
/// media::svg_to_png(), with the path.
Result<std::vector<std::uint8_t>> drawing_bytes(const std::string& path, const std::string& svg);

}  // namespace animeme::plot

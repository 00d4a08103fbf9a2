/// @file
/// Curves over time as SVG, with phones.
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

/// A row of curves, one per colour, in the order of the legend. Rows of a panel with the same unit
/// share a scale. NaN breaks a curve.
struct Row {
  std::string title;             ///< of the row
  std::string subtitle;          ///< smaller, after the title
  std::string unit;              ///< of the values; empty: none
  std::vector<Points> curves;    ///< first_colour + number of curves is at most three
  std::size_t first_colour = 0;  ///< index in the legend of the first curve
  /// Time ranges shown as bars below the curves, one list for each of the first curves, in its
  /// colour.
  std::vector<Stretches> bars;
};

/// Rows over one time axis.
struct Panel {
  std::string heading;                  ///< empty: none
  std::string axis = "Time (s)";        ///< title of the axis
  double begin = 0;                     ///< seconds; start of the axis
  double seconds = 0;                   ///< end of the axis
  const dam::Script* script = nullptr;  ///< phones in the background; nullptr: none
  bool names_below = false;             ///< phone names are below the rows, not above
  std::vector<Row> rows;                ///< from the top
};

/// The form of a plot.
struct Layout {
  std::string title;  ///< above all; empty: none
  double width = 0;   ///< pixels of 1/96 inch, 120 or more; 0: by the length, see curves_svg()
  double height = 0;  ///< pixels; 0: by the rows
  bool own_scales = false;  ///< each row has a scale of its own, also within a unit
  /// With a width: the picture's width in its file, such as "85mm" or "1004"; empty: in pixels.
  std::string shown_width;
};

/// The least height of a picture with these panels, in a layout that has a width.
double least_height(const std::vector<Panel>& panels, const std::vector<std::string>& legend,
                    const Layout& layout);

/// Maximum length of a plot, seconds.
inline constexpr double kLongest = 600;

/// Draws panels one below the other, with a legend; the colours suit colour-blind readers, and the
/// second curve is dashed. `legend` has a name for each colour, at most three. A second is 260
/// pixels wide, with phones 320; less in long clips, which are 2400 pixels wide, with phones 8000,
/// and never less than 19 a second; more in short ones, which are 600 pixels wide. A phone without
/// room for its name has none.
///
/// A layout with a width is for print and slides: letters are 8 points high, names of rows lie
/// above their curves, phones without room have no name, and ticks keep apart.
///
/// Axes of panels that have another title begin and end with those panels.
std::string curves_svg(const std::vector<Panel>& panels, const std::vector<std::string>& legend,
                       const Layout& layout = {});

/// Whether drawing_bytes() supports this file: .svg, .pdf, .png, or "-" (SVG).
bool is_drawing(const std::string& path);

/// The contents of a file of this name: PNG for .png, PDF for .pdf (pdf.h), else the SVG itself.
/// Errors: those of media::svg_to_png(), with the path.
Result<std::vector<std::uint8_t>> drawing_bytes(const std::string& path, const std::string& svg);

}  // namespace animeme::plot

#include "tools/view/plot/curves.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/picture.h"

namespace animeme::plot {

using tools::drawn;
using tools::escape_xml;

namespace {

inline constexpr double kLeft = 150;  // pixels to the left of the curves

// The time axis that all panels share.
struct Axis {
  double begin = 0;
  double end = 0;
  double scale = 1;  // pixels a second

  double x(double seconds) const { return kLeft + (seconds - begin) * scale; }
  bool shows(double seconds) const { return seconds >= begin && seconds <= end; }
};

// Values of a unit, from tick to tick.
struct Scale {
  double low = 0, high = 0, step = 1;
};

// 1, 2 or 5 times a power of ten: three to seven ticks.
double tick_step(double range) {
  const double power = std::pow(10, std::floor(std::log10(range)));
  for (const double step : {0.2, 0.5, 1.0}) {
    if (range <= 5 * step * power) return step * power;
  }
  return 2 * power;
}

// One for each row: rows of one unit share theirs, so that they can be compared. 0 is always on
// it.
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

constexpr double kRight = 34;
constexpr double kRow = 110;
constexpr double kBand = 26;
constexpr double kBar = 5;
constexpr double kHeading = 30;
constexpr double kAxis = 30;
constexpr double kTitle = 20;  // of the time axis, below it
constexpr double kLegendLine = 18;
constexpr double kLeastPixelsPerSecond = 19;
constexpr double kNarrow = 600;
// How wide a second is, and the most that fits a screen; phones need more room to be read.
struct Room {
  double second, most;
};
constexpr Room kPlain{260, 2400};
constexpr Room kWithPhones{320, 8000};
constexpr double kCharacter = 0.64;  // width against the size of the font; wide fonts, too
constexpr double kLeastFont = 6.5;

struct Pen {
  const char* colour;
  const char* dashes;
};
constexpr Pen kPens[] = {
    {"#0072b2", ""}, {"#d55e00", " stroke-dasharray=\"7 3\""}, {"#00875f", ""}};

Axis axis_of(const std::vector<Panel>& panels) {
  Axis axis{panels.empty() ? 0 : panels.front().begin, 0, 1};
  Room room = kPlain;
  for (const Panel& panel : panels) {
    if (panel.script != nullptr) room = kWithPhones;
    axis.begin = std::min(axis.begin, panel.begin);
    axis.end = std::max(axis.end, panel.seconds);
  }
  const double seconds = std::max(axis.end - axis.begin, 0.04);
  const double scale = std::clamp(room.most / seconds, kLeastPixelsPerSecond, room.second);
  axis.scale = std::max(scale, kNarrow / seconds);
  return axis;
}

// Where the parts of a panel lie.
struct Place {
  double begin = 0;  // below the heading
  double top = 0;    // of the rows
  double names = 0;  // baseline of the phones' names
  double end = 0;    // below the time axis

  double rows_end() const { return end - kAxis; }
};

Place place(const Panel& panel, double offset) {
  Place at;
  const bool above = panel.script != nullptr && !panel.names_below;
  const bool below = panel.script != nullptr && panel.names_below;
  at.begin = offset + (panel.heading.empty() ? 0 : kHeading);
  at.top = at.begin + (above ? kBand + 8 : 8);
  const double rows = at.top + double(panel.rows.size()) * kRow;
  at.names = below ? rows + 12 : at.begin + 20;
  at.end = rows + (below ? kBand - 8 : 0) + kAxis;
  return at;
}

// Characters of a text in UTF-8.
std::int64_t length_of(const std::string& text) {
  return std::count_if(text.begin(), text.end(),
                       [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
}

std::string heading(const Panel& panel, const Place& at) {
  if (panel.heading.empty()) return {};
  return "<text x=\"8\" y=\"" + drawn(at.begin - 8) + "\" font-size=\"14\" font-weight=\"bold\">" +
         escape_xml(panel.heading) + "</text>\n";
}

std::string seconds_of(double time, double step) {
  return tools::format(step < 0.09 ? "%.2f" : "%.1f", time);
}

std::string time_axis(const Panel& panel, const Axis& axis, const Place& at) {
  double step = 0.01;
  for (const double wider : {0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0}) {
    if (step * axis.scale < 60) step = wider;
  }
  std::string svg;
  const auto first = std::int64_t(std::ceil(panel.begin / step - 1e-9));
  for (std::int64_t i = first; double(i) * step <= panel.seconds + 1e-9; ++i) {
    const std::string column = drawn(axis.x(double(i) * step));
    svg += "<line x1=\"" + column + "\" x2=\"" + column + "\" y1=\"" + drawn(at.top) + "\" y2=\"" +
           drawn(at.rows_end() + 4) + "\" stroke=\"#dddddd\"/>\n<text x=\"" + column + "\" y=\"" +
           drawn(at.end - 10) + "\" text-anchor=\"middle\" fill=\"#555555\">" +
           seconds_of(double(i) * step, step) + "</text>\n";
  }
  return svg;
}

// The name of a phone in its band, as large as fits; nothing if it could not be read.
std::string phone_name(const std::string& label, double middle, double width, double y) {
  const double characters = std::max(1.0, double(length_of(label)));
  const double size = std::min(width * 0.9 / (kCharacter * characters), 12.0);
  if (size < kLeastFont) return {};
  return "<text x=\"" + drawn(middle) + "\" y=\"" + drawn(y) +
         "\" text-anchor=\"middle\" font-size=\"" + drawn(size) + "\">" + escape_xml(label) +
         "</text>\n";
}

// Phones as bands over the whole height; lip closures stand out.
std::string phones(const Panel& panel, const Axis& axis, const Place& at) {
  if (panel.script == nullptr) return {};
  std::string svg;
  for (const dam::Phone& phone : panel.script->phones) {
    if (phone.label == dam::kSilence || phone.end <= panel.begin || phone.start >= panel.seconds) {
      continue;
    }
    const double start = std::max(phone.start, panel.begin);
    const bool closure = phone.label == "P" || phone.label == "B" || phone.label == "M";
    const double width = (std::min(phone.end, panel.seconds) - start) * axis.scale;
    svg += "<rect x=\"" + drawn(axis.x(start)) + "\" y=\"" + drawn(at.begin + 4) + "\" width=\"" +
           drawn(width) + "\" height=\"" + drawn(at.rows_end() - at.begin) + "\" fill=\"" +
           (closure ? "#ffd9b3" : "#eef3fa") + "\" stroke=\"#ffffff\"/>\n" +
           phone_name(phone.label, axis.x(start) + width / 2, width, at.names);
  }
  return svg;
}

// What a row shows, to the left of it.
std::string row_names(const Row& row, double middle) {
  std::string svg;
  double y = middle - 4;
  const auto line = [&](const std::string& text, const char* style) {
    if (text.empty()) return;
    svg += "<text x=\"8\" y=\"" + drawn(y) + "\"" + style + ">" + escape_xml(text) + "</text>\n";
    y += 16;
  };
  line(row.title, "");
  line(row.subtitle, " fill=\"#555555\" font-size=\"11\"");
  line(row.unit, " fill=\"#555555\" font-size=\"11\"");
  return svg;
}

// Pieces of a curve, which is broken where its value is no number.
std::string curve_svg(const Points& curve, const Axis& axis, const Pen& pen,
                      const std::function<double(double)>& y) {
  std::string svg;
  bool open = false;
  for (const auto& [time, value] : curve) {
    const bool shown = axis.shows(time) && !std::isnan(value);
    if (shown && !open) {
      svg += std::string(
                 "<polyline fill=\"none\" stroke-width=\"2\" stroke-linejoin=\"round\" "
                 "stroke=\"") +
             pen.colour + "\"" + pen.dashes + " points=\"";
    }
    if (!shown && open) svg += "\"/>\n";
    open = shown;
    if (shown) svg += drawn(axis.x(time)) + "," + drawn(y(value)) + " ";
  }
  return open ? svg + "\"/>\n" : svg;
}

std::string row_svg(const Row& row, const Scale& scale, const Axis& axis, double base,
                    double width) {
  const auto y = [&](double value) {
    return base + kRow - 12 - (value - scale.low) / (scale.high - scale.low) * (kRow - 24);
  };
  std::string svg = row_names(row, base + kRow / 2);
  const auto first = std::lround(scale.low / scale.step);
  const auto last = std::lround(scale.high / scale.step);
  for (auto i = first; i <= last; ++i) {
    const std::string at = drawn(y(double(i) * scale.step));
    const double value = double(i) * scale.step;
    svg += "<line x1=\"" + drawn(kLeft) + "\" x2=\"" + drawn(width - kRight) + "\" y1=\"" + at +
           "\" y2=\"" + at + "\" stroke=\"" + (i == 0 ? "#888888" : "#eeeeee") +
           "\"/>\n<text x=\"" + drawn(kLeft - 6) + "\" y=\"" + drawn(y(value) + 4) +
           "\" text-anchor=\"end\" fill=\"#555555\" font-size=\"11\">" +
           tools::format(scale.step < 0.99 ? "%.1f" : "%.0f", value) + "</text>\n";
  }
  for (std::size_t i = 0; i < row.curves.size(); ++i) {
    svg += curve_svg(row.curves[i], axis, kPens[row.first_colour + i], y);
  }
  return svg;
}

// Bars below the curves of a row.
std::string bars_svg(const Row& row, const Axis& axis, double base) {
  std::string svg;
  for (std::size_t i = 0; i < row.bars.size(); ++i) {
    const double y = base + kRow - 9 + kBar * double(i);
    for (const auto& [begin, end] : row.bars[i]) {
      if (end < axis.begin || begin > axis.end) continue;
      const double from = axis.x(std::max(begin, axis.begin));
      svg += "<rect x=\"" + drawn(from) + "\" y=\"" + drawn(y) + "\" width=\"" +
             drawn(axis.x(std::min(end, axis.end)) - from) + "\" height=\"" + drawn(kBar - 1) +
             "\" fill=\"" + kPens[row.first_colour + i].colour + "\"/>\n";
    }
  }
  return svg;
}

// Lines of the legend one below the other, each with a piece of its curve.
std::string legend_svg(const std::vector<std::string>& names, double top) {
  std::string svg;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double y = top + kLegendLine * double(i) + kLegendLine / 2;
    const Pen& pen = kPens[i];
    svg += "<line x1=\"8\" x2=\"38\" y1=\"" + drawn(y) + "\" y2=\"" + drawn(y) +
           "\" stroke-width=\"2\" stroke=\"" + pen.colour + "\"" + pen.dashes +
           "/>\n<text x=\"46\" y=\"" + drawn(y + 4) + "\">" + escape_xml(names[i]) + "</text>\n";
  }
  return svg;
}

}  // namespace

std::string curves_svg(const std::vector<Panel>& panels, const std::vector<std::string>& legend) {
  const Axis axis = axis_of(panels);
  const double width = axis.x(axis.end) + kRight;
  std::string body;
  double offset = 0;
  for (const Panel& panel : panels) {
    const Place at = place(panel, offset);
    body += heading(panel, at) + time_axis(panel, axis, at) + phones(panel, axis, at);
    const std::vector<Scale> scales = scales_of(panel, axis);
    for (std::size_t i = 0; i < panel.rows.size(); ++i) {
      const double base = at.top + double(i) * kRow;
      body += row_svg(panel.rows[i], scales[i], axis, base, width) +
              bars_svg(panel.rows[i], axis, base);
    }
    offset = at.end;
  }
  body += "<text x=\"" + drawn((kLeft + width - kRight) / 2) + "\" y=\"" + drawn(offset + 8) +
          "\" text-anchor=\"middle\">Time (s)</text>\n";
  offset += kTitle;
  const std::string size[2] = {drawn(width),
                               drawn(offset + kLegendLine * double(legend.size()) + 8)};
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size[0] + "\" height=\"" + size[1] +
         "\" viewBox=\"0 0 " + size[0] + " " + size[1] +
         "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body +
         legend_svg(legend, offset) + "</svg>\n";
}

bool is_drawing(const std::string& path) {
  const std::string extension = tools::extension_of(path);
  return extension == ".svg" || extension == ".png" || path == "-";
}

Result<std::vector<std::uint8_t>> drawing_bytes(const std::string& path, const std::string& svg) {
  if (tools::extension_of(path) != ".png") return std::vector<std::uint8_t>(svg.begin(), svg.end());
  Result<std::vector<std::uint8_t>> png = media::svg_to_png(svg);
  if (!png) return png.error().in_file(path);
  return png;
}

}  // namespace animeme::plot

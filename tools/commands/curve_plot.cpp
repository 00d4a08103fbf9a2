#include "tools/commands/curve_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/commands/common.h"
#include "tools/media/picture.h"

namespace animeme::tools {

namespace {

constexpr double kLeft = 150;
constexpr double kRight = 20;
constexpr double kRow = 110;
constexpr double kBand = 26;
constexpr double kHeading = 30;
constexpr double kAxis = 30;
constexpr double kPixelsPerSecond = 260;
constexpr double kLeastPixelsPerSecond = 19;
// A width that fits a screen; phones need more room to be read.
constexpr double kWide = 2400;
constexpr double kWideWithPhones = 8000;
constexpr const char* kColours[] = {"#1f5fbf", "#d1495b", "#2a8c55"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

// The time axis that all panels share.
struct Axis {
  double begin = 0;
  double end = 0;
  double scale = kPixelsPerSecond;

  double x(double seconds) const { return kLeft + (seconds - begin) * scale; }
  bool shows(double seconds) const { return seconds >= begin && seconds <= end; }
};

Axis axis_of(const std::vector<PlotPanel>& panels) {
  Axis axis{panels.empty() ? 0 : panels.front().begin, 0, kPixelsPerSecond};
  double wide = kWide;
  for (const PlotPanel& panel : panels) {
    if (panel.script != nullptr) wide = kWideWithPhones;
    axis.begin = std::min(axis.begin, panel.begin);
    axis.end = std::max(axis.end, panel.seconds);
  }
  const double seconds = std::max(axis.end - axis.begin, 0.04);
  axis.scale = std::clamp(wide / seconds, kLeastPixelsPerSecond, kPixelsPerSecond);
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

Place place(const PlotPanel& panel, double offset) {
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

std::string heading(const PlotPanel& panel, const Place& at) {
  if (panel.heading.empty()) return {};
  return "<text x=\"8\" y=\"" + number(at.begin - 8) + "\" font-size=\"14\" font-weight=\"bold\">" +
         escape_xml(panel.heading) + "</text>\n";
}

std::string time_axis(const PlotPanel& panel, const Axis& axis, const Place& at) {
  double step = 0.5;
  for (const double wider : {1.0, 2.0, 5.0}) {
    if (step * axis.scale < 60) step = wider;
  }
  std::string svg;
  const auto first = std::int64_t(std::ceil(panel.begin / step - 1e-9));
  for (std::int64_t i = first; double(i) * step <= panel.seconds + 1e-9; ++i) {
    const std::string column = number(axis.x(double(i) * step));
    svg += "<line x1=\"" + column + "\" x2=\"" + column + "\" y1=\"" + number(at.top) + "\" y2=\"" +
           number(at.rows_end() + 4) + "\" stroke=\"#dddddd\"/>\n<text x=\"" + column + "\" y=\"" +
           number(at.end - 10) + "\" text-anchor=\"middle\" fill=\"#555555\">" +
           number(double(i) * step) + " s</text>\n";
  }
  return svg;
}

// Phones as bands over the whole height; lip closures stand out.
std::string phones(const PlotPanel& panel, const Axis& axis, const Place& at) {
  if (panel.script == nullptr) return {};
  std::string svg;
  for (const dam::Phone& phone : panel.script->phones) {
    if (phone.label == dam::kSilence || phone.end <= panel.begin || phone.start >= panel.seconds) {
      continue;
    }
    const double start = std::max(phone.start, panel.begin);
    const bool closure = phone.label == "P" || phone.label == "B" || phone.label == "M";
    const double width = (std::min(phone.end, panel.seconds) - start) * axis.scale;
    svg += "<rect x=\"" + number(axis.x(start)) + "\" y=\"" + number(at.begin + 4) + "\" width=\"" +
           number(width) + "\" height=\"" + number(at.rows_end() - at.begin) + "\" fill=\"" +
           (closure ? "#ffd9b3" : "#eef3fa") + "\" stroke=\"#ffffff\"/>\n<text x=\"" +
           number(axis.x(start) + width / 2) + "\" y=\"" + number(at.names) +
           "\" text-anchor=\"middle\" font-size=\"" + number(std::clamp(width * 0.6, 7.0, 12.0)) +
           "\">" + escape_xml(phone.label) + "</text>\n";
  }
  return svg;
}

std::string row_svg(const PlotRow& row, const Axis& axis, double base, double width) {
  double low = 0;
  double high = 0;
  for (const PlotPoints& curve : row.curves) {
    for (const auto& [time, value] : curve) {
      if (!axis.shows(time)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (high - low < 1) high = low + 1;
  const auto y = [&](double value) {
    return base + kRow - 12 - (value - low) / (high - low) * (kRow - 24);
  };
  std::string svg = "<text x=\"8\" y=\"" + number(base + kRow / 2 - 4) + "\">" +
                    escape_xml(row.title) + "</text>\n<text x=\"8\" y=\"" +
                    number(base + kRow / 2 + 12) + "\" fill=\"#555555\" font-size=\"11\">" +
                    escape_xml(row.subtitle) + "</text>\n<line x1=\"" + number(kLeft) + "\" x2=\"" +
                    number(width - kRight) + "\" y1=\"" + number(y(0)) + "\" y2=\"" + number(y(0)) +
                    "\" stroke=\"#888888\"/>\n";
  for (const double edge : {low, high}) {
    svg += "<text x=\"" + number(kLeft - 6) + "\" y=\"" + number(y(edge) + 4) +
           "\" text-anchor=\"end\" fill=\"#555555\" font-size=\"11\">" +
           std::to_string(std::lround(edge)) + "</text>\n";
  }
  for (std::size_t i = 0; i < row.curves.size(); ++i) {
    svg += std::string("<polyline fill=\"none\" stroke-width=\"2\" stroke=\"") +
           kColours[row.first_colour + i] + "\" points=\"";
    for (const auto& [time, value] : row.curves[i]) {
      if (axis.shows(time)) svg += number(axis.x(time)) + "," + number(y(value)) + " ";
    }
    svg += "\"/>\n";
  }
  return svg;
}

std::string legend_svg(const std::vector<std::string>& names, double bottom) {
  std::string svg;
  double at = 8;
  for (std::size_t i = 0; i < names.size(); ++i) {
    svg += "<text x=\"" + number(at) + "\" y=\"" + number(bottom + 8) + "\" fill=\"" + kColours[i] +
           "\">" + escape_xml(names[i]) + "</text>\n";
    at += 30 + 7.0 * double(names[i].size());
  }
  return svg;
}

}  // namespace

std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string curves_svg(const std::vector<PlotPanel>& panels,
                       const std::vector<std::string>& legend) {
  const Axis axis = axis_of(panels);
  const double width = axis.x(axis.end) + kRight;
  std::string body;
  double offset = 0;
  for (const PlotPanel& panel : panels) {
    const Place at = place(panel, offset);
    body += heading(panel, at) + time_axis(panel, axis, at) + phones(panel, axis, at);
    for (std::size_t i = 0; i < panel.rows.size(); ++i) {
      body += row_svg(panel.rows[i], axis, at.top + double(i) * kRow, width);
    }
    offset = at.end;
  }
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width) + "\" height=\"" +
         number(offset + 20) + "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body +
         legend_svg(legend, offset) + "</svg>\n";
}

Result<void> write_drawing(const std::string& path, const std::string& svg) {
  if (extension_of(path) != ".png") return write_file(path, svg);
  Result<std::vector<std::uint8_t>> png = media::svg_to_png(svg);
  if (!png) return png.error().in_file(path);
  return write_file(path, *png);
}

}  // namespace animeme::tools

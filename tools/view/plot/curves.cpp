#include "tools/view/plot/curves.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"
#include "tools/formats/files/files.h"
#include "tools/formats/media/picture.h"
#include "tools/view/plot/pdf.h"

namespace animeme::plot {

using tools::drawn;
using tools::escape_xml;

namespace {

constexpr double kCharacter = 0.64;  // width against the size of the font; wide fonts, too
constexpr double kLeastFont = 6.5;
constexpr double kLeastPixelsPerSecond = 19;
constexpr double kNarrow = 600;
// How wide a second is, and the most that fits a screen; phones need more room to be read.
struct Room {
  double second, most;
};
constexpr Room kPlain{260, 2400};
constexpr Room kWithPhones{320, 8000};

// Lengths in pixels.
struct Measures {
  bool print = false;  // of a given width
  double font = 12, small = 11, bold = 14;
  double left = 150, right = 34;  // of the curves
  double row = 110;
  double above = 12, below = 12;  // between the ends of a row and those of its scale
  double band = 26, names = 20;   // of phones, and the baseline of their names in it
  double bar = 5;
  double heading = 30;
  double axis = 30, axis_title = 20;  // below the rows, and below that
  double legend_line = 18;
  double line = 2;         // width of a curve
  double least_ticks = 0;  // between two ticks of values
  double least_time = 60;  // between two of time
};

constexpr double kPrintRow = 66, kLeastPrintRow = 46;

struct Pen {
  const char* colour;
  const char* dashes;
};
constexpr Pen kPens[] = {
    {"#0072b2", ""}, {"#d55e00", " stroke-dasharray=\"7 3\""}, {"#00875f", ""}};

// The axis of a panel.
struct Axis {
  double begin = 0;
  double end = 0;
  double left = 0;
  double scale = 1;  // pixels a second

  double x(double seconds) const { return left + (seconds - begin) * scale; }
  bool shows(double seconds) const { return seconds >= begin && seconds <= end; }
};

// Values of a unit, from tick to tick.
struct Scale {
  double low = 0, high = 0, step = 1;
};

// 1, 2 or 5 times a power of ten, `least` or more.
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (least <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

// Characters of a text in UTF-8.
std::int64_t length_of(const std::string& text) {
  return std::count_if(text.begin(), text.end(),
                       [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
}

double width_of(const std::string& text, double font) {
  return kCharacter * font * double(length_of(text));
}

void set_ends(Scale& scale, double room, const Measures& m) {
  scale.high = std::max(scale.high, scale.low + 1);
  const Scale values = scale;
  // Three to seven ticks, or as many as there is room for.
  scale.step = round_step((values.high - values.low) / 5);
  while (true) {
    scale.low = std::floor(values.low / scale.step + 1e-9) * scale.step;
    scale.high = std::ceil(values.high / scale.step - 1e-9) * scale.step;
    const double apart = room * scale.step / (scale.high - scale.low);
    // Values on both sides of 0 keep a tick on each.
    if (apart >= m.least_ticks || scale.high - scale.low < 2.5 * scale.step) return;
    scale.step = round_step(1.5 * scale.step);
  }
}

// One for each row: rows of one unit share theirs, so that they can be compared, unless each is to
// have its own. 0 is always on it.
std::vector<Scale> scales_of(const Panel& panel, const Axis& axis, bool own, const Measures& m) {
  std::map<std::string, Scale> of_units;
  const auto key_of = [&](std::size_t row) {
    return own ? std::to_string(row) : panel.rows[row].unit;
  };
  for (std::size_t row = 0; row < panel.rows.size(); ++row) {
    Scale& scale = of_units[key_of(row)];
    for (const Points& curve : panel.rows[row].curves) {
      for (const auto& [time, value] : curve) {
        if (!axis.shows(time) || std::isnan(value)) continue;
        scale.low = std::min(scale.low, value);
        scale.high = std::max(scale.high, value);
      }
    }
  }
  for (auto& entry : of_units) set_ends(entry.second, m.row - m.above - m.below, m);
  std::vector<Scale> scales;
  for (std::size_t row = 0; row < panel.rows.size(); ++row) scales.push_back(of_units[key_of(row)]);
  return scales;
}

std::string tick_text(const Scale& scale, std::int64_t number) {
  return tools::format(scale.step < 0.99 ? "%.1f" : "%.0f", double(number) * scale.step);
}

double widest_tick(const Scale& scale, const Measures& m) {
  double widest = 0;
  for (const double value : {scale.low, scale.high})
    widest = std::max(widest, width_of(tick_text(scale, std::lround(value / scale.step)), m.small));
  return widest;
}

std::string seconds_of(double time, double step) {
  return tools::format(step < 0.09 ? "%.2f" : step < 0.99 ? "%.1f" : "%.4g", time);
}

// Where the parts of a panel lie.
struct Place {
  double begin = 0;  // below the heading
  double top = 0;    // of the rows
  double names = 0;  // baseline of the phones' names
  double end = 0;    // below the time axis
};

/// Draws panels one below the other.
class Drawing {
 public:
  Drawing(const std::vector<Panel>& panels, const std::vector<std::string>& legend,
          const Layout& layout)
      : panels_(panels), legend_(legend), layout_(layout) {
    if (layout.width > 0) {
      m_ = print_measures();
      if (layout.height > 0) {
        const double rest = layout.height - height_without_rows();
        m_.row = std::max(rest / double(std::max<std::size_t>(rows(), 1)), kLeastPrintRow);
      }
    }
    lay_out();
  }

  double height_without_rows() const {
    double height = legend_height() + (layout_.title.empty() ? 0 : m_.heading);
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      const Place at = place(panels_[i], 0);
      height += at.end - double(panels_[i].rows.size()) * m_.row;
      if (titled(i)) height += m_.axis_title;
    }
    return height;
  }
  std::size_t rows() const {
    std::size_t count = 0;
    for (const Panel& panel : panels_) count += panel.rows.size();
    return count;
  }

  std::string svg() const {
    std::string body;
    double offset = 0;
    if (!layout_.title.empty()) {
      body += "<text x=\"" + drawn(width_ / 2) + "\" y=\"" + drawn(m_.heading * 0.65) +
              "\" text-anchor=\"middle\" font-size=\"" + drawn(m_.bold) +
              "\" font-weight=\"bold\">" + escape_xml(layout_.title) + "</text>\n";
      offset += m_.heading;
    }
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      const Panel& panel = panels_[p];
      const Axis& axis = axes_[p];
      const Place at = place(panel, offset);
      body += heading(panel, at) + time_axis(panel, axis, at) + phones(panel, axis, at);
      for (std::size_t i = 0; i < panel.rows.size(); ++i) {
        const double base = at.top + double(i) * m_.row;
        body +=
            row_svg(panel.rows[i], scales_[p][i], axis, base) + bars_svg(panel.rows[i], axis, base);
      }
      offset = at.end;
      if (!titled(p)) continue;
      body += "<text x=\"" + drawn((left_ + width_ - m_.right) / 2) + "\" y=\"" +
              drawn(offset + (m_.print ? 6 : 8)) + "\" text-anchor=\"middle\">" +
              escape_xml(panel.axis) + "</text>\n";
      offset += m_.axis_title;
    }
    return head(offset + legend_height()) + body + legend_svg(offset) + "</svg>\n";
  }

 private:
  static Measures print_measures() {
    Measures m;
    m.print = true;
    m.font = 10.67;  // 8 points
    m.small = 9.33;  // 7
    m.bold = 12;
    m.right = 8;
    m.row = kPrintRow;
    m.above = 19;
    m.below = 5;
    m.band = 15;
    m.names = 12;
    m.bar = 3;
    m.heading = 20;
    m.axis = 18;
    m.axis_title = 15;
    m.legend_line = 15;
    m.line = 1.2;
    m.least_ticks = 10;
    m.least_time = 36;
    return m;
  }

  // The title of its axis stands below a panel if the next one has another.
  bool titled(std::size_t panel) const {
    return panel + 1 == panels_.size() || panels_[panel + 1].axis != panels_[panel].axis;
  }

  double legend_height() const { return m_.legend_line * double(legend_lines()) + 8; }

  // Print has names beside each other where there is room.
  bool legend_in_a_line() const {
    double width = 8;
    for (const std::string& name : legend_) width += 30 + width_of(name, m_.font);
    return m_.print && layout_.width >= width;
  }
  std::size_t legend_lines() const {
    return legend_in_a_line() ? std::min<std::size_t>(legend_.size(), 1) : legend_.size();
  }

  Place place(const Panel& panel, double offset) const {
    Place at;
    const bool above = panel.script != nullptr && !panel.names_below;
    const bool below = panel.script != nullptr && panel.names_below;
    const double gap = m_.print ? 2 : 8;
    at.begin = offset + (panel.heading.empty() ? 0 : m_.heading);
    at.top = at.begin + (above ? m_.band + gap : gap);
    const double rows = at.top + double(panel.rows.size()) * m_.row;
    at.names = below ? rows + 12 : at.begin + m_.names;
    at.end = rows + (below ? m_.band - gap : 0) + m_.axis;
    return at;
  }
  double rows_end(const Place& at) const { return at.end - m_.axis; }

  void lay_out() {
    // Seconds of the panels of each axis.
    std::map<std::string, std::pair<double, double>> ends;
    Room room = kPlain;
    for (const Panel& panel : panels_) {
      if (panel.script != nullptr) room = kWithPhones;
      const auto found = ends.try_emplace(panel.axis, panel.begin, 0.0).first;
      found->second.first = std::min(found->second.first, panel.begin);
      found->second.second = std::max(found->second.second, panel.seconds);
    }
    for (const Panel& panel : panels_) {
      const auto [begin, end] = ends[panel.axis];
      axes_.push_back({begin, end, 0, 1});
    }
    for (std::size_t p = 0; p < panels_.size(); ++p)
      scales_.push_back(scales_of(panels_[p], axes_[p], layout_.own_scales, m_));
    left_ = m_.print ? 0 : m_.left;
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      for (std::size_t i = 0; i < panels_[p].rows.size(); ++i) {
        const Row& row = panels_[p].rows[i];
        const double ticks = widest_tick(scales_[p][i], m_) + (m_.print ? 8 : 14);
        double names = 0;
        if (!m_.print) {
          names = std::max({width_of(row.title, m_.font), width_of(row.subtitle, m_.small),
                            width_of(row.unit, m_.small)});
        }
        left_ = std::max(left_, names + ticks);
      }
    }
    left_ = std::round(left_);
    double curves = layout_.width - left_ - m_.right;
    if (!m_.print) {
      const double length = axes_.empty() ? 0 : axes_.front().end - axes_.front().begin;
      const double seconds = std::max(length, 0.04);
      const double scale = std::clamp(room.most / seconds, kLeastPixelsPerSecond, room.second);
      curves = std::max(scale, kNarrow / seconds) * length;
    }
    for (Axis& axis : axes_) {
      axis.left = left_;
      axis.scale = curves / std::max(axis.end - axis.begin, 1e-9);
    }
    width_ = left_ + curves + m_.right;
  }

  std::string head(double height) const {
    const std::string size[2] = {drawn(width_), drawn(height)};
    std::string shown[2] = {size[0], size[1]};
    // The height keeps the picture's form.
    if (m_.print && !layout_.shown_width.empty()) {
      const std::string& text = layout_.shown_width;
      const double number = std::atof(text.c_str());
      const std::size_t letters = std::min(text.find_first_not_of("0123456789."), text.size());
      shown[0] = text;
      shown[1] = drawn(number * height / width_) + text.substr(letters);
    }
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + shown[0] + "\" height=\"" +
           shown[1] + "\" viewBox=\"0 0 " + size[0] + " " + size[1] +
           "\" font-family=\"sans-serif\" font-size=\"" + font_text(m_.font) + "\">\n" +
           "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  }

  static std::string font_text(double size) { return tools::format("%g", size); }

  std::string heading(const Panel& panel, const Place& at) const {
    if (panel.heading.empty()) return {};
    return "<text x=\"8\" y=\"" + drawn(at.begin - (m_.print ? 4 : 8)) + "\" font-size=\"" +
           font_text(m_.bold) + "\" font-weight=\"bold\">" + escape_xml(panel.heading) +
           "</text>\n";
  }

  std::string time_axis(const Panel& panel, const Axis& axis, const Place& at) const {
    double step = 0.01;
    for (const double wider :
         {0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
      if (step * axis.scale < m_.least_time) step = wider;
    }
    std::string svg;
    const auto first = std::int64_t(std::ceil(panel.begin / step - 1e-9));
    for (std::int64_t i = first; double(i) * step <= panel.seconds + 1e-9; ++i) {
      const double x = axis.x(double(i) * step);
      const std::string column = drawn(x), text = seconds_of(double(i) * step, step);
      // The last one must not leave a narrow picture.
      const bool fits = !m_.print || x + width_of(text, m_.small) / 2 <= width_;
      svg += "<line x1=\"" + column + "\" x2=\"" + column + "\" y1=\"" + drawn(at.top) +
             "\" y2=\"" + drawn(rows_end(at) + (m_.print ? 2 : 4)) + "\" stroke=\"#dddddd\"/>\n";
      svg += "<text x=\"" + (fits ? column : drawn(width_ - 1)) + "\" y=\"" +
             drawn(at.end - (m_.print ? 7 : 10)) + "\" text-anchor=\"" + (fits ? "middle" : "end") +
             "\" fill=\"#555555\"" +
             (m_.print ? " font-size=\"" + font_text(m_.small) + "\"" : "") + ">" + text +
             "</text>\n";
    }
    return svg;
  }

  // The name of a phone in its band, as large as fits; nothing if it could not be read.
  std::string phone_name(const std::string& label, double middle, double width, double y) const {
    const double characters = std::max(1.0, double(length_of(label)));
    const double size = std::min(width * 0.9 / (kCharacter * characters), m_.font);
    if (size < kLeastFont) return {};
    return "<text x=\"" + drawn(middle) + "\" y=\"" + drawn(y) +
           "\" text-anchor=\"middle\" font-size=\"" + drawn(size) + "\">" + escape_xml(label) +
           "</text>\n";
  }

  // Phones as bands over the whole height; lip closures stand out.
  std::string phones(const Panel& panel, const Axis& axis, const Place& at) const {
    if (panel.script == nullptr) return {};
    std::string svg;
    for (const dam::Phone& phone : panel.script->phones) {
      if (phone.label == dam::kSilence || phone.end <= panel.begin ||
          phone.start >= panel.seconds) {
        continue;
      }
      const double start = std::max(phone.start, panel.begin);
      const bool closure = phone.label == "P" || phone.label == "B" || phone.label == "M";
      const double width = (std::min(phone.end, panel.seconds) - start) * axis.scale;
      const double top = at.begin + (m_.print ? 1 : 4);
      svg += "<rect x=\"" + drawn(axis.x(start)) + "\" y=\"" + drawn(top) + "\" width=\"" +
             drawn(width) + "\" height=\"" + drawn(rows_end(at) - top + (m_.print ? 0 : 4)) +
             "\" fill=\"" + (closure ? "#ffd9b3" : "#eef3fa") + "\" stroke=\"#ffffff\"/>\n" +
             phone_name(phone.label, axis.x(start) + width / 2, width, at.names);
    }
    return svg;
  }

  // What a row shows: to the left of it, in print above it.
  std::string row_names(const Row& row, double base) const {
    std::string svg;
    if (m_.print) {
      std::string text = row.subtitle.empty() ? row.title : row.subtitle;
      if (!row.unit.empty()) text += " (" + row.unit + ")";
      const double size = std::min(
          m_.small, (width_ - left_ - m_.right) / (kCharacter * double(length_of(text) + 1)));
      return "<text x=\"" + drawn(left_ + 3) + "\" y=\"" + drawn(base + 13) + "\" font-size=\"" +
             drawn(size) + "\" fill=\"#333333\">" + escape_xml(text) + "</text>\n";
    }
    double y = base + m_.row / 2 - 4;
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
                        const std::function<double(double)>& y) const {
    std::string svg;
    bool open = false;
    for (const auto& [time, value] : curve) {
      const bool shown = axis.shows(time) && !std::isnan(value);
      if (shown && !open) {
        svg += "<polyline fill=\"none\" stroke-width=\"" + font_text(m_.line) +
               "\" stroke-linejoin=\"round\" stroke=\"" + pen.colour + "\"" + pen.dashes +
               " points=\"";
      }
      if (!shown && open) svg += "\"/>\n";
      open = shown;
      if (shown) svg += drawn(axis.x(time)) + "," + drawn(y(value)) + " ";
    }
    return open ? svg + "\"/>\n" : svg;
  }

  std::string row_svg(const Row& row, const Scale& scale, const Axis& axis, double base) const {
    const auto y = [&](double value) {
      return base + m_.row - m_.below -
             (value - scale.low) / (scale.high - scale.low) * (m_.row - m_.above - m_.below);
    };
    std::string svg = row_names(row, base);
    const auto first = std::lround(scale.low / scale.step);
    const auto last = std::lround(scale.high / scale.step);
    for (auto i = first; i <= last; ++i) {
      const std::string at = drawn(y(double(i) * scale.step));
      svg += "<line x1=\"" + drawn(left_) + "\" x2=\"" + drawn(width_ - m_.right) + "\" y1=\"" +
             at + "\" y2=\"" + at + "\" stroke=\"" + (i == 0 ? "#888888" : "#eeeeee") +
             "\"/>\n<text x=\"" + drawn(left_ - (m_.print ? 4 : 6)) + "\" y=\"" +
             drawn(y(double(i) * scale.step) + (m_.print ? 3 : 4)) +
             "\" text-anchor=\"end\" fill=\"#555555\" font-size=\"" + font_text(m_.small) + "\">" +
             tick_text(scale, i) + "</text>\n";
    }
    for (std::size_t i = 0; i < row.curves.size(); ++i) {
      svg += curve_svg(row.curves[i], axis, kPens[row.first_colour + i], y);
    }
    return svg;
  }

  // Bars below the curves of a row.
  std::string bars_svg(const Row& row, const Axis& axis, double base) const {
    std::string svg;
    for (std::size_t i = 0; i < row.bars.size(); ++i) {
      const double y = base + m_.row - (m_.print ? 6 : 9) + m_.bar * double(i);
      for (const auto& [begin, end] : row.bars[i]) {
        if (end < axis.begin || begin > axis.end) continue;
        const double from = axis.x(std::max(begin, axis.begin));
        svg += "<rect x=\"" + drawn(from) + "\" y=\"" + drawn(y) + "\" width=\"" +
               drawn(axis.x(std::min(end, axis.end)) - from) + "\" height=\"" + drawn(m_.bar - 1) +
               "\" fill=\"" + kPens[row.first_colour + i].colour + "\"/>\n";
      }
    }
    return svg;
  }

  // Each name with a piece of its curve.
  std::string legend_svg(double top) const {
    std::string svg;
    const double piece = m_.print ? 16 : 30;
    double x = 8;
    for (std::size_t i = 0; i < legend_.size(); ++i) {
      const bool beside = legend_in_a_line();
      const double y = top + m_.legend_line * (beside ? 0 : double(i)) + m_.legend_line / 2;
      const Pen& pen = kPens[i];
      svg += "<line x1=\"" + drawn(x) + "\" x2=\"" + drawn(x + piece) + "\" y1=\"" + drawn(y) +
             "\" y2=\"" + drawn(y) + "\" stroke-width=\"" + font_text(m_.line) + "\" stroke=\"" +
             pen.colour + "\"" + pen.dashes + "/>\n<text x=\"" +
             drawn(x + piece + (m_.print ? 4 : 8)) + "\" y=\"" + drawn(y + 4) + "\">" +
             escape_xml(legend_[i]) + "</text>\n";
      if (beside) x += 30 + width_of(legend_[i], m_.font);
    }
    return svg;
  }

  const std::vector<Panel>& panels_;
  const std::vector<std::string>& legend_;
  const Layout& layout_;
  Measures m_;
  double left_ = 0, width_ = 0;
  std::vector<Axis> axes_;                  // by panel
  std::vector<std::vector<Scale>> scales_;  // by panel and row
};

}  // namespace

double least_height(const std::vector<Panel>& panels, const std::vector<std::string>& legend,
                    const Layout& layout) {
  const Drawing drawing(panels, legend, layout);
  return drawing.height_without_rows() + kLeastPrintRow * double(drawing.rows());
}

std::string curves_svg(const std::vector<Panel>& panels, const std::vector<std::string>& legend,
                       const Layout& layout) {
  return Drawing(panels, legend, layout).svg();
}

bool is_drawing(const std::string& path) {
  const std::string extension = tools::extension_of(path);
  return extension == ".svg" || extension == ".png" || extension == ".pdf" || path == "-";
}

Result<std::vector<std::uint8_t>> drawing_bytes(const std::string& path, const std::string& svg) {
  const std::string extension = tools::extension_of(path);
  if (extension == ".pdf") return drawing_pdf(svg);
  if (extension != ".png") return std::vector<std::uint8_t>(svg.begin(), svg.end());
  Result<std::vector<std::uint8_t>> png = media::svg_to_png(svg);
  if (!png) return png.error().in_file(path);
  return png;
}

}  // namespace animeme::plot

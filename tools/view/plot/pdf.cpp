#include "tools/view/plot/pdf.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "tools/formats/common/text.h"

namespace animeme::plot {
namespace {

using SvgAttributes = std::map<std::string, std::string, std::less<>>;

// An element of a drawing, without others in it.
struct SvgElement {
  std::string name;
  SvgAttributes attributes;
  std::string text;

  std::string_view get(std::string_view key, std::string_view otherwise = "") const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? otherwise : std::string_view(found->second);
  }
  double number(std::string_view key, double otherwise = 0) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? otherwise : std::atof(found->second.c_str());
  }
};

std::string unescaped_xml(std::string_view text) {
  constexpr std::pair<std::string_view, char> kNames[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}};
  std::string out;
  while (!text.empty()) {
    bool found = false;
    for (const auto& [name, letter] : kNames) {
      if (!text.starts_with(name)) continue;
      out += letter;
      text.remove_prefix(name.size());
      found = true;
      break;
    }
    if (found) continue;
    out += text.front();
    text.remove_prefix(1);
  }
  return out;
}

/// Reads the elements one after the other.
class SvgElements {
 public:
  explicit SvgElements(std::string_view svg) : rest_(svg) {}

  /// Nothing at the end; `damaged()` tells whether it was one.
  std::optional<SvgElement> next() {
    const std::size_t begin = rest_.find('<');
    if (begin == rest_.npos) return std::nullopt;
    const std::size_t end = rest_.find('>', begin);
    if (end == rest_.npos) {
      damaged_ = true;
      return std::nullopt;
    }
    std::string_view tag = rest_.substr(begin + 1, end - begin - 1);
    rest_.remove_prefix(end + 1);
    SvgElement element;
    const bool closed = tag.ends_with('/');
    if (closed) tag.remove_suffix(1);
    const std::size_t name = std::min(tag.find(' '), tag.size());
    element.name = std::string(tag.substr(0, name));
    tag.remove_prefix(name);
    while (true) {
      const std::size_t equals = tag.find("=\"");
      if (equals == tag.npos) break;
      const std::size_t close = tag.find('"', equals + 2);
      if (close == tag.npos) {
        damaged_ = true;
        return std::nullopt;
      }
      const std::size_t key = tag.find_first_not_of(' ');
      element.attributes[std::string(tag.substr(key, equals - key))] =
          unescaped_xml(tag.substr(equals + 2, close - equals - 2));
      tag.remove_prefix(close + 1);
    }
    if (element.name == "text" && !closed) {
      const std::size_t stop = std::min(rest_.find('<'), rest_.size());
      element.text = unescaped_xml(rest_.substr(0, stop));
    }
    return element;
  }
  bool damaged() const { return damaged_; }

 private:
  std::string_view rest_;
  bool damaged_ = false;
};

// Widths of Helvetica's letters from the blank to the tilde, thousandths of its size.
constexpr std::array<int, 95> kHelvetica = {
    278,  278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,  //
    556,  556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,  //
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,  //
    667,  778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,  //
    333,  556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,  //
    556,  556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584};

// UTF-8 as Latin-1.
std::string latin_letters(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) {
      out += byte < 0x20 ? ' ' : char(byte);
    } else if ((byte == 0xC2 || byte == 0xC3) && i + 1 < text.size()) {
      const auto second = static_cast<unsigned char>(text[++i]);
      const int code = (byte & 3) << 6 | (second & 0x3F);
      out += code >= 0xA0 ? char(code) : '?';
    } else if ((byte & 0xC0) != 0x80) {
      out += '?';
    }
  }
  return out;
}

double width_in_helvetica(const std::string& text) {
  double sum = 0;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    sum += code >= 32 && code < 127 ? kHelvetica[code - 32] : 556;
  }
  return sum / 1000;
}

std::string pdf_string(std::string_view latin_text) {
  std::string out = "(";
  for (const char c : latin_text) {
    if (c == '(' || c == ')' || c == '\\') out += '\\';
    out += c;
  }
  return out + ")";
}

std::string pdf_number(double value) { return tools::format("%.2f", value); }

// Three numbers for #rrggbb, black for all else.
std::string pdf_colour(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return "0 0 0";
  const long all = std::strtol(std::string(text.substr(1)).c_str(), nullptr, 16);
  return tools::format("%.3f %.3f %.3f", double(all >> 16) / 255, double(all >> 8 & 255) / 255,
                       double(all & 255) / 255);
}

// Points for a length with a unit.
double page_points(std::string_view text) {
  const double number = std::atof(std::string(text).c_str());
  if (text.ends_with("mm")) return number * 72 / 25.4;
  return number * 0.75;
}

/// A page's content, in the coordinates of the drawing.
class PageContent {
 public:
  explicit PageContent(double font) : font_(font) {}

  void add(const SvgElement& e, double width, double height) {
    if (e.name == "rect") {
      const auto length = [&](std::string_view key, double whole) {
        return e.get(key).ends_with('%') ? whole * e.number(key) / 100 : e.number(key);
      };
      out_ += pdf_colour(e.get("fill")) + " rg " + pdf_number(e.number("x")) + " " +
              pdf_number(e.number("y")) + " " + pdf_number(length("width", width)) + " " +
              pdf_number(length("height", height)) + " re ";
      out_ += e.get("stroke").empty() ? "f\n" : pdf_colour(e.get("stroke")) + " RG 1 w [] 0 d B\n";
    } else if (e.name == "line") {
      stroke(e);
      out_ += pdf_number(e.number("x1")) + " " + pdf_number(e.number("y1")) + " m " +
              pdf_number(e.number("x2")) + " " + pdf_number(e.number("y2")) + " l S\n";
    } else if (e.name == "polyline") {
      stroke(e);
      polyline(std::string(e.get("points")));
    } else if (e.name == "text") {
      text(e);
    }
  }
  const std::string& bytes() const { return out_; }

 private:
  void stroke(const SvgElement& e) {
    out_ += pdf_colour(e.get("stroke")) + " RG " + pdf_number(e.number("stroke-width", 1)) +
            " w [" + std::string(e.get("stroke-dasharray")) + "] 0 d 1 j ";
  }

  void polyline(const std::string& points) {
    const char* at = points.c_str();
    char* end = nullptr;
    bool first = true;
    std::string last;
    while (true) {
      const double x = std::strtod(at, &end);
      if (end == at) break;
      const double y = std::strtod(*end == ',' ? end + 1 : end, &end);
      at = end;
      last = pdf_number(x) + " " + pdf_number(y);
      out_ += last + (first ? " m " : " l ");
      first = false;
    }
    if (!last.empty()) out_ += last + " l S\n";  // a single point is seen, too
  }

  void text(const SvgElement& e) {
    const double size = e.number("font-size", font_);
    const std::string letters = latin_letters(e.text);
    const double wide = width_in_helvetica(letters) * size;
    const std::string_view anchor = e.get("text-anchor");
    const double x = e.number("x") - (anchor == "end" ? wide : anchor == "middle" ? wide / 2 : 0);
    const bool bold = e.get("font-weight") == "bold";
    // The page is upside down: letters are not.
    out_ += "BT " + pdf_colour(e.get("fill", "#000000")) + " rg /" + (bold ? "B" : "R") + " " +
            pdf_number(size) + " Tf 1 0 0 -1 " + pdf_number(x) + " " + pdf_number(e.number("y")) +
            " Tm " + pdf_string(letters) + " Tj ET\n";
  }

  std::string out_;
  double font_;
};

/// Objects with their places.
class PdfFile {
 public:
  void object(const std::string& body) {
    places_.push_back(bytes_.size());
    bytes_ += std::to_string(places_.size()) + " 0 obj\n" + body + "\nendobj\n";
  }
  std::vector<std::uint8_t> finish() {
    const std::size_t table = bytes_.size();
    const std::string count = std::to_string(places_.size() + 1);
    bytes_ += "xref\n0 " + count + "\n0000000000 65535 f \n";
    for (const std::size_t place : places_) bytes_ += tools::format("%010zu 00000 n \n", place);
    bytes_ += "trailer\n<< /Size " + count + " /Root 1 0 R >>\nstartxref\n" +
              std::to_string(table) + "\n%%EOF\n";
    return {bytes_.begin(), bytes_.end()};
  }

 private:
  std::string bytes_ = "%PDF-1.4\n%\xE2\xE3\xCF\xD3\n";
  std::vector<std::size_t> places_;
};

}  // namespace

Result<std::vector<std::uint8_t>> drawing_pdf(std::string_view svg) {
  SvgElements elements(svg);
  const auto head = elements.next();
  const auto other = [] {
    return make_error(Code::syntax, "only drawings of this program can be written as PDF");
  };
  if (!head || head->name != "svg") return other();
  const std::string box(head->get("viewBox"));
  double view[4] = {};
  if (std::sscanf(box.c_str(), "%lf %lf %lf %lf", &view[0], &view[1], &view[2], &view[3]) != 4 ||
      !(view[2] > 0 && view[3] > 0)) {
    return other();
  }
  const double width = page_points(head->get("width")), height = page_points(head->get("height"));
  PageContent content(head->number("font-size", 12));
  while (const auto element = elements.next()) content.add(*element, view[2], view[3]);
  if (elements.damaged()) return other();
  const std::string stream = tools::format("%.6f", width / view[2]) + " 0 0 -" +
                             tools::format("%.6f", height / view[3]) + " 0 " + pdf_number(height) +
                             " cm\n" + content.bytes();
  const auto font = [](const char* name) {
    return "<< /Type /Font /Subtype /Type1 /BaseFont /" + std::string(name) +
           " /Encoding /WinAnsiEncoding >>";
  };
  PdfFile file;
  file.object("<< /Type /Catalog /Pages 2 0 R >>");
  file.object("<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
  file.object("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + pdf_number(width) + " " +
              pdf_number(height) +
              "] /Contents 4 0 R /Resources << /Font << /R 5 0 R /B 6 0 R >> >> >>");
  file.object("<< /Length " + std::to_string(stream.size()) + " >>\nstream\n" + stream +
              "endstream");
  file.object(font("Helvetica"));
  file.object(font("Helvetica-Bold"));
  return file.finish();
}

}  // namespace animeme::plot

#include "tools/view/studio/captions.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/formats/common/xml.h"

namespace animeme::studio {

using tools::drawn;
using tools::escape_xml;

namespace {

// Columns of a line, by the shape of the picture.
std::size_t columns_of(int width, int height) {
  const double shape = double(width) / std::max(height, 1);
  if (shape > 1.2) return 42;
  return shape > 0.8 ? 32 : 22;
}

constexpr double kLetterWidth = 0.54;    // of a Latin letter on average, in sizes of the font
constexpr double kLineWidth = 0.94;      // of the picture
constexpr double kHighest = 1.0 / 13;    // size of the font, of the height of the picture
constexpr double kLineHeight = 1.3;      // in sizes of the font
constexpr double kBelowCaption = 0.045;  // below the last line, of the height of the picture
constexpr double kOutline = 0.14;        // in sizes of the font
constexpr const char* kSaidColour = "#ffd84a";

// Code points of scripts that are written from right to left (Unicode blocks Hebrew to Arabic
// Extended-A, and presentation forms).
bool from_right(std::string_view text) {
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const auto a = std::uint8_t(text[i]), b = std::uint8_t(text[i + 1]);
    if (a >= 0xD6 && a <= 0xDF) return true;               // U+0580 to U+07FF
    if (a == 0xE0 && b >= 0xA0 && b <= 0xA3) return true;  // U+0800 to U+08FF
    if (a != 0xEF || i + 2 >= text.size()) continue;
    const int low = (b & 0x3F) << 6 | (std::uint8_t(text[i + 2]) & 0x3F);
    if ((low >= 0xB1D && low <= 0xDFF) || (low >= 0xE70 && low <= 0xEFE)) return true;
  }
  return false;
}

// What is above over what is below, where colours above are multiplied with alpha and those below
// are not.
void lay_over(const std::uint8_t* above, std::uint8_t* below) {
  const int cover = above[3];
  if (cover == 0) return;
  const int left = below[3] * (255 - cover);  // share of what is below, of 255 * 255
  const int alpha = cover * 255 + left;
  for (int c = 0; c < 3; ++c) {
    const int sum = above[c] * 255 * 255 + below[c] * left;
    below[c] = std::uint8_t(std::clamp((sum + alpha / 2) / alpha, 0, 255));
  }
  below[3] = std::uint8_t((alpha + 127) / 255);
}

}  // namespace

CaptionPainter::CaptionPainter(const dam::Script& script, int width, int height)
    : width_(width), height_(height) {
  dam::CaptionLimits limits;
  limits.columns = columns_of(width, height);
  captions_ = dam::captions_of(script, limits);
  letter_ =
      std::min(kLineWidth * width / (kLetterWidth * double(limits.columns)), kHighest * height);
}

std::optional<CaptionPainter::Shown> CaptionPainter::shown_at(double seconds) const {
  const auto next =
      std::upper_bound(captions_.begin(), captions_.end(), seconds,
                       [](double at, const dam::Caption& caption) { return at < caption.start; });
  if (next == captions_.begin()) return std::nullopt;
  const dam::Caption& caption = *(next - 1);
  if (seconds >= caption.end) return std::nullopt;
  Shown shown{std::size_t(next - 1 - captions_.begin()), 0};
  std::size_t number = 0;
  for (const auto& line : caption.lines) {
    for (const dam::ScriptWord& word : line) {
      ++number;
      if (seconds >= word.start && seconds < word.end) shown.word = number;
    }
  }
  return shown;
}

std::string CaptionPainter::drawing_of(const Shown& shown) const {
  const dam::Caption& caption = captions_[shown.caption];
  const double high = letter_ * (kLineHeight * double(caption.lines.size()) + 0.4);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + drawn(width_) +
                    "\" height=\"" + drawn(std::ceil(high)) +
                    "\" font-family=\"sans-serif\" font-weight=\"bold\" font-size=\"" +
                    drawn(letter_) +
                    "\" text-anchor=\"middle\" fill=\"#ffffff\" stroke=\"#101216\" "
                    "stroke-linejoin=\"round\" paint-order=\"stroke\" stroke-width=\"" +
                    drawn(letter_ * kOutline) + "\">\n";
  std::size_t number = 0;
  double below = letter_;
  for (const auto& line : caption.lines) {
    svg += "<text xml:space=\"preserve\" x=\"" + drawn(width_ / 2.0) + "\" y=\"" + drawn(below) +
           "\">";
    below += letter_ * kLineHeight;
    const std::string whole = dam::caption_line(line);
    if (from_right(whole)) {
      // Parts of a line of this kind would be put in the order of the file.
      svg += escape_xml(whole);
      number += line.size();
    } else {
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0 && dam::blank_between(line[i - 1].text, line[i].text)) svg += ' ';
        const std::string text = escape_xml(line[i].text);
        const bool said = ++number == shown.word;
        svg +=
            said ? std::string("<tspan fill=\"") + kSaidColour + "\">" + text + "</tspan>" : text;
      }
    }
    svg += "</text>\n";
  }
  return svg + "</svg>\n";
}

Result<void> CaptionPainter::draw(double seconds, std::vector<std::uint8_t>& rgba) {
  const std::optional<Shown> shown = shown_at(seconds);
  if (!shown) return {};
  if (shown != drawn_) {
    Result<media::Pixels> pixels = media::svg_to_overlay(drawing_of(*shown));
    if (!pixels) return pixels.error();
    overlay_ = std::move(*pixels);
    drawn_ = shown;
  }
  const int wide = std::min(overlay_.width, width_);
  const int high = std::min(overlay_.height, height_);
  const int top = std::max(height_ - high - int(std::lround(kBelowCaption * height_)), 0);
  for (int y = 0; y < high; ++y) {
    const std::uint8_t* from = &overlay_.rgba[std::size_t(y) * std::size_t(overlay_.width) * 4];
    std::uint8_t* to = &rgba[std::size_t(top + y) * std::size_t(width_) * 4];
    for (int x = 0; x < wide; ++x, from += 4, to += 4) lay_over(from, to);
  }
  return {};
}

}  // namespace animeme::studio

#include "tools/view/plot/strip.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "fap/tables.h"
#include "tools/formats/common/xml.h"
#include "tools/formats/media/picture.h"

namespace animeme::plot {

using tools::drawn;
using tools::escape_xml;

namespace {

constexpr double kPhones = 22;  // height of their row
constexpr double kNames = 14;
constexpr const char* kColours[] = {"#63b9f2", "#f0a030", "#dd93c4"};

}  // namespace

Strip::Strip(const fap::Sequence& clip, const StripOptions& options)
    : clip_(clip), options_(options) {
  if (options_.faps.size() > std::size(kColours)) options_.faps.resize(std::size(kColours));
  for (const int fap : options_.faps) {
    double largest = 1;
    for (const fap::Frame& frame : clip.frames) {
      largest = std::max(largest, std::abs(double(frame.value[std::size_t(fap)])));
    }
    scales_.push_back(largest);
  }
}

std::string Strip::page_svg(double begin) const {
  const double width = options_.width;
  const double height = options_.height;
  const auto x = [&](double seconds) { return (seconds - begin) / options_.page * width; };
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + drawn(width) +
                    "\" height=\"" + drawn(height) +
                    "\" font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"#14171c\"/>\n";
  double top = 4;
  if (options_.script != nullptr) {
    for (const dam::Phone& phone : options_.script->phones) {
      if (phone.end <= begin || phone.start >= begin + options_.page) continue;
      const double left = x(phone.start);
      const double wide = x(phone.end) - left;
      const bool silent = phone.label == dam::kSilence;
      svg += "<rect x=\"" + drawn(left) + "\" y=\"0\" width=\"" + drawn(std::max(wide - 1, 0.5)) +
             "\" height=\"" + drawn(kPhones) + "\" fill=\"" + (silent ? "#1d2229" : "#323b47") +
             "\"/>\n";
      if (silent || wide < 8) continue;
      svg += "<text x=\"" + drawn(left + wide / 2) + "\" y=\"" + drawn(kPhones - 6) +
             "\" fill=\"#ffffff\" text-anchor=\"middle\" font-size=\"" +
             drawn(std::clamp(wide * 0.5, 7.0, 13.0)) + "\">" + escape_xml(phone.label) +
             "</text>\n";
    }
    top += kPhones;
  }
  const double middle = (top + height - kNames) / 2;
  const double half = (height - kNames - top) / 2 - 2;
  svg += "<line x1=\"0\" x2=\"" + drawn(width) + "\" y1=\"" + drawn(middle) + "\" y2=\"" +
         drawn(middle) + "\" stroke=\"#414b58\"/>\n";
  double legend = 8;
  for (std::size_t i = 0; i < options_.faps.size(); ++i) {
    const auto fap = std::size_t(options_.faps[i]);
    svg += std::string("<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"") + kColours[i] +
           "\" points=\"";
    for (const fap::Frame& frame : clip_.frames) {
      const double seconds = clip_.rate.seconds(double(frame.number));
      if (seconds < begin - 0.1 || seconds > begin + options_.page + 0.1) continue;
      svg += drawn(x(seconds)) + "," + drawn(middle - frame.value[fap] / scales_[i] * half) + " ";
    }
    const std::string name(fap::info(int(fap)).name);
    svg += "\"/>\n<text x=\"" + drawn(legend) + "\" y=\"" + drawn(height - 4) +
           "\" font-size=\"11\" fill=\"" + kColours[i] + "\">" + escape_xml(name) + "</text>\n";
    legend += 18 + 6.5 * double(name.size());
  }
  return svg + "</svg>\n";
}

Result<void> Strip::draw(double seconds, int height, std::vector<std::uint8_t>& rgba) {
  const double begin = std::floor(seconds / options_.page) * options_.page;
  if (begin != begin_) {
    Result<media::Pixels> pixels = media::svg_to_rgba(page_svg(begin));
    if (!pixels) return pixels.error();
    if (pixels->width != options_.width || pixels->height != options_.height) {
      return make_error(Code::internal, "the strip has another size than was asked for");
    }
    page_ = std::move(pixels->rgba);
    begin_ = begin;
  }
  const std::size_t row = std::size_t(options_.width) * 4;
  const std::size_t first = std::size_t(height - options_.height);
  std::copy(page_.begin(), page_.end(), rgba.begin() + std::ptrdiff_t(first * row));
  const auto column = std::size_t((seconds - begin) / options_.page * options_.width);
  for (std::size_t y = first; y < std::size_t(height); ++y) {
    for (std::size_t x = column; x < std::min(column + 2, std::size_t(options_.width)); ++x) {
      std::fill_n(rgba.begin() + std::ptrdiff_t(y * row + x * 4), 4, std::uint8_t(255));
    }
  }
  return {};
}

}  // namespace animeme::plot

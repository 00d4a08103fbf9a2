#include "tools/speech/text/spoken_text.h"

#include <algorithm>

#include "dam/script/script_text_internal.h"

namespace animeme::text {

void SpokenText::add(std::u32string_view more, Place place) {
  text += more;
  places.insert(places.end(), more.size(), place);
}

void SpokenText::add(const SpokenText& other, std::size_t first, std::size_t last) {
  text.append(other.text, first, last - first);
  places.insert(places.end(), other.places.begin() + std::ptrdiff_t(first),
                other.places.begin() + std::ptrdiff_t(last));
}

Place SpokenText::place(std::size_t first, std::size_t last) const {
  Place all = places[first];
  for (std::size_t i = first; i < last; ++i) {
    all.first = std::min(all.first, places[i].first);
    all.last = std::max(all.last, places[i].last);
  }
  return all;
}

SpokenText SpokenText::part(std::size_t first, std::size_t last) const {
  SpokenText out;
  out.add(*this, first, last);
  return out;
}

SpokenText as_written(std::u32string_view text, std::size_t first) {
  SpokenText said;
  said.text = text;
  for (std::size_t i = 0; i < text.size(); ++i) {
    said.places.push_back({std::uint32_t(first + i), std::uint32_t(first + i + 1)});
  }
  return said;
}

std::u32string code_points(std::string_view text) {
  std::u32string out;
  while (!text.empty()) out += dam::take_code_point(text);
  return out;
}

std::string utf8(std::u32string_view text) {
  std::string out;
  for (const char32_t code : text) dam::append_utf8(out, code);
  return out;
}

}  // namespace animeme::text

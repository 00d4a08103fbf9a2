#include "tools/speech/talking/phone_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "dam/script/phones.h"

namespace animeme::speech {

namespace {

std::string_view take_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t\r"), line.size());
  const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

bool read_seconds(std::string_view word, double& seconds) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), seconds);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(seconds);
}

}  // namespace

Result<std::optional<dam::Phone>> parse_phone_line(std::string_view line) {
  const std::string_view first = take_word(line);
  if (first.empty() || first[0] == '#' || first.starts_with("start")) {
    return std::optional<dam::Phone>();
  }
  dam::Phone phone;
  const std::string_view second = take_word(line), label = take_word(line);
  if (!read_seconds(first, phone.start) || !read_seconds(second, phone.end) || label.empty()) {
    return make_error(Code::syntax, "a line needs start_s, end_s and a phone, as in: 0.21 0.25 B");
  }
  phone.label = dam::arpabet_label(label);
  if (phone.label.empty()) {
    return make_error(Code::not_found, "the phone " + std::string(label.substr(0, 40)) +
                                           " is not known; the nearest is " +
                                           std::string(dam::nearest_label(label)));
  }
  return std::optional<dam::Phone>(std::move(phone));
}

}  // namespace animeme::speech

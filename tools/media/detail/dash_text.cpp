#include "tools/media/detail/dash_text.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace animeme::media {

std::optional<std::int64_t> whole_number(const std::string& text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end) return std::nullopt;
  return value;
}

std::optional<double> period_seconds(std::string_view text) {
  if (!text.starts_with("PT")) return std::nullopt;
  text.remove_prefix(2);
  double total = 0;
  while (!text.empty()) {
    double value = 0;
    const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto used = std::size_t(at - text.data());
    if (error != std::errc() || used >= text.size()) return std::nullopt;
    const char unit = text[used];
    const double factor = unit == 'H' ? 3600 : unit == 'M' ? 60 : unit == 'S' ? 1 : NAN;
    total += value * factor;
    text.remove_prefix(used + 1);
  }
  if (!(total >= 0 && total < 1e9)) return std::nullopt;
  return total;
}

std::optional<std::string> fill_in(std::string_view pattern, std::int64_t number, std::int64_t time,
                                   const std::string& id) {
  std::string out;
  if (pattern.size() + id.size() > kLongestName) return std::nullopt;
  while (!pattern.empty()) {
    const std::size_t begin = pattern.find('$');
    out += pattern.substr(0, begin);
    if (begin == std::string_view::npos) break;
    const std::size_t end = pattern.find('$', begin + 1);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view name = pattern.substr(begin + 1, end - begin - 1);
    pattern.remove_prefix(end + 1);
    int width = 1;
    if (const std::size_t percent = name.find('%'); percent != std::string_view::npos) {
      const std::string_view form = name.substr(percent);  // %05d
      if (form.size() != 4 || form[1] != '0' || form[2] < '1' || form[2] > '9' || form[3] != 'd') {
        return std::nullopt;
      }
      width = form[2] - '0';
      name = name.substr(0, percent);
    }
    if (name == "RepresentationID") {
      out += id;
    } else if (name == "Number" || name == "Time") {
      char text[40];
      std::snprintf(text, sizeof text, "%0*lld", width,
                    (long long)(name == "Time" ? time : number));
      out += text;
    } else if (name.empty()) {
      out += '$';
    } else {
      return std::nullopt;
    }
  }
  return out;
}

}  // namespace animeme::media

#include "tools/formats/exchange/detail/table.h"

#include <algorithm>

namespace animeme::exchange {

namespace {

constexpr std::size_t kNamesInList = 6;

}  // namespace

std::optional<std::size_t> axis_of(char c) {
  const std::size_t axis = std::string_view("xXyYzZ").find(c);
  return axis == std::string_view::npos ? std::nullopt : std::optional(axis / 2);
}

bool is_short_number(std::string_view text) {
  return !text.empty() && text.size() <= 6 &&
         text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::string_view first_line(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text.substr(0, text.find_first_of("\r\n"));
}

char separator_of(std::string_view header) {
  char best = ',';
  for (const char c : {';', '\t'}) {
    if (std::count(header.begin(), header.end(), c) >
        std::count(header.begin(), header.end(), best)) {
      best = c;
    }
  }
  return best;
}

namespace {

// "Time (s)", "time_s" and "TimeS" are "times".
std::string letters_of(std::string_view name) {
  std::string out;
  for (const char c : lower_case(name)) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) out += c;
  }
  return out;
}

}  // namespace

bool is_time_name(std::string_view name) {
  constexpr std::string_view kTimeNames[] = {
      "timecode", "tc",          "time",        "timestamp",   "t",         "elapsed",
      "seconds",  "sec",         "secs",        "pts",         "datetime",  "elapsedtime",
      "ptstime",  "currenttime", "frametime",   "frametimein", "mediatime", "systemtime",
      "unixtime", "ms",          "milliseconds"};
  // Units behind it, as in "time_ms".
  constexpr std::string_view kTimeNameUnits[] = {
      "",   "s",    "sec",          "secs", "seconds", "ms",         "msec", "milliseconds",
      "us", "usec", "microseconds", "ns",   "nsec",    "nanoseconds"};
  const std::string letters = letters_of(name);
  for (const std::string_view known : kTimeNames) {
    if (!letters.starts_with(known)) continue;
    const std::string_view unit = std::string_view(letters).substr(known.size());
    if (unit.empty()) return true;
    // ("ts", "secs" and "pts" with units are no words.)
    if (known.size() >= 4 && std::find(std::begin(kTimeNameUnits), std::end(kTimeNameUnits),
                                       unit) != std::end(kTimeNameUnits)) {
      return true;
    }
  }
  return false;
}

bool is_frame_name(std::string_view name) {
  constexpr std::string_view kFrameNames[] = {"frame",    "framenumber", "frameindex",
                                              "frameid",  "frameno",     "framenum",
                                              "frameidx", "framecount",  "framenr"};
  const std::string letters = letters_of(name);
  return std::find(std::begin(kFrameNames), std::end(kFrameNames), letters) !=
         std::end(kFrameNames);
}

std::string list_of_names(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), kNamesInList); ++i) {
    out += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kNamesInList) {
    out += " and " + std::to_string(names.size() - kNamesInList) + " more";
  }
  return out;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Row::Row(const dam::TableLine& line, char separator)
    : line_(line), fields_(dam::split_fields(line.text, separator)) {}

Result<void> Row::check_size(std::size_t columns) const {
  if (size() == columns) return {};
  return error_at_line(Code::syntax,
                       std::to_string(size()) + " fields where the header has " +
                           std::to_string(columns) + "; complete or remove the line",
                       std::int64_t(line()));
}

Error Row::error(std::size_t field, const std::string& message) const {
  return error_at_line(Code::syntax, message, std::int64_t(line()),
                       std::int64_t(fields_[field].data() - line_.text.data()) + 1);
}

Error Row::wrong(std::size_t field, const std::string& name, const std::string& which_is) const {
  return error(field, name + " is '" + std::string(text(field)) + "', which is " + which_is);
}

Error Row::named_twice(std::size_t field) const {
  return error(
      field, "the column " + std::string(text(field)) + " is there twice; remove one or rename it");
}

}  // namespace animeme::exchange

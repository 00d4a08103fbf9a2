#include "tools/commands/curve_table.h"

#include <algorithm>

#include "fap/rate_text.h"

namespace animeme::tools {

namespace {

constexpr double kLargestFrame = 10'000'000;
constexpr std::size_t kNamesInList = 6;

}  // namespace

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return out;
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

bool is_time_name(std::string_view name) {
  return name == "timecode" || name == "time_s" || name == "time" || name == "timestamp";
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

Result<PlacedRows> place_rows(const std::vector<TimeField>& times,
                              const std::vector<std::size_t>& lines, std::optional<fap::Rate> rate,
                              std::vector<std::string>& warnings) {
  Result<Timing> timing = tell_timing(times, rate);
  if (!timing) return std::move(timing).error();
  for (std::string& warning : timing->warnings) warnings.push_back(std::move(warning));
  PlacedRows placed{timing->rate, {}};
  std::size_t merged = 0;
  std::int64_t number = -1;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double position = timing->positions[i];
    const auto at = std::int64_t(lines[i]);
    if (i > 0 && position < timing->positions[i - 1]) {
      return error_at_line(Code::out_of_range, "the time goes back; sort the rows by time", at);
    }
    if (position > kLargestFrame) {
      return error_at_line(Code::out_of_range,
                           "the time is more than 10 million frames after the first; correct it",
                           at);
    }
    const std::int64_t next = next_number(number, position);
    if (next == number) {
      placed.numbers.back().reset();
      ++merged;
    }
    number = next;
    placed.numbers.emplace_back(number);
  }
  if (merged > 0) {
    warnings.push_back(
        "rows on the same frame as the next one, left out: " + std::to_string(merged) + " (at " +
        fap::format_rate(placed.rate) + " frames a second)");
  }
  return placed;
}

}  // namespace animeme::tools

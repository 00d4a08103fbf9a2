// fap/ID.csv: time_s, one column a control, optional `measured`.
#include <algorithm>
#include <cmath>
#include <string>

#include "dam/corpus/corpus.h"
#include "dam/script/table_text_internal.h"

namespace animeme::dam {
namespace {

constexpr double kTimeError = 0.0015;  // seconds: files round to milliseconds or hundredths

bool fits(const std::vector<double>& times, fap::Rate rate, double tolerance) {
  for (std::size_t i = 0; i < times.size(); ++i)
    if (std::abs(times[i] - rate.seconds(double(i))) > tolerance) return false;
  return true;
}

/// The simplest rate that explains all times: whole, NTSC, halves, else thousandths.
fap::Rate find_rate(const std::vector<double>& times, double tolerance) {
  const double rate = double(times.size() - 1) / (times.back() - times.front());
  if (!(rate >= 0.5 && rate <= 10000)) return {0, 0};
  const auto whole = std::uint32_t(std::llround(rate));
  const fap::Rate candidates[] = {
      fap::make_rate(whole, 1),
      fap::make_rate(std::uint32_t(std::llround(rate * 1.001)) * 1000, 1001),
      fap::make_rate(std::uint32_t(std::llround(rate * 2)), 2),
      fap::make_rate(std::uint32_t(std::llround(rate * 1000)), 1000)};
  for (const fap::Rate& candidate : candidates)
    if (candidate.valid() && fits(times, candidate, tolerance)) return candidate;
  return {0, 0};
}

/// Half of the last decimal that the times are written with, as far as that is coarse.
double rounding_of(std::string_view field) {
  const std::size_t point = trimmed(field).find('.');
  const std::size_t decimals =
      point == std::string_view::npos ? 0 : trimmed(field).size() - point - 1;
  return std::min(0.0051, std::max(kTimeError, 0.51 * std::pow(10.0, -double(decimals))));
}

struct CurveColumns {
  std::size_t time = 0, count = 0;
  std::ptrdiff_t measured = -1;
  std::vector<std::size_t> controls;
};

Result<CurveColumns> read_header(const TableLine& line, Signal& signal) {
  const auto header = split_fields(line.text, ',');
  CurveColumns columns;
  columns.count = header.size();
  const auto time = find_column(header, "time_s");
  if (!time)
    return error_at_line(Code::not_found,
                         "the header has no column 'time_s'; add one with the "
                         "time of each frame in seconds",
                         std::int64_t(line.number));
  columns.time = *time;
  if (const auto m = find_column(header, "measured")) columns.measured = std::ptrdiff_t(*m);
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (i == columns.time || std::ptrdiff_t(i) == columns.measured) continue;
    const std::string name(trimmed(header[i]));
    if (name.empty() ||
        std::find(signal.names.begin(), signal.names.end(), name) != signal.names.end())
      return error_at_line(Code::syntax,
                           "column " + std::to_string(i + 1) +
                               " of the header has "
                               "no name of its own; name every column differently",
                           std::int64_t(line.number));
    signal.names.push_back(name);
    columns.controls.push_back(i);
  }
  if (signal.names.empty())
    return error_at_line(Code::not_found, "there is no control beside time_s",
                         std::int64_t(line.number));
  return columns;
}

}  // namespace

Result<Signal> read_curves(std::string_view text) {
  const auto lines = table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  Signal signal;
  const auto columns = read_header(lines[0], signal);
  if (!columns) return columns.error();
  std::vector<double> times;
  double tolerance = kTimeError;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto at = std::int64_t(lines[i].number);
    const auto fields = split_fields(lines[i].text, ',');
    if (fields.size() != columns->count)
      return error_at_line(Code::syntax,
                           std::to_string(fields.size()) +
                               " fields where the header "
                               "has " +
                               std::to_string(columns->count) + "; complete the line",
                           at);
    const auto time = parse_number(fields[columns->time]);
    if (!time || !std::isfinite(*time))
      return error_at_line(Code::syntax, "time_s is not a number", at);
    tolerance =
        std::max(tolerance, times.size() < 2 ? kTimeError : rounding_of(fields[columns->time]));
    if (!times.empty() && *time <= times.back())
      return error_at_line(Code::out_of_range, "time_s does not rise; sort the frames by time", at);
    times.push_back(*time);
    for (std::size_t c = 0; c < columns->controls.size(); ++c) {
      const auto value = parse_number(fields[columns->controls[c]]);
      if (!value || !std::isfinite(*value))
        return error_at_line(Code::syntax,
                             signal.names[c] +
                                 " is not a finite number; leave the "
                                 "frame in, interpolate it and set measured to 0",
                             at);
      signal.values.push_back(*value);
    }
    const auto m = columns->measured < 0
                       ? 1.0
                       : parse_number(fields[std::size_t(columns->measured)]).value_or(-1);
    if (m != 0 && m != 1) return error_at_line(Code::syntax, "measured must be 0 or 1", at);
    signal.measured.push_back(m == 1);
  }
  if (times.size() < 2)
    return make_error(Code::truncated, "a table needs two frames at least, to tell the frame rate");
  if (std::abs(times[0]) > tolerance)
    return error_at_line(Code::out_of_range, "the first frame is not at 0 s; shift the times",
                         std::int64_t(lines[1].number));
  signal.rate = find_rate(times, tolerance);
  if (!signal.rate.valid())
    return make_error(Code::out_of_range,
                      "the times are not regular; resample the curves to a constant frame rate");
  return signal;
}

}  // namespace animeme::dam

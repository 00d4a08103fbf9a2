// fap/ID.csv: time_s, one column per control, optional `measured`.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "dam/corpus/corpus.h"
#include "dam/script/table_text_internal.h"
#include "fap/detail/text_scanner.h"

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

/// A blank, not an invalid number; see read_curves().
bool is_blank(std::string_view field) {
  field = trimmed(field);
  if (field.empty() || field == "\"\"" || field.starts_with('#')) return true;
  const std::string word = fap::detail::lower_case(field);
  for (const std::string_view blank : {"na", "n/a", "null", "none", "-"})
    if (word == blank) return true;
  const auto number = parse_number(word);
  return number && !std::isfinite(*number);
}

bool is_empty(const std::vector<std::string_view>& fields, std::size_t from) {
  return std::all_of(fields.begin() + std::ptrdiff_t(std::min(from, fields.size())), fields.end(),
                     [](std::string_view field) { return trimmed(field).empty(); });
}

Result<CurveColumns> read_header(const TableLine& line, Signal& signal) {
  auto header = split_fields(line.text, ',');
  while (!header.empty() && trimmed(header.back()).empty()) header.pop_back();
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
                               "no unique name; name every column differently",
                           std::int64_t(line.number));
    signal.names.push_back(name);
    columns.controls.push_back(i);
  }
  if (signal.names.empty())
    return error_at_line(Code::not_found, "there is no control besides time_s",
                         std::int64_t(line.number));
  return columns;
}

/// Reads rows; what they lack is NaN and counted.
class CurveReader {
 public:
  CurveReader(CurveColumns columns, Signal& signal, std::vector<BlankNote>* blanks)
      : columns_(std::move(columns)), signal_(signal), blanks_(blanks) {
    for (const std::string& name : signal.names) notes_.push_back({"", name, 0, 0, 0});
  }

  /// `cut`: the text ends in this line.
  Result<void> add(const TableLine& line, bool cut) {
    const auto at = std::int64_t(line.number);
    auto fields = split_fields(line.text, ',');
    if (is_empty(fields, 0)) return {};
    if (fields.size() > columns_.count && is_empty(fields, columns_.count))
      fields.resize(columns_.count);
    const bool lacks = fields.size() < columns_.count;
    if (fields.size() > columns_.count || (lacks && blanks_ == nullptr))
      return error_at_line(Code::syntax,
                           std::to_string(fields.size()) +
                               " fields where the header "
                               "has " +
                               std::to_string(columns_.count) + "; complete the line",
                           at);
    if (lacks && cut) return {};  // nobody knows whether its last number is whole
    fields.resize(columns_.count);
    if (auto ok = add_time(fields[columns_.time], at); !ok) return ok;
    for (std::size_t c = 0; c < columns_.controls.size(); ++c)
      if (auto ok = add_value(fields[columns_.controls[c]], c, at); !ok) return ok;
    return add_measured(fields, at);
  }

  const std::vector<double>& times() const { return times_; }
  double tolerance() const { return tolerance_; }

  void finish() {
    for (BlankNote& note : notes_) {
      note.of = times_.size();
      if (note.rows > 0 && blanks_ != nullptr) blanks_->push_back(note);
    }
  }

 private:
  Result<void> add_time(std::string_view field, std::int64_t at) {
    const auto time = parse_number(field);
    if (!time || !std::isfinite(*time))
      return error_at_line(Code::syntax, "time_s is not a number", at);
    tolerance_ = std::max(tolerance_, times_.size() < 2 ? kTimeError : rounding_of(field));
    if (!times_.empty() && *time <= times_.back())
      return error_at_line(Code::out_of_range, "time_s does not ascend; sort the frames by time",
                           at);
    times_.push_back(*time);
    return {};
  }

  Result<void> add_value(std::string_view field, std::size_t control, std::int64_t at) {
    const auto value = parse_number(field);
    if (value && std::isfinite(*value)) {
      signal_.values.push_back(*value);
      return {};
    }
    if (blanks_ == nullptr || !is_blank(field))
      return error_at_line(Code::syntax,
                           signal_.names[control] +
                               " is not a finite number; leave the "
                               "frame in, interpolate it and set measured to 0",
                           at);
    signal_.values.push_back(std::numeric_limits<double>::quiet_NaN());
    BlankNote& note = notes_[control];
    if (note.rows++ == 0) note.first_line = std::size_t(at);
    return {};
  }

  Result<void> add_measured(const std::vector<std::string_view>& fields, std::int64_t at) {
    double m = 1;
    if (columns_.measured >= 0) {
      const std::string_view field = fields[std::size_t(columns_.measured)];
      m = parse_number(field).value_or(-1);
      if (blanks_ != nullptr && is_blank(field)) m = 0;
    }
    if (m != 0 && m != 1) return error_at_line(Code::syntax, "measured must be 0 or 1", at);
    signal_.measured.push_back(m == 1);
    return {};
  }

  CurveColumns columns_;
  Signal& signal_;
  std::vector<BlankNote>* blanks_;
  std::vector<BlankNote> notes_;
  std::vector<double> times_;
  double tolerance_ = kTimeError;
};

}  // namespace

Result<Signal> read_curves(std::string_view text, std::vector<BlankNote>* blanks) {
  const auto lines = table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  Signal signal;
  const auto columns = read_header(lines[0], signal);
  if (!columns) return columns.error();
  CurveReader reader(*columns, signal, blanks);
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (auto ok = reader.add(lines[i], i + 1 == lines.size() && !text.ends_with('\n')); !ok)
      return ok.error();
  const std::vector<double>& times = reader.times();
  if (times.size() < 2)
    return make_error(Code::truncated,
                      "a table needs at least two frames to define the frame rate");
  if (std::abs(times[0]) > reader.tolerance())
    return error_at_line(Code::out_of_range, "the first frame is not at 0 s; shift the times",
                         std::int64_t(lines[1].number));
  signal.rate = find_rate(times, reader.tolerance());
  if (!signal.rate.valid())
    return make_error(Code::out_of_range,
                      "the times are not regular; resample the curves to a constant frame rate");
  reader.finish();
  return signal;
}

void leave_out_blanks(Signal& signal) {
  const std::size_t k = signal.names.size(), frames = signal.frames();
  for (std::size_t c = 0; c < k; ++c) {
    std::ptrdiff_t last = -1;  // the last frame that has a value
    for (std::size_t i = 0; i < frames; ++i) {
      if (!std::isfinite(signal.at(i, c))) {
        signal.measured.resize(frames, true);
        signal.measured[i] = false;
        continue;
      }
      const double after = signal.at(i, c),
                   before = last < 0 ? after : signal.at(std::size_t(last), c);
      for (std::size_t j = std::size_t(last + 1); j < i; ++j)
        signal.at(j, c) = before + (after - before) * double(std::ptrdiff_t(j) - last) /
                                       double(std::ptrdiff_t(i) - last);
      last = std::ptrdiff_t(i);
    }
    for (std::size_t j = std::size_t(last + 1); j < frames; ++j)
      signal.at(j, c) = last < 0 ? 0.0 : signal.at(std::size_t(last), c);
  }
}

}  // namespace animeme::dam

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/detail/arkit_units.h"
#include "tools/formats/exchange/detail/plain_table.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/detail/times.h"

namespace animeme::exchange {

namespace {

struct Columns {
  std::optional<std::size_t> time;
  std::optional<std::size_t> frame;                   // without a time: numbers
  std::optional<std::size_t> shape_count;             // BlendShapeCount
  std::vector<std::pair<std::size_t, int>> channels;  // field, channel
  std::vector<std::string> names;                     // of all fields
};

struct ArkitRows {
  std::vector<RowTime> times;
  std::vector<fap::ArkitFrame> values;  // of the same rows
};

Result<Columns> read_header(const Row& header, bool has_rate, std::vector<std::string>& warnings) {
  const auto at = std::int64_t(header.line());
  Columns columns;
  fap::ArkitChannels seen;
  std::vector<std::string> unknown;
  for (std::size_t i = 0; i < header.size(); ++i) {
    columns.names.emplace_back(header.text(i));
    const std::string name = lower_case(columns.names[i]);
    if (is_time_name(name)) {
      if (!columns.time) columns.time = i;
    } else if (is_frame_name(name)) {
      if (!columns.frame) columns.frame = i;
    } else if (name == "blendshapecount") {
      columns.shape_count = i;
    } else if (const auto channel = fap::find_arkit(name)) {
      if (!seen[std::size_t(*channel)]) {
        seen.set(std::size_t(*channel));
        columns.channels.emplace_back(i, *channel);
      } else if (std::any_of(columns.names.begin(), columns.names.end() - 1,
                             [&](const std::string& one) { return lower_case(one) == name; })) {
        return header.named_twice(i);
      } else {
        unknown.push_back(columns.names[i]);  // the same shape of another mesh
      }
    } else if (name != "measured" && name != "row" && !name.empty()) {
      unknown.push_back(columns.names[i]);
    }
  }
  if (columns.channels.empty()) {
    return error_at_line(Code::not_found,
                         "no column is an ARKit blend shape (jawOpen, EyeBlinkLeft ...), and there "
                         "are not all points of a set of landmarks (x_0, y_0 ... x_67, y_67; see "
                         "import --help); name the columns so in the first line",
                         at);
  }
  if (!columns.time && !has_rate) {
    return error_at_line(Code::not_found,
                         "no column has the times; name it Timecode (hh:mm:ss:ff.fff) or time_s "
                         "(seconds), or give the frames per second (--rate 60)",
                         at);
  }
  if (!unknown.empty()) {
    warnings.push_back("columns that are not ARKit blend shapes are ignored: " +
                       list_of_names(unknown));
  }
  return columns;
}

// A row without a face has a count of 0 and often nothing behind it, or no numbers.
bool without_face(const Columns& columns, const Row& row) {
  if (columns.shape_count && *columns.shape_count < row.size() &&
      row.number(*columns.shape_count) == 0.0) {
    return true;
  }
  return row.size() == columns.names.size() &&
         std::all_of(columns.channels.begin(), columns.channels.end(),
                     [&](const auto& channel) { return is_missing(row.text(channel.first)); });
}

// "0.12" or "12%".
std::optional<double> weight_of(std::string_view text) {
  if (!text.ends_with('%')) return dam::parse_number(text);
  text.remove_suffix(1);
  const auto percent = dam::parse_number(text);
  return percent ? std::optional(*percent / 100) : std::nullopt;
}

Result<RowTime> read_time(const Row& row, const Columns& columns, std::size_t rows,
                          std::optional<fap::Rate> rate) {
  if (columns.time) {
    const std::string_view at = row.text(*columns.time);
    if (const auto time = parse_time(at, row.line())) return *time;
    return row.error(*columns.time,
                     "'" + std::string(at) + "' is not a time; write hh:mm:ss:ff.fff or seconds");
  }
  double number = double(rows);
  if (columns.frame) {
    const auto value = row.number(*columns.frame);
    if (!value || !std::isfinite(*value)) {
      return row.wrong(*columns.frame, columns.names[*columns.frame], "not the number of a frame");
    }
    number = *value;
  }
  RowTime time;
  time.seconds = number / rate->frames_per_second();
  time.line = row.line();
  return time;
}

Result<void> read_row(const Row& row, const Columns& columns, std::optional<fap::Rate> rate,
                      ArkitRows& rows) {
  if (auto ok = row.check_size(columns.names.size()); !ok) return ok.error();
  Result<RowTime> time = read_time(row, columns, rows.times.size(), rate);
  if (!time) return std::move(time).error();
  fap::ArkitFrame values{};
  for (const auto& [field, channel] : columns.channels) {
    if (is_missing(row.text(field))) {
      values[std::size_t(channel)] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const auto value = weight_of(row.text(field));
    if (!value || !std::isfinite(*value)) {
      return row.wrong(field, columns.names[field],
                       "not a finite number; correct it or remove the line");
    }
    values[std::size_t(channel)] = *value;
  }
  rows.times.push_back(*time);
  rows.values.push_back(values);
  return {};
}

// Numbers that are missing in a column lie on the line between those before and behind; at its ends
// the next one is held. The number of them.
std::size_t interpolate(std::vector<fap::ArkitFrame>& rows, std::size_t channel) {
  const auto known = [&](std::size_t row) { return !std::isnan(rows[row][channel]); };
  std::size_t filled = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (known(row)) continue;
    std::size_t next = row;
    while (next < rows.size() && !known(next)) ++next;
    const double before = row > 0 ? rows[row - 1][channel] : rows[next][channel];
    const double behind = next < rows.size() ? rows[next][channel] : before;
    const double steps = double(next - row + 1);
    filled += next - row;
    for (std::size_t i = row; i < next; ++i) {
      rows[i][channel] = before + (behind - before) * double(i - row + 1) / steps;
    }
    row = next;
  }
  return filled;
}

// Columns without any number are left out.
void fill_missing(Columns& columns, std::vector<fap::ArkitFrame>& rows,
                  std::vector<std::string>& warnings) {
  std::vector<std::string> empty;
  std::size_t filled = 0;
  std::erase_if(columns.channels, [&](const auto& column) {
    const std::size_t channel = std::size_t(column.second);
    const bool none = std::all_of(rows.begin(), rows.end(), [&](const fap::ArkitFrame& row) {
      return std::isnan(row[channel]);
    });
    if (!none) {
      filled += interpolate(rows, channel);
      return false;
    }
    empty.push_back(columns.names[column.first]);
    for (fap::ArkitFrame& row : rows) row[channel] = 0;
    return true;
  });
  if (!empty.empty()) {
    warnings.push_back("columns without a number are ignored: " + list_of_names(empty));
  }
  if (filled > 0) {
    warnings.push_back("fields without a number, interpolated: " + std::to_string(filled));
  }
}

Result<ArkitRows> read_rows(const std::vector<dam::TableLine>& lines, char separator, bool cut,
                            Columns& columns, std::optional<fap::Rate> rate,
                            std::vector<std::string>& warnings) {
  ArkitRows rows;
  std::size_t lost = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Row fields(lines[i], separator);
    if (cut && i > 1 && i + 1 == lines.size() && fields.size() < columns.names.size()) {
      warnings.emplace_back("the last row is cut off and was left out");
      continue;
    }
    if (without_face(columns, fields)) {
      ++lost;
      continue;
    }
    if (auto read = read_row(fields, columns, rate, rows); !read) return read.error();
  }
  if (rows.times.empty()) {
    return make_error(Code::truncated, "there is no row with a face after the header line");
  }
  if (lost > 0) {
    warnings.push_back("rows without a face, skipped: " + std::to_string(lost));
  }
  fill_missing(columns, rows.values, warnings);
  return rows;
}

// The channels of the table but angles that were not recorded. A table that has a shape of one side
// says that the other side rests.
fap::ArkitChannels channels_of(const Columns& columns, const std::vector<fap::ArkitFrame>& values) {
  fap::ArkitChannels channels;
  for (const auto& [field, number] : columns.channels) {
    const std::size_t channel = std::size_t(number);
    const bool moves = std::any_of(values.begin(), values.end(),
                                   [&](const fap::ArkitFrame& row) { return row[channel] != 0; });
    channels[channel] = channel < fap::kArkitShapeCount || moves;
    if (channel >= fap::kArkitShapeCount) continue;
    if (const auto other = fap::arkit_other_side(number)) channels.set(std::size_t(*other));
  }
  return channels;
}

// The rows of a table, each with the number of its frame, if it has one.
struct TableRows {
  fap::Rate rate;
  std::vector<fap::ArkitFrame> values;
  std::vector<std::optional<std::int64_t>> numbers;
  fap::ArkitChannels channels;
};

// Frames between rows that come a little more slowly than frames do: the mean of both.
void insert_frames(const std::vector<std::size_t>& late, TableRows& table) {
  for (auto row = late.rbegin(); row != late.rend(); ++row) {
    const auto at = std::ptrdiff_t(*row);
    fap::ArkitFrame mean = table.values[*row];
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] = (mean[i] + table.values[*row - 1][i]) / 2;
    const std::int64_t number = table.numbers[*row].value_or(1) - 1;
    table.values.insert(table.values.begin() + at, mean);
    table.numbers.insert(table.numbers.begin() + at, number);
  }
}

Result<TableRows> read_placed(std::string_view text, const ArkitOptions& options,
                              std::vector<std::string>& warnings) {
  const auto lines = dam::table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  const char separator = separator_of(lines[0].text);
  const std::optional<fap::Rate> rate =
      options.rate && options.rate->valid() ? options.rate : std::nullopt;
  auto columns = read_header(Row(lines[0], separator), rate.has_value(), warnings);
  if (!columns) return columns.error();
  // A recording that was stopped ends within a row.
  const bool cut = !text.ends_with('\n');
  auto rows = read_rows(lines, separator, cut, *columns, rate, warnings);
  if (!rows) return rows.error();
  auto placed = place_rows(rows->times, options.rate, warnings);
  if (!placed) return placed.error();
  to_usual_units(rows->values, options.degrees, warnings);
  const fap::ArkitChannels channels = channels_of(*columns, rows->values);
  TableRows table{placed->rate, std::move(rows->values), std::move(placed->numbers), channels};
  insert_frames(placed->late, table);
  return table;
}

}  // namespace

bool is_arkit_table(std::string_view text) {
  const std::string_view header = first_line(text);
  const Row names({1, header}, separator_of(header));
  int channels = 0;
  for (std::size_t i = 0; i < names.size(); ++i) channels += fap::find_arkit(names.text(i)) ? 1 : 0;
  return channels >= 2;
}

Result<Imported> read_arkit_table(std::string_view text, const ArkitOptions& options) {
  Imported out;
  const auto rows = read_placed(text, options, out.warnings);
  if (!rows) return rows.error();
  out.clip.rate = rows->rate;
  for (std::size_t i = 0; i < rows->values.size(); ++i) {
    if (!rows->numbers[i]) continue;
    out.clip.frames.push_back(fap::arkit_to_fap(rows->values[i], rows->channels));
    out.clip.frames.back().number = *rows->numbers[i];
  }
  return out;
}

Result<ArkitCurves> read_arkit_weights(std::string_view text, const ArkitOptions& options) {
  std::vector<std::string> warnings;
  const auto rows = read_placed(text, options, warnings);
  if (!rows) return rows.error();
  ArkitCurves out{rows->rate, {}};
  for (std::size_t i = 0; i < rows->values.size(); ++i) {
    if (!rows->numbers[i]) continue;
    // By value: the row before may be moved meanwhile.
    const fap::ArkitFrame held = out.frames.empty() ? rows->values[i] : out.frames.back();
    out.frames.resize(std::size_t(*rows->numbers[i]) + 1, held);
    out.frames.back() = rows->values[i];
  }
  return out;
}

}  // namespace animeme::exchange

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/detail/times.h"

namespace animeme::exchange {

namespace {

struct Columns {
  std::size_t time = 0;
  std::optional<std::size_t> shape_count;             // BlendShapeCount
  std::vector<std::pair<std::size_t, int>> channels;  // field, channel
  std::vector<std::string> names;                     // of all fields
};

struct ArkitRow {
  RowTime time;
  fap::ArkitFrame values;
};

Result<Columns> read_header(const Row& header, std::vector<std::string>& warnings) {
  const auto at = std::int64_t(header.line());
  Columns columns;
  std::optional<std::size_t> time;
  fap::ArkitChannels seen;
  std::vector<std::string> unknown;
  for (std::size_t i = 0; i < header.size(); ++i) {
    columns.names.emplace_back(header.text(i));
    const std::string name = lower_case(columns.names[i]);
    if (is_time_name(name)) {
      if (!time) time = i;
    } else if (name == "blendshapecount") {
      columns.shape_count = i;
    } else if (const auto channel = fap::find_arkit(name)) {
      if (seen[std::size_t(*channel)]) return header.named_twice(i);
      seen.set(std::size_t(*channel));
      columns.channels.emplace_back(i, *channel);
    } else if (name != "measured" && !name.empty()) {
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
  if (!time) {
    return error_at_line(Code::not_found,
                         "no column has the times; name it Timecode (hh:mm:ss:ff.fff) or time_s "
                         "(seconds)",
                         at);
  }
  if (!unknown.empty()) {
    warnings.push_back("columns that are not ARKit blend shapes are ignored: " +
                       list_of_names(unknown));
  }
  columns.time = *time;
  return columns;
}

// A row without a face has a count of 0 and often nothing behind it.
bool without_face(const Columns& columns, const Row& row) {
  return columns.shape_count && *columns.shape_count < row.size() &&
         row.number(*columns.shape_count) == 0.0;
}

Result<ArkitRow> read_row(const Row& row, const Columns& columns) {
  if (auto ok = row.check_size(columns.names.size()); !ok) return ok.error();
  const std::string_view at = row.text(columns.time);
  const auto time = parse_time(at, row.line());
  if (!time) {
    return row.error(columns.time,
                     "'" + std::string(at) + "' is not a time; write hh:mm:ss:ff.fff or seconds");
  }
  ArkitRow out{*time, {}};
  for (const auto& [field, channel] : columns.channels) {
    const auto value = row.number(field);
    if (!value || !std::isfinite(*value)) {
      return row.wrong(field, columns.names[field],
                       "not a finite number; correct it or remove the line");
    }
    out.values[std::size_t(channel)] = *value;
  }
  return out;
}

Result<std::vector<ArkitRow>> read_rows(const std::vector<dam::TableLine>& lines, char separator,
                                        const Columns& columns,
                                        std::vector<std::string>& warnings) {
  std::vector<ArkitRow> rows;
  std::size_t lost = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Row fields(lines[i], separator);
    if (without_face(columns, fields)) {
      ++lost;
      continue;
    }
    Result<ArkitRow> row = read_row(fields, columns);
    if (!row) return std::move(row).error();
    rows.push_back(std::move(*row));
  }
  if (rows.empty()) {
    return make_error(Code::truncated, "there is no row with a face after the header line");
  }
  if (lost > 0) {
    warnings.push_back("rows without a face, skipped: " + std::to_string(lost));
  }
  return rows;
}

// The channels of the table but angles that were not recorded.
fap::ArkitChannels channels_of(const Columns& columns, const std::vector<ArkitRow>& rows) {
  fap::ArkitChannels channels;
  for (const auto& [field, number] : columns.channels) {
    const std::size_t channel = std::size_t(number);
    const bool moves = std::any_of(rows.begin(), rows.end(),
                                   [&](const ArkitRow& row) { return row.values[channel] != 0; });
    channels[channel] = channel < fap::kArkitShapeCount || moves;
  }
  return channels;
}

void to_radians(std::vector<ArkitRow>& rows, bool degrees, std::vector<std::string>& warnings) {
  double largest = 0;
  for (ArkitRow& row : rows) {
    for (std::size_t i = fap::kArkitShapeCount; i < fap::kArkitChannelCount; ++i) {
      largest = std::max(largest, std::abs(row.values[i]));
      if (degrees) row.values[i] *= std::numbers::pi / 180;
    }
  }
  if (!degrees && largest > std::numbers::pi) {
    warnings.push_back(
        "angles of head and eyes exceed half a turn; if they are in degrees, use --degrees");
  }
}

// The rows of a table, each with the number of its frame, if it has one.
struct TableRows {
  fap::Rate rate;
  std::vector<ArkitRow> rows;
  std::vector<std::optional<std::int64_t>> numbers;
  fap::ArkitChannels channels;
};

Result<TableRows> read_placed(std::string_view text, const ArkitOptions& options,
                              std::vector<std::string>& warnings) {
  const auto lines = dam::table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  const char separator = separator_of(lines[0].text);
  const auto columns = read_header(Row(lines[0], separator), warnings);
  if (!columns) return columns.error();
  auto rows = read_rows(lines, separator, *columns, warnings);
  if (!rows) return rows.error();
  std::vector<RowTime> times;
  for (const ArkitRow& row : *rows) times.push_back(row.time);
  auto placed = place_rows(times, options.rate, warnings);
  if (!placed) return placed.error();
  to_radians(*rows, options.degrees, warnings);
  const fap::ArkitChannels channels = channels_of(*columns, *rows);
  return TableRows{placed->rate, std::move(*rows), std::move(placed->numbers), channels};
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
  for (std::size_t i = 0; i < rows->rows.size(); ++i) {
    if (!rows->numbers[i]) continue;
    out.clip.frames.push_back(fap::arkit_to_fap(rows->rows[i].values, rows->channels));
    out.clip.frames.back().number = *rows->numbers[i];
  }
  return out;
}

Result<ArkitCurves> read_arkit_weights(std::string_view text, const ArkitOptions& options) {
  std::vector<std::string> warnings;
  const auto rows = read_placed(text, options, warnings);
  if (!rows) return rows.error();
  ArkitCurves out{rows->rate, {}};
  for (std::size_t i = 0; i < rows->rows.size(); ++i) {
    if (!rows->numbers[i]) continue;
    // By value: the row before may be moved meanwhile.
    const fap::ArkitFrame held = out.frames.empty() ? rows->rows[i].values : out.frames.back();
    out.frames.resize(std::size_t(*rows->numbers[i]) + 1, held);
    out.frames.back() = rows->rows[i].values;
  }
  return out;
}

}  // namespace animeme::exchange

#include "tools/commands/arkit_csv.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dam/script/table_text_internal.h"
#include "fap/arkit.h"
#include "tools/commands/curve_table.h"

namespace animeme::tools {

namespace {

struct Columns {
  char separator = ',';
  std::size_t count = 0;
  std::size_t time = 0;
  std::optional<std::size_t> shape_count;             // BlendShapeCount
  std::vector<std::pair<std::size_t, int>> channels;  // field, channel
  std::vector<std::string> names;                     // of all fields
};

struct Row {
  std::size_t line;
  TimeField time;
  fap::ArkitFrame values;
};

Result<Columns> read_header(const dam::TableLine& line, std::vector<std::string>& warnings) {
  const auto at = std::int64_t(line.number);
  Columns columns;
  columns.separator = separator_of(line.text);
  std::optional<std::size_t> time;
  fap::ArkitChannels seen;
  std::vector<std::string> unknown;
  const auto fields = dam::split_fields(line.text, columns.separator);
  columns.count = fields.size();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    columns.names.emplace_back(dam::trimmed(fields[i]));
    const std::string name = lower_case(columns.names[i]);
    if (is_time_name(name)) {
      if (!time) time = i;
    } else if (name == "blendshapecount") {
      columns.shape_count = i;
    } else if (const auto channel = fap::find_arkit(name)) {
      if (seen[std::size_t(*channel)]) {
        return error_at_line(Code::syntax,
                             "the column " + columns.names[i] +
                                 " is there twice; remove one or give it another name",
                             at, std::int64_t(fields[i].data() - line.text.data()) + 1);
      }
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
    warnings.push_back("columns that are no ARKit blend shape are left out: " +
                       list_of_names(unknown));
  }
  columns.time = *time;
  return columns;
}

// A row without a face has a count of 0 and often nothing behind it.
bool without_face(const Columns& columns, const std::vector<std::string_view>& fields) {
  return columns.shape_count && *columns.shape_count < fields.size() &&
         dam::parse_number(fields[*columns.shape_count]) == 0.0;
}

Result<Row> read_row(const dam::TableLine& line, const Columns& columns,
                     const std::vector<std::string_view>& fields) {
  const auto at = std::int64_t(line.number);
  const auto column_of = [&](std::size_t field) {
    return std::int64_t(fields[field].data() - line.text.data()) + 1;
  };
  if (fields.size() != columns.count) {
    return error_at_line(Code::syntax,
                         std::to_string(fields.size()) + " fields where the header has " +
                             std::to_string(columns.count) + "; complete or remove the line",
                         at);
  }
  Row row{line.number, {}, {}};
  const auto time = parse_time(dam::trimmed(fields[columns.time]));
  if (!time) {
    return error_at_line(Code::syntax,
                         "'" + std::string(dam::trimmed(fields[columns.time])) +
                             "' is no time; write hh:mm:ss:ff.fff or seconds",
                         at, column_of(columns.time));
  }
  row.time = *time;
  for (const auto& [field, channel] : columns.channels) {
    const auto value = dam::parse_number(fields[field]);
    if (!value || !std::isfinite(*value)) {
      return error_at_line(Code::syntax,
                           columns.names[field] + " is '" +
                               std::string(dam::trimmed(fields[field])) +
                               "', which is not a finite number; correct it or remove the line",
                           at, column_of(field));
    }
    row.values[std::size_t(channel)] = *value;
  }
  return row;
}

Result<std::vector<Row>> read_rows(const std::vector<dam::TableLine>& lines, const Columns& columns,
                                   std::vector<std::string>& warnings) {
  std::vector<Row> rows;
  std::size_t lost = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = dam::split_fields(lines[i].text, columns.separator);
    if (without_face(columns, fields)) {
      ++lost;
      continue;
    }
    Result<Row> row = read_row(lines[i], columns, fields);
    if (!row) return std::move(row).error();
    rows.push_back(std::move(*row));
  }
  if (rows.empty()) {
    return make_error(Code::truncated, "there is no row with a face behind the header line");
  }
  if (lost > 0) {
    warnings.push_back("rows without a face, left out: " + std::to_string(lost));
  }
  return rows;
}

// The channels of the table but angles that were not recorded.
fap::ArkitChannels channels_of(const Columns& columns, const std::vector<Row>& rows) {
  fap::ArkitChannels channels;
  for (const auto& [field, number] : columns.channels) {
    const std::size_t channel = std::size_t(number);
    const bool moves = std::any_of(rows.begin(), rows.end(),
                                   [&](const Row& row) { return row.values[channel] != 0; });
    channels[channel] = channel < fap::kArkitShapeCount || moves;
  }
  return channels;
}

void to_radians(std::vector<Row>& rows, bool degrees, std::vector<std::string>& warnings) {
  double largest = 0;
  for (Row& row : rows) {
    for (std::size_t i = fap::kArkitShapeCount; i < fap::kArkitChannelCount; ++i) {
      largest = std::max(largest, std::abs(row.values[i]));
      if (degrees) row.values[i] *= std::numbers::pi / 180;
    }
  }
  if (!degrees && largest > std::numbers::pi) {
    warnings.push_back(
        "angles of head and eyes go beyond half a turn; if they are degrees, say so");
  }
}

std::vector<TimeField> times_of(const std::vector<Row>& rows) {
  std::vector<TimeField> times;
  for (const Row& row : rows) times.push_back(row.time);
  return times;
}

std::vector<std::size_t> lines_of(const std::vector<Row>& rows) {
  std::vector<std::size_t> lines;
  for (const Row& row : rows) lines.push_back(row.line);
  return lines;
}

}  // namespace

bool is_arkit_csv(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::string_view header = text.substr(0, std::min(text.find_first_of("\r\n"), text.size()));
  int channels = 0;
  for (const std::string_view field : dam::split_fields(header, separator_of(header))) {
    channels += fap::find_arkit(dam::trimmed(field)) ? 1 : 0;
  }
  return channels >= 2;
}

Result<fap::Sequence> read_arkit_csv(std::string_view text, const ArkitCsvOptions& options,
                                     std::vector<std::string>& warnings) {
  const auto lines = dam::table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  const Result<Columns> columns = read_header(lines[0], warnings);
  if (!columns) return columns.error();
  Result<std::vector<Row>> rows = read_rows(lines, *columns, warnings);
  if (!rows) return rows.error();
  const Result<PlacedRows> placed =
      place_rows(times_of(*rows), lines_of(*rows), options.rate, warnings);
  if (!placed) return placed.error();
  to_radians(*rows, options.degrees, warnings);

  const fap::ArkitChannels channels = channels_of(*columns, *rows);
  fap::Sequence clip{placed->rate, {}, {}};
  for (std::size_t i = 0; i < rows->size(); ++i) {
    if (!placed->numbers[i]) continue;
    clip.frames.push_back(fap::arkit_to_fap((*rows)[i].values, channels));
    clip.frames.back().number = *placed->numbers[i];
  }
  return clip;
}

}  // namespace animeme::tools

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/detail/times.h"
#include "tools/formats/exchange/points.h"

namespace animeme::exchange {
namespace {

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

struct PointColumn {
  std::string point;
  std::size_t axis = 0;
  bool space = false;  // X61, not x61
};

bool is_point_break(char c) { return c == '_' || c == '-' || c == ' ' || c == '.' || c == ':'; }

// "landmark_12" and the like are 12; other names stay as they are.
std::string point_name(std::string_view name) {
  for (const std::string_view prefix : {"landmark", "lmk", "lm", "point", "pt", "p"}) {
    if (!lower_case(name).starts_with(prefix)) continue;
    std::string_view rest = name.substr(prefix.size());
    while (!rest.empty() && is_point_break(rest[0])) rest.remove_prefix(1);
    if (is_short_number(rest)) return std::string(rest);
  }
  return std::string(name);
}

std::optional<PointColumn> parse_column(std::string_view name) {
  if (name.size() < 2) return std::nullopt;
  if (const auto axis = axis_of(name[0])) {
    std::string_view rest = name.substr(1);
    if (is_point_break(rest[0])) rest.remove_prefix(1);
    if (is_short_number(rest)) return PointColumn{std::string(rest), *axis, name[0] < 'a'};
  }
  const auto axis = axis_of(name.back());
  if (!axis || name.size() < 3 || !is_point_break(name[name.size() - 2])) return std::nullopt;
  const std::string_view point = dam::trimmed(name.substr(0, name.size() - 2));
  if (point.empty() || lower_case(point).starts_with("gaze_")) return std::nullopt;
  return PointColumn{point_name(point), *axis, false};
}

using PointColumns = std::array<std::optional<std::size_t>, 3>;

// The points of a header, in the order of their first columns.
struct PointHeader {
  std::vector<std::string> names;  // of all columns
  std::vector<std::string> points;
  std::vector<PointColumns> fields;
  std::optional<std::size_t> time, success;
  std::size_t dimensions = 2;
};

struct FoundColumns {
  std::vector<std::string> order;
  std::map<std::string, PointColumns> fields;

  bool add(const std::string& point, std::size_t axis, std::size_t column) {
    const auto [at, made] = fields.try_emplace(point);
    if (made) order.push_back(point);
    if (at->second[axis]) return false;
    at->second[axis] = column;
    return true;
  }
  bool has_depth() const {
    return !fields.empty() && std::all_of(fields.begin(), fields.end(), [](const auto& one) {
      return one.second[0] && one.second[1] && one.second[2];
    });
  }
};

Result<PointHeader> read_point_header(const Row& row, std::vector<std::string>& warnings) {
  PointHeader header;
  FoundColumns picture, space;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string_view name = row.text(i);
    header.names.emplace_back(name);
    const std::string word = lower_case(name);
    if (is_time_name(word) || word == "success") {
      auto& place = word == "success" ? header.success : header.time;
      if (place && lower_case(header.names[*place]) == word) return row.named_twice(i);
      if (!place) place = i;
    } else if (const auto column = parse_column(name)) {
      if (!(column->space ? space : picture).add(column->point, column->axis, i)) {
        return row.named_twice(i);
      }
    }
  }
  const FoundColumns& found = picture.order.empty() || space.has_depth() ? space : picture;
  const auto line = std::int64_t(row.line());
  if (found.order.empty()) {
    return error_at_line(Code::not_found,
                         "no column is a coordinate of a point: names like UL_x, UL_y, UL_z or "
                         "x61, y61 are needed in the first line",
                         line);
  }
  header.dimensions = found.has_depth() ? 3 : 2;
  bool depth = false;
  for (const std::string& point : found.order) {
    const PointColumns& fields = found.fields.at(point);
    if (!fields[0] || !fields[1]) {
      return error_at_line(Code::not_found,
                           "the point " + point + " has no column for its " +
                               (fields[0] ? "y" : "x") + "; add it or remove the point",
                           line);
    }
    depth = depth || fields[2];
    header.points.push_back(point);
    header.fields.push_back(fields);
  }
  if (depth && header.dimensions == 2) {
    warnings.emplace_back("not all points have a z, so z is ignored");
  }
  return header;
}

struct PointRows {
  PointHeader header;
  std::vector<RowTime> times;
  std::vector<double> values;  // rows x points x dimensions
};

Result<void> read_point_row(const Row& row, const PointTableOptions& options, PointRows& table) {
  const PointHeader& header = table.header;
  if (auto ok = row.check_size(header.names.size()); !ok) return ok;
  if (header.time) {
    const auto time = parse_time(row.text(*header.time), row.line());
    if (!time) return row.wrong(*header.time, header.names[*header.time], "no time");
    table.times.push_back(*time);
  } else {
    table.times.push_back(
        {options.rate->seconds(double(table.times.size())), std::nullopt, row.line()});
  }
  const bool lost = header.success && row.number(*header.success) == 0.0;
  for (const PointColumns& fields : header.fields) {
    double place[3] = {};
    for (std::size_t k = 0; k < header.dimensions; ++k) {
      const std::size_t field = *fields[k];
      const auto value = row.number(field);
      if (!value && !row.text(field).empty()) {
        return row.wrong(field, header.names[field], "not a number; correct it or leave it empty");
      }
      place[k] = value && std::isfinite(*value) && !lost ? *value : kUnseen;
    }
    if (options.size) {
      place[0] *= options.size->width;
      place[1] *= options.size->height;
      place[2] *= options.size->width;
    }
    const bool seen = std::isfinite(place[0] + place[1] + place[2]);
    for (std::size_t k = 0; k < header.dimensions; ++k) {
      table.values.push_back(seen ? place[k] : kUnseen);
    }
  }
  return {};
}

}  // namespace

Result<PointRecording> read_point_table(std::string_view text, const PointTableOptions& options) {
  const auto lines = dam::table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table is empty");
  const char separator = separator_of(lines[0].text);
  PointRecording out;
  auto header = read_point_header(Row(lines[0], separator), out.warnings);
  if (!header) return header.error();
  if (lines.size() == 1)
    return make_error(Code::truncated, "there is no row after the header line");
  PointRows table{std::move(*header), {}, {}};
  if (!table.header.time && !options.rate) {
    return make_error(Code::invalid_argument,
                      "no column has the times (time_s, time or timestamp); add one or give the "
                      "frame rate (--rate)");
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (auto ok = read_point_row(Row(lines[i], separator), options, table); !ok) return ok.error();
  }
  const auto placed = place_rows(table.times, options.rate, out.warnings);
  if (!placed) return placed.error();

  dam::PointTrack& track = out.track;
  track.rate = placed->rate;
  track.dimensions = table.header.dimensions;
  track.names = std::move(table.header.points);
  std::int64_t first = -1, last = -1;
  for (const auto& number : placed->numbers) {
    if (!number) continue;
    if (first < 0) first = *number;
    last = *number;
  }
  const auto frames = std::size_t(last - first + 1);
  if (frames > 20 * table.times.size() + 1000 || frames > kMostCoordinates / track.size()) {
    return make_error(Code::out_of_range,
                      std::to_string(frames) + " frames of " + std::to_string(track.names.size()) +
                          " are too many; split the table, or correct its times");
  }
  out.start = track.rate.seconds(double(first));
  track.values.assign(frames * track.size(), kUnseen);
  for (std::size_t i = 0; i < table.times.size(); ++i) {
    if (!placed->numbers[i]) continue;
    const auto from = table.values.begin() + std::ptrdiff_t(i * track.size());
    std::copy(from, from + std::ptrdiff_t(track.size()),
              track.frame(std::size_t(*placed->numbers[i] - first)).begin());
  }
  return out;
}

}  // namespace animeme::exchange

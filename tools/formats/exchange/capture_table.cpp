#include "tools/formats/exchange/capture_table.h"

#include <algorithm>
#include <array>
#include <map>

#include "dam/signal/fap_signal.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/detail/action_units.h"
#include "tools/formats/exchange/detail/face_packets.h"
#include "tools/formats/exchange/detail/json_landmarks.h"
#include "tools/formats/exchange/detail/landmark_columns.h"
#include "tools/formats/exchange/detail/plain_table.h"
#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {

namespace {

constexpr std::string_view kPointNames[] = {
    "point",       "point_id",       "point_index", "point_name",    "landmark",
    "landmark_id", "landmark_index", "index",       "landmark_name", "id",
    "keypoint",    "keypoint_id",    "marker",      "marker_id",     "marker_name",
    "name",        "vertex",         "joint",       "landmarkid",    "landmarkindex"};
constexpr std::size_t kMostPoints = 5000;

struct LongColumns {
  std::optional<std::size_t> point;
  std::array<std::optional<std::size_t>, 3> axes;
  std::vector<std::size_t> keys;  // of the frame: time, frame, face and the like
  std::vector<std::string> key_names;
};

LongColumns columns_of(const Row& header) {
  LongColumns columns;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string name = lower_case(header.text(i));
    const bool point =
        std::find(std::begin(kPointNames), std::end(kPointNames), name) != std::end(kPointNames);
    if (point && !columns.point) {
      columns.point = i;
    } else if (name == "x" || name == "y" || name == "z") {
      columns.axes[std::size_t(name[0] - 'x')] = i;
    } else if (is_time_name(name) || name == "frame" || name == "face_id" || name == "face" ||
               name == "success") {
      columns.keys.push_back(i);
      columns.key_names.push_back(name);
    } else if (name == "frame_id" || name == "frame_index" || name == "frame_number") {
      columns.keys.push_back(i);
      columns.key_names.emplace_back("frame");
    }
  }
  return columns;
}

// The name of a point for readers of wide tables; empty: left out.
std::string name_of_point(std::string_view given, const ColumnMap& rules) {
  std::string name(given);
  // 152.0, as data frames write whole numbers; no feature point ends so.
  if (name.ends_with(".0") && is_point_name(std::string_view(name).substr(0, name.size() - 2))) {
    name.resize(name.size() - 2);
  }
  for (const ColumnRule& rule : rules) {
    if (lower_case(rule.name) == lower_case(name)) return rule.meaning == "-" ? "" : rule.meaning;
  }
  return name;
}

struct WideFrame {
  std::vector<std::string> keys;
  std::map<std::size_t, std::array<std::string, 3>> points;
};

// True if a header line has columns x and y, and one that says which point a row is about: point,
// landmark, landmark_id, landmark_index, index, id, keypoint, marker, name, and the like.
bool is_long_table(std::string_view header) {
  const LongColumns columns = columns_of(Row({1, header}, separator_of(header)));
  return columns.point && columns.axes[0] && columns.axes[1];
}

// The same with one row a frame. A frame ends where its time, number or face changes, or without
// these where a point comes for the second time. Rules of `points` that name a point give it
// another name, or leave it out ("-"). Errors, with line and column: syntax (fields, a point twice
// in a frame, more than 5,000 points), truncated (no rows).
Result<std::string> long_to_wide(std::string_view text, const ColumnMap& points) {
  const auto lines = dam::table_lines(text);
  const char separator = lines.empty() ? ',' : separator_of(lines[0].text);
  if (lines.size() < 2) {
    return make_error(Code::truncated, "there is no row after the header line");
  }
  const Row header(lines[0], separator);
  const LongColumns columns = columns_of(header);
  std::map<std::string, std::size_t> numbers;
  std::vector<std::string> names;
  std::vector<WideFrame> frames;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Row row(lines[i], separator);
    if (auto ok = row.check_size(header.size()); !ok) return ok.error();
    const std::string name = name_of_point(row.text(*columns.point), points);
    if (name.empty()) continue;
    const auto [at, fresh] = numbers.emplace(name, names.size());
    if (fresh) names.push_back(name);
    if (names.size() > kMostPoints) {
      return row.error(*columns.point, "more than 5000 points; is this column the point?");
    }
    std::vector<std::string> keys;
    for (const std::size_t key : columns.keys) keys.emplace_back(row.text(key));
    const bool again = !frames.empty() && frames.back().points.contains(at->second);
    if (frames.empty() || frames.back().keys != keys || (keys.empty() && again)) {
      frames.push_back({std::move(keys), {}});
    } else if (again) {
      return row.wrong(*columns.point, "the point", "duplicate in this frame; remove one");
    }
    std::array<std::string, 3>& place = frames.back().points[at->second];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (columns.axes[axis]) place[axis] = row.text(*columns.axes[axis]);
    }
  }
  const std::size_t axes = columns.axes[2] ? 3 : 2;
  std::string out;
  const auto put = [&](std::string_view field) {
    if (!out.empty() && out.back() != '\n') out += separator;
    out += field;
  };
  for (const std::string& key : columns.key_names) put(key);
  for (const std::string& name : names) {
    for (std::size_t axis = 0; axis < axes; ++axis) put(name + "_" + "xyz"[axis]);
  }
  for (const WideFrame& frame : frames) {
    out += '\n';
    bool first = true;
    const auto cell = [&](std::string_view field) {
      if (!first) out += separator;
      first = false;
      out += field;
    };
    for (const std::string& key : frame.keys) cell(key);
    for (std::size_t point = 0; point < names.size(); ++point) {
      const auto found = frame.points.find(point);
      for (std::size_t axis = 0; axis < axes; ++axis) {
        cell(found == frame.points.end() ? std::string_view() : found->second[axis]);
      }
    }
  }
  return out + "\n";
}

constexpr std::size_t kRowsToLookAt = 20;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool is_fap_header(std::string_view header) {
  const Row names({1, header}, separator_of(header));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (dam::fap_of_channel(lower_case(names.text(i))) > 0) return true;
  }
  return false;
}

bool is_numeric(std::string_view field) {
  return !field.empty() && field.find_first_not_of("+-0123456789.eE") == std::string_view::npos;
}

// The same with percent signs, and colons, as in 00:00:01.040.
bool is_quantity(std::string_view field) {
  return !field.empty() && field.find_first_not_of("+-0123456789.eE%:") == std::string_view::npos;
}

// Decimal commas in rows behind the header, which has other separators: some, and nothing else.
bool has_decimal_commas(const std::vector<dam::TableLine>& lines) {
  const char separator = separator_of(lines[0].text);
  if (separator == ',') return false;
  bool any = false;
  for (std::size_t i = 1; i < std::min(lines.size(), kRowsToLookAt); ++i) {
    for (const std::string_view field : dam::split_fields(lines[i].text, separator)) {
      std::string number(dam::trimmed(field));
      const std::size_t comma = number.find(',');
      if (comma == std::string::npos) continue;
      number[comma] = '.';
      if (!is_quantity(number)) return false;
      any = true;
    }
  }
  return any;
}

// The first line with content: readers leave empty lines out.
std::string_view header_of(const std::vector<dam::TableLine>& lines) { return lines[0].text; }

std::string header_of_plain(std::string_view text) {
  const std::string plain = plain_table(text);
  const auto lines = dam::table_lines(plain);
  return lines.empty() ? std::string() : std::string(lines[0].text);
}

Error no_table(const std::vector<dam::TableLine>& lines) {
  const std::string_view header = header_of(lines);
  const Row names({lines[0].number, header}, separator_of(header));
  const auto at = std::int64_t(lines[0].number);
  std::size_t numbers = 0;
  std::vector<std::string> list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    numbers += is_numeric(names.text(i)) ? 1 : 0;
    list.emplace_back(names.text(i));
  }
  if (numbers * 2 > names.size()) {
    return error_at_line(Code::not_found,
                         "the first line holds " + std::to_string(numbers) +
                             " numbers and no column names; put a header line before it (time_s,"
                             "x_0,y_0,x_1,y_1 ... for landmarks, time_s,jawOpen ... for shapes)",
                         at);
  }
  if (names.size() < 2) {
    return error_at_line(Code::not_found,
                         "this is text, but not a table: its first line is one field, '" +
                             std::string(header.substr(0, 60)) +
                             "'; commas, semicolons or tabs separate the columns of a table",
                         at);
  }
  return error_at_line(Code::not_found,
                       "no column is an ARKit blend shape (jawOpen, EyeBlinkLeft ...), and there "
                       "are not all points of a set of landmarks (x_0, y_0 ... x_67, y_67; see "
                       "import --help), nor four of them, nor FAPs (fap3); there are: " +
                           list_of_names(list) +
                           "; name the columns so, or say what they are (--column NAME=jawOpen)",
                       at);
}

}  // namespace

bool has_times(std::string_view table) {
  const std::string_view header = first_line(table);
  const Row names({1, header}, separator_of(header));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_time_name(lower_case(names.text(i)))) return true;
  }
  return false;
}

Result<CaptureTable> capture_table(std::string_view text, const CaptureTableOptions& options) {
  if (const std::string what = foreign_file(bytes_of(text)); !what.empty()) {
    // Numbers behind a comment may have their names in it.
    const bool named = text.starts_with('#') && is_arkit_table(header_of_plain(text));
    if (!named) return make_error(Code::unsupported, what);
  }
  CaptureTable out;
  if (is_json(text)) {
    Result<JsonTable> json = json_to_table(text, options.shapes);
    if (!json) return std::move(json).error();
    out = {{}, std::move(json->table), json->size, json->layout, std::move(json->warnings)};
  } else if (is_face_packets(text)) {
    Result<ShapeTable> shapes = face_packets_to_shapes(text);
    if (!shapes) return std::move(shapes).error();
    out.table = std::move(shapes->table);
    out.warnings = std::move(shapes->warnings);
  } else {
    out.table = plain_table(text);
  }
  auto lines = dam::table_lines(out.table);
  if (lines.empty()) return make_error(Code::truncated, "the file is empty");
  if (lines.size() > 1 && has_decimal_commas(lines)) {
    const std::size_t body = std::size_t(lines[1].text.data() - out.table.data());
    std::replace(out.table.begin() + std::ptrdiff_t(body), out.table.end(), ',', '.');
    out.warnings.emplace_back("decimal commas were read as points");
    lines = dam::table_lines(out.table);
  }
  if (is_long_table(header_of(lines))) {
    auto wide = long_to_wide(out.table, options.columns);
    if (!wide) return wide.error();
    out.table = std::move(*wide);
    out.warnings.emplace_back("the table has one row per point; rows were combined to frames");
  } else if (!options.columns.empty()) {
    auto named = rename_columns(out.table, options.columns);
    if (!named) return named.error();
    out.table = std::move(*named);
  }
  lines = dam::table_lines(out.table);
  if (lines.empty()) return make_error(Code::truncated, "no column is left");
  std::string_view header = header_of(lines);
  const bool points = is_landmark_header(header) || has_landmark_columns(header) || out.layout;
  if (!points && !has_shape(header) && is_action_unit_table(header)) {
    auto shapes = action_units_to_shapes(out.table);
    if (!shapes) return shapes.error();
    out.table = std::move(shapes->table);
    for (std::string& one : shapes->warnings) out.warnings.push_back(std::move(one));
    lines = dam::table_lines(out.table);
    header = header_of(lines);
  }
  if (is_arkit_table(header) || (has_shape(header) && !has_landmark_columns(header))) {
    out.kind = CaptureKind::arkit;
  } else if (is_landmark_header(header) || has_landmark_columns(header) || out.layout) {
    out.kind = CaptureKind::landmarks;
  } else if (is_fap_header(header)) {
    out.kind = CaptureKind::faps;
    // Their reader knows commas alone.
    const char separator = separator_of(header);
    if (separator != ',') std::replace(out.table.begin(), out.table.end(), separator, ',');
  } else if (has_numbered_points(header)) {
    out.kind = CaptureKind::landmarks;  // its reader says what is missing
  } else {
    return no_table(lines);
  }
  return out;
}

}  // namespace animeme::exchange

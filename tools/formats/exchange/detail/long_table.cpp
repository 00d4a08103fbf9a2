#include "tools/formats/exchange/detail/long_table.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "tools/formats/exchange/detail/landmark_columns.h"
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

}  // namespace

bool is_long_table(std::string_view header) {
  const LongColumns columns = columns_of(Row({1, header}, separator_of(header)));
  return columns.point && columns.axes[0] && columns.axes[1];
}

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

}  // namespace animeme::exchange

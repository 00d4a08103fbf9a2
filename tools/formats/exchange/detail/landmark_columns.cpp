#include "tools/formats/exchange/detail/landmark_columns.h"

#include <algorithm>
#include <map>

#include "fap/arkit.h"
#include "fap/tables.h"

namespace animeme::exchange {

namespace {

constexpr std::string_view kPrefixes[] = {"",      "landmark", "landmarks", "lm",     "lmk",
                                          "point", "pt",       "p",         "kp",     "keypoint",
                                          "fp",    "fdp",      "v",         "vertex", "mark"};
// Columns of OpenFace that say nothing of landmarks.
constexpr std::string_view kForeign[] = {"eye_lmk_", "au",     "p_",   "pose_t",
                                         "gaze_",    "pose_r", "face", "input"};
constexpr int kMostLandmarks = 100000;
constexpr int kIbugPoints = 68;
constexpr int kMediapipePoints = 478;
constexpr std::size_t kFewestPoints = 4;  // of a part of a layout

// One coordinate of one landmark.
struct Coordinate {
  std::string point;  // digits, or an id of a feature point
  std::size_t axis = 0;
  bool capital = false;  // X_0, not x_0
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_break(char c) { return c == '_' || c == '-' || c == ' ' || c == '.'; }

bool is_feature_point(std::string_view id) {
  if (id == fap::kNasion) return true;
  return std::any_of(fap::kFeaturePoints.begin(), fap::kFeaturePoints.end(),
                     [&](const fap::FeaturePointInfo& point) { return point.id == id; });
}

// "x_12".
std::optional<Coordinate> axis_first(std::string_view name) {
  const auto axis = axis_of(name[0]);
  std::string_view rest = name.substr(1);
  if (!rest.empty() && is_break(rest[0])) rest.remove_prefix(1);
  if (!axis || !is_short_number(rest)) return std::nullopt;
  return Coordinate{std::string(rest), *axis, name[0] < 'a'};
}

// "landmark_12_x", "8.1_x".
std::optional<Coordinate> axis_last(std::string_view name) {
  const auto axis = axis_of(name.back());
  if (!axis) return std::nullopt;
  std::string_view rest = name.substr(0, name.size() - 1);
  if (!rest.empty() && is_break(rest.back())) rest.remove_suffix(1);
  const std::string word = lower_case(rest);
  if (word == fap::kNasion) return Coordinate{word, *axis, false};
  std::size_t begin = 0;
  while (begin < rest.size() && !is_digit(rest[begin])) ++begin;
  std::string prefix = lower_case(rest.substr(0, begin));
  while (!prefix.empty() && is_break(prefix.back())) prefix.pop_back();
  if (std::find(std::begin(kPrefixes), std::end(kPrefixes), prefix) == std::end(kPrefixes)) {
    return std::nullopt;
  }
  const std::string_view id = rest.substr(begin);
  if (!is_short_number(id) && !is_feature_point(id)) return std::nullopt;
  return Coordinate{std::string(id), *axis, false};
}

std::optional<Coordinate> parse_coordinate(std::string_view name) {
  if (name.size() < 2) return std::nullopt;
  if (auto found = axis_first(name)) return found;
  return axis_last(name);
}

bool is_foreign(std::string_view name) {
  return std::any_of(std::begin(kForeign), std::end(kForeign),
                     [&](std::string_view start) { return name.starts_with(start); });
}

// All coordinates of a header, in the picture and in space.
struct Found {
  std::map<int, Fields3> numbered;
  std::map<int, Fields3> capital;
  std::map<std::string, Fields3> named;
};

Field* place_of(Found& found, const Coordinate& coordinate) {
  if (!is_short_number(coordinate.point)) return &found.named[coordinate.point][coordinate.axis];
  const int number = std::stoi(coordinate.point);
  if (number >= kMostLandmarks) return nullptr;
  return &(coordinate.capital ? found.capital : found.numbered)[number][coordinate.axis];
}

Field* other_column(LandmarkColumns& columns, const std::string& name) {
  if (is_time_name(name)) return &columns.time;
  if (name == "frame") return &columns.frame;
  if (name == "face_id" || name == "face") return &columns.face;
  if (name == "confidence") return &columns.confidence;
  if (name == "success") return &columns.success;
  if (name == "gaze_angle_x") return &columns.gaze_angle[0];
  if (name == "gaze_angle_y") return &columns.gaze_angle[1];
  const auto axis = name.empty() ? std::nullopt : axis_of(name.back());
  if (!axis) return nullptr;
  const std::string_view start = std::string_view(name).substr(0, name.size() - 1);
  if (start == "pose_r") return &columns.pose[*axis];
  if (start == "gaze_0_") return &columns.gaze[0][*axis];
  if (start == "gaze_1_") return &columns.gaze[1][*axis];
  return nullptr;
}

Result<Found> sort_columns(const Row& header, LandmarkColumns& columns,
                           std::vector<std::string>& unknown) {
  Found found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string_view given = header.text(i);
    columns.names.emplace_back(given);
    const std::string name = lower_case(given);
    Field* place = other_column(columns, name);
    if (place == nullptr) {
      if (const auto coordinate = parse_coordinate(given)) place = place_of(found, *coordinate);
    }
    if (place == nullptr) {
      if (!name.empty() && !is_foreign(name)) unknown.emplace_back(given);
    } else if (*place) {
      return header.named_twice(i);
    } else {
      *place = i;
    }
  }
  return found;
}

// Numbers that count from 1 are made to count from 0.
std::map<int, Fields3> from_zero(std::map<int, Fields3> points) {
  if (points.empty() || points.begin()->first != 1) return points;
  const int last = points.rbegin()->first;
  if (last != 68 && last != 468 && last != 478) return points;
  std::map<int, Fields3> out;
  for (const auto& [number, fields] : points) out[number - 1] = fields;
  return out;
}

std::optional<fap::LandmarkLayout> layout_of(const std::map<int, Fields3>& points) {
  if (points.empty() || std::size_t(points.rbegin()->first) + 1 != points.size()) {
    return std::nullopt;
  }
  if (points.size() == 68) return fap::LandmarkLayout::ibug68;
  if (points.size() == 468 || points.size() == 478) return fap::LandmarkLayout::mediapipe;
  return std::nullopt;
}

// The layout that numbered points are a part of, if they are none as a whole: the numbers go beyond
// the 68, or stay below, and four feature points at least are there.
std::optional<fap::LandmarkLayout> part_of(const std::map<int, Fields3>& points) {
  if (points.empty() || points.rbegin()->first >= kMediapipePoints) return std::nullopt;
  const auto layout = points.rbegin()->first < kIbugPoints ? fap::LandmarkLayout::ibug68
                                                           : fap::LandmarkLayout::mediapipe;
  std::size_t known = 0;
  for (const fap::LandmarkSource& source : fap::landmark_sources(layout)) {
    known += points.contains(source.landmark) ? 1 : 0;
  }
  if (known < kFewestPoints) return std::nullopt;
  return layout;
}

template <class Points>
bool have_depth(const Points& points) {
  return !points.empty() && std::all_of(points.begin(), points.end(), [](const auto& one) {
    return one.second[0] && one.second[1] && one.second[2];
  });
}

void take_layout(LandmarkColumns& columns, const std::map<int, Fields3>& points,
                 fap::LandmarkLayout layout) {
  for (const fap::LandmarkSource& source : fap::landmark_sources(layout)) {
    PointFields point{std::string(source.point), {}};
    for (const int number : {source.landmark, source.second}) {
      const auto at = points.find(number);
      if (number >= 0 && at != points.end()) point.landmarks.push_back(at->second);
    }
    if (point.landmarks.size() == (source.second < 0 ? 1U : 2U)) {
      columns.points.push_back(std::move(point));
    }
  }
  columns.may_be_shares = layout == fap::LandmarkLayout::mediapipe;
}

Error no_points(const Row& header, std::size_t count) {
  if (count > 0) {
    return error_at_line(Code::not_found,
                         std::to_string(count) +
                             " numbered points are not a known layout, which are 68 (iBUG, "
                             "OpenFace, dlib), 468 or 478 (MediaPipe), or parts of them with four "
                             "feature points; --layout 68 or mediapipe selects one",
                         std::int64_t(header.line()));
  }
  return error_at_line(Code::not_found,
                       "no column is a coordinate of a landmark: names like x_0, y_0, "
                       "landmark_0_x or 8.1_x (a feature point) are needed in the first line",
                       std::int64_t(header.line()));
}

Result<void> check_coordinates(const Row& header, const LandmarkColumns& columns) {
  for (const PointFields& point : columns.points) {
    for (const Fields3& fields : point.landmarks) {
      if (fields[0] && fields[1]) continue;
      return error_at_line(Code::not_found,
                           "the point " + point.point + " has no column for its " +
                               (fields[0] ? "y" : "x") + "; add it or remove the point",
                           std::int64_t(header.line()));
    }
  }
  return {};
}

}  // namespace

bool is_landmark_header(std::string_view header) {
  LandmarkColumns columns;
  std::vector<std::string> unknown;
  const auto found = sort_columns(Row({1, header}, separator_of(header)), columns, unknown);
  if (!found) return false;
  return layout_of(from_zero(found->numbered)) || layout_of(from_zero(found->capital)) ||
         found->named.size() >= 4;
}

bool is_coordinate_name(std::string_view name) { return parse_coordinate(name).has_value(); }

bool is_point_name(std::string_view name) {
  return is_short_number(name) || is_feature_point(name);
}

bool has_landmark_columns(std::string_view header) {
  LandmarkColumns columns;
  std::vector<std::string> unknown;
  const auto found = sort_columns(Row({1, header}, separator_of(header)), columns, unknown);
  if (!found) return is_landmark_header(header);
  return found->numbered.size() >= kFewestPoints || found->capital.size() >= kFewestPoints ||
         found->named.size() >= kFewestPoints;
}

bool has_numbered_points(std::string_view header) {
  const Row names({1, header}, separator_of(header));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_coordinate_name(names.text(i))) return true;
  }
  return false;
}

bool has_shape(std::string_view header) {
  const Row names({1, header}, separator_of(header));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (fap::find_arkit(names.text(i))) return true;
  }
  return false;
}

Result<LandmarkColumns> read_landmark_header(const Row& header, const LandmarkTableOptions& options,
                                             std::vector<std::string>& warnings) {
  LandmarkColumns columns;
  std::vector<std::string> unknown;
  const Result<Found> found = sort_columns(header, columns, unknown);
  if (!found) return found.error();
  const auto picture = from_zero(found->numbered);
  const auto space = from_zero(found->capital);
  const bool in_space = picture.empty() || (have_depth(space) && !options.flat);
  const auto& points = in_space ? space : picture;
  columns.in_space = in_space && found->named.empty() && !picture.empty();
  if (found->named.empty()) {
    auto layout = options.layout ? options.layout : layout_of(points);
    if (!layout) {
      layout = part_of(points);
      if (!layout) return no_points(header, points.size());
      warnings.push_back(std::to_string(points.size()) +
                         " numbered points are taken to be a part "
                         "of those of " +
                         (layout == fap::LandmarkLayout::ibug68 ? "iBUG (68)" : "MediaPipe") +
                         "; override it with --layout");
    }
    take_layout(columns, points, *layout);
    columns.depth = have_depth(points) && !options.flat;
  } else {
    for (const auto& [id, fields] : found->named) columns.points.push_back({id, {fields}});
    columns.depth = have_depth(found->named) && !options.flat;
    if (!points.empty()) unknown.push_back("numbered points");
  }
  if (columns.points.empty()) return no_points(header, points.size());
  if (auto ok = check_coordinates(header, columns); !ok) return ok.error();
  if (!unknown.empty()) {
    warnings.push_back("columns that are not landmarks are ignored: " + list_of_names(unknown));
  }
  return columns;
}

}  // namespace animeme::exchange

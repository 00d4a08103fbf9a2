// Direction, size and FAPs of a face of captured points.
#include <algorithm>
#include <cmath>

#include "dam/crossmap/face_points.h"
#include "fap/detail/text_scanner.h"

namespace animeme::dam {
namespace {

using fap::Point;

constexpr fap::Fapu kUsualFapu = {0.993, 5.903, 4.821, 2.120, 5.070};  // cm; see make_face()

Point way_from(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double along(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point stretched(const Point& a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }
Point square_to(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Places of the feature points that are there and seen at rest, in captured axes.
fap::FeaturePoints places_at(std::span<const double> neutral, std::size_t dimensions,
                             std::span<const FacePoint> points) {
  fap::FeaturePoints out;
  for (const FacePoint& point : points) {
    Point mean{};
    for (const std::size_t at : point.points) {
      for (std::size_t k = 0; k < dimensions; ++k) {
        mean[k] += neutral[at * dimensions + k] / double(point.points.size());
      }
    }
    if (std::isfinite(mean[0] + mean[1] + mean[2])) out.emplace(point.id, mean);
  }
  return out;
}

struct PointPair {
  const char* more;
  const char* less;
};
constexpr PointPair kLeftOfRight[] = {{"8.3", "8.4"},  {"2.4", "2.5"},  {"8.5", "8.6"},
                                      {"8.7", "8.8"},  {"2.6", "2.7"},  {"2.8", "2.9"},
                                      {"3.7", "3.12"}, {"3.11", "3.8"}, {"3.5", "3.6"},
                                      {"3.1", "3.2"},  {"9.1", "9.2"},  {"5.1", "5.2"}};
constexpr PointPair kUpOfDown[] = {
    {"8.1", "8.2"},  {"2.2", "2.3"}, {"8.1", "2.1"}, {"8.2", "2.1"},  {"8.1", "2.10"},
    {"9.15", "8.1"}, {"9.3", "8.1"}, {"3.7", "8.3"}, {"3.12", "8.4"}, {"nasion", "9.3"}};

// Sum of the ways from one of a pair to the other; nothing if no pair is there.
template <std::size_t N>
std::optional<Point> way_of(const fap::FeaturePoints& places, const PointPair (&pairs)[N]) {
  Point sum{};
  for (const PointPair& pair : pairs) {
    const auto more = places.find(pair.more), less = places.find(pair.less);
    if (more == places.end() || less == places.end()) continue;
    const Point step = way_from(more->second, less->second);
    for (std::size_t k = 0; k < 3; ++k) sum[k] += step[k];
  }
  if (!(along(sum, sum) > 0)) return std::nullopt;
  return sum;
}

Result<Axes> told_axes(const fap::FeaturePoints& places) {
  const std::optional<Point> left = way_of(places, kLeftOfRight), up = way_of(places, kUpOfDown);
  if (left && up) {
    Axes axes;
    axes.of[0] = stretched(*left, 1 / std::sqrt(along(*left, *left)));
    const Point rest = way_from(*up, stretched(axes.of[0], along(*up, axes.of[0])));
    const double length = std::sqrt(along(rest, rest));
    if (length > 0.1 * std::sqrt(along(*up, *up))) {
      axes.of[1] = stretched(rest, 1 / length);
      axes.of[2] = square_to(axes.of[0], axes.of[1]);
      return axes;
    }
  }
  return make_error(Code::not_found,
                    "the direction of the face cannot be inferred from the points; specify the "
                    "directions of x, y and z, "
                    "from the person's view, such as --axes \"left down back\" (a camera)");
}

// In axes of the face.
fap::FeaturePoints in_face_axes(const fap::FeaturePoints& places, const Axes& axes) {
  fap::FeaturePoints out;
  for (const auto& [id, at] : places) {
    out.emplace(id, Point{along(at, axes.of[0]), along(at, axes.of[1]), along(at, axes.of[2])});
  }
  return out;
}

// Difference of a coordinate of two points; 0 if one is not there or it is not positive.
double drop_of(const fap::FeaturePoints& places, const char* a, const char* b, std::size_t axis) {
  const auto more = places.find(a), less = places.find(b);
  if (more == places.end() || less == places.end()) return 0;
  return std::max(0.0, more->second[axis] - less->second[axis]);
}

double first_of(std::initializer_list<double> values) {
  for (const double value : values) {
    if (value > 0) return value;
  }
  return 0;
}

struct NamedUnit {
  double fap::Fapu::*unit;
  const char* name;
};
constexpr NamedUnit kUnits[] = {{&fap::Fapu::irisd, "IRISD"},
                                {&fap::Fapu::es, "ES"},
                                {&fap::Fapu::ens, "ENS"},
                                {&fap::Fapu::mns, "MNS"},
                                {&fap::Fapu::mw, "MW"}};

Result<fap::Fapu> told_units(const fap::FeaturePoints& places, const FaceOptions& options,
                             std::vector<std::string>& notes) {
  fap::Fapu fapu;
  fapu.mw = first_of({drop_of(places, "8.3", "8.4", 0)});
  fapu.mns = first_of({drop_of(places, "9.15", "2.2", 1)});
  fapu.es = first_of({drop_of(places, "3.5", "3.6", 0), drop_of(places, "3.1", "3.2", 0),
                      drop_of(places, "3.3", "3.4", 0)});
  fapu.irisd = first_of({drop_of(places, "3.1", "3.3", 1), drop_of(places, "3.2", "3.4", 1)});
  fapu.ens = first_of({drop_of(places, "3.5", "9.15", 1), drop_of(places, "3.6", "9.15", 1)});
  for (const NamedUnit& unit : kUnits) {
    const double given = options.fapu.*unit.unit;
    if (given < 0 || !std::isfinite(given)) {
      return make_error(Code::invalid_argument, std::string(unit.name) + " has to be above 0");
    }
    if (given > 0) fapu.*unit.unit = given;
  }
  // The geometric mean of the proportions of those that are known.
  double sum = 0, count = 0;
  for (const NamedUnit& unit : kUnits) {
    if (!(fapu.*unit.unit > 0)) continue;
    sum += std::log(fapu.*unit.unit / kUsualFapu.*unit.unit);
    ++count;
  }
  double scale = count > 0 ? std::exp(sum / count) : 0;
  if (scale == 0 && options.centimetres > 0) scale = 1 / options.centimetres;
  if (scale == 0) {
    return make_error(
        Code::not_found,
        "the size of the face cannot be inferred from the points; give at least one FAP "
        "unit, such as --fapu MW=50, or the unit of the points, such as --unit mm");
  }
  std::string guessed;
  for (const NamedUnit& unit : kUnits) {
    if (fapu.*unit.unit > 0) continue;
    fapu.*unit.unit = scale * kUsualFapu.*unit.unit;
    if (unit.unit == &fap::Fapu::irisd || unit.unit == &fap::Fapu::es) continue;
    guessed += (guessed.empty() ? "" : ", ") + std::string(unit.name);
  }
  if (!guessed.empty()) {
    notes.push_back("FAP units of an average face are used for " + guessed + "; --fapu sets them");
  }
  return fapu;
}

}  // namespace

std::optional<Axes> parse_axes(std::string_view text) {
  struct Word {
    const char* name;
    std::size_t axis;
    double sign;
  };
  constexpr Word kWords[] = {{"left", 0, 1},    {"right", 0, -1}, {"up", 1, 1},   {"down", 1, -1},
                             {"forward", 2, 1}, {"front", 2, 1},  {"back", 2, -1}};
  Axes axes;
  std::array<bool, 3> told{};
  std::size_t column = 0;
  const std::string lower = fap::detail::lower_case(text);
  for (std::size_t at = 0; at < lower.size();) {
    const std::size_t begin = lower.find_first_not_of(" ,", at);
    if (begin == std::string::npos) break;
    const std::size_t end = std::min(lower.find_first_of(" ,", begin), lower.size());
    const std::string word = lower.substr(begin, end - begin);
    const auto found = std::find_if(std::begin(kWords), std::end(kWords),
                                    [&](const Word& known) { return word == known.name; });
    if (found == std::end(kWords) || column > 2 || told[found->axis]) return std::nullopt;
    axes.of[found->axis][column++] = found->sign;
    told[found->axis] = true;
    at = end;
  }
  if (column < 2 || (column == 2 && told[2])) return std::nullopt;
  return axes;
}

Result<Face> make_face(std::span<const std::string> names, std::size_t dimensions,
                       std::span<const double> neutral, std::span<const FacePoint> points,
                       const FaceOptions& options) {
  if (points.empty()) {
    return make_error(Code::not_found,
                      "the captured points are not assigned to the face; assign them in the "
                      "project, such as [face] \"8.3\" = \"left corner marker\"");
  }
  Face face;
  const fap::FeaturePoints captured = places_at(neutral, dimensions, points);
  if (options.axes) {
    face.axes = *options.axes;
  } else {
    const Result<Axes> axes = told_axes(captured);
    if (!axes) return axes.error();
    face.axes = *axes;
  }
  const Result<fap::Fapu> fapu = told_units(in_face_axes(captured, face.axes), options, face.notes);
  if (!fapu) return fapu.error();
  face.fapu = *fapu;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const fap::Move move = fap::move_of(fap);
    if (move.kind != fap::MoveKind::translate) continue;
    if (dimensions == 2 && move.axis[2] != 0) continue;
    const auto point = std::find_if(points.begin(), points.end(), [&](const FacePoint& p) {
      return p.id == fap::info(fap).feature_point;
    });
    if (point == points.end() || !captured.contains(point->id)) continue;
    Point way{};  // in captured axes
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        way[k] += move.axis[axis] * face.axes.of[axis][k];
    }
    std::vector<double> row(names.size() * dimensions, 0.0);
    for (const std::size_t at : point->points) {
      for (std::size_t k = 0; k < dimensions; ++k) {
        row[at * dimensions + k] =
            fap::fap_value(fap, way[k], face.fapu) / double(point->points.size());
      }
    }
    face.faps.push_back(fap);
    face.rows.push_back(std::move(row));
  }
  if (face.faps.empty()) {
    return make_error(Code::not_found, "no captured point is one that a FAP moves");
  }
  return face;
}

std::vector<double> fap_values(const Face& face, std::span<const double> displacement) {
  std::vector<double> out;
  for (const std::vector<double>& row : face.rows) {
    double sum = 0;
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (row[k] != 0) sum += row[k] * displacement[k];
    }
    out.push_back(sum);
  }
  return out;
}

}  // namespace animeme::dam

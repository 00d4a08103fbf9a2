#include "fap/fapu.h"

#include <cmath>
#include <initializer_list>
#include <optional>

namespace animeme::fap {
namespace {

constexpr double kStepsPerUnit = 1024;
constexpr double kRadPerStep = 1e-5;
constexpr std::size_t kX = 0;
constexpr std::size_t kY = 1;

class Measurer {
 public:
  explicit Measurer(const FeaturePoints& points) : points_(points) {}

  // a - b along an axis; if either is missing, that of the next pair. Missing points of the
  // first pair are noted when no pair is complete.
  struct Pair {
    const char* a;
    const char* b;
  };
  double distance(std::string_view unit, std::size_t axis, std::initializer_list<Pair> pairs) {
    for (const Pair& pair : pairs) {
      if (has(pair.a) && has(pair.b)) return at(pair.a)[axis] - at(pair.b)[axis];
    }
    need(unit, pairs.begin()->a);
    need(unit, pairs.begin()->b);
    return 0;
  }

  std::optional<double> eye_height() const {
    for (const char* pupil : {"3.5", "3.6"}) {
      if (has(pupil)) return at(pupil)[kY];
    }
    double sum = 0;
    int count = 0;
    for (const char* lid : {"3.1", "3.2", "3.3", "3.4"}) {
      if (!has(lid)) continue;
      sum += at(lid)[kY];
      ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / count;
  }

  double eye_to_nose() {
    const std::optional<double> eyes = eye_height();
    if (!eyes) need("ENS", "3.5");
    need("ENS", "9.15");
    return eyes && has("9.15") ? *eyes - at("9.15")[kY] : 0;
  }

  const std::string& missing() const { return missing_; }

 private:
  bool has(std::string_view id) const { return points_.find(id) != points_.end(); }
  const Point& at(std::string_view id) const { return points_.find(id)->second; }

  void need(std::string_view unit, std::string_view id) {
    if (has(id)) return;
    if (!missing_.empty()) missing_ += ", ";
    missing_ += std::string(id) + " (" + std::string(name(id)) + ") for " + std::string(unit);
  }
  static std::string_view name(std::string_view id) {
    for (const FeaturePointInfo& point : kFeaturePoints) {
      if (point.id == id) return point.name;
    }
    return "unknown";
  }

  const FeaturePoints& points_;
  std::string missing_;
};

std::optional<Error> check_unit(std::string_view name, double size) {
  if (std::isfinite(size) && size > 0) return std::nullopt;
  return make_error(Code::invalid_argument,
                    "the unit " + std::string(name) + " is " + std::to_string(size) +
                        " but has to be positive: the model must face +Z with +Y up and +X to "
                        "the person's left");
}

std::optional<Error> check_units(const Fapu& fapu) {
  const struct {
    std::string_view name;
    double size;
  } units[] = {{"IRISD = 3.1.y - 3.3.y", fapu.irisd},
               {"ES = 3.5.x - 3.6.x", fapu.es},
               {"ENS = 3.5.y - 9.15.y", fapu.ens},
               {"MNS = 9.15.y - 2.2.y", fapu.mns},
               {"MW = 8.3.x - 8.4.x", fapu.mw}};
  for (const auto& unit : units) {
    if (auto error = check_unit(unit.name, unit.size)) return error;
  }
  return std::nullopt;
}

Point translation_axis(Motion motion) {
  switch (motion) {
    case Motion::left:
      return {1, 0, 0};
    case Motion::right:
      return {-1, 0, 0};
    case Motion::up:
      return {0, 1, 0};
    case Motion::down:
      return {0, -1, 0};
    case Motion::forward:
      return {0, 0, 1};
    default:
      return {0, 0, 0};
  }
}

Point rotation_axis(Motion motion) {
  switch (motion) {
    case Motion::down:  // pitch
      return {1, 0, 0};
    case Motion::left:  // yaw
      return {0, 1, 0};
    case Motion::right:  // roll
      return {0, 0, 1};
    default:
      return {0, 0, 0};
  }
}

}  // namespace

Result<Fapu> measure_fapu(const FeaturePoints& points) {
  Measurer m(points);
  Fapu fapu;
  fapu.irisd = m.distance("IRISD", kY, {{"3.1", "3.3"}, {"3.2", "3.4"}});
  fapu.es = m.distance("ES", kX, {{"3.5", "3.6"}, {"3.1", "3.2"}, {"3.3", "3.4"}});
  fapu.ens = m.eye_to_nose();
  fapu.mns = m.distance("MNS", kY, {{"9.15", "2.2"}});
  fapu.mw = m.distance("MW", kX, {{"8.3", "8.4"}});
  if (!m.missing().empty()) {
    return make_error(Code::not_found, "feature points are missing: " + m.missing());
  }
  if (auto error = check_units(fapu)) return std::move(*error);
  return fapu;
}

Move move_of(int fap) {
  if (fap < kFirstLowLevel || fap > kFapCount) return {};
  const FapInfo& row = info(fap);
  if (row.motion == Motion::growing) return {MoveKind::dilate, {}};
  if (row.motion == Motion::concave_upward) return {MoveKind::roll, {}};
  if (row.unit == Unit::angle) return {MoveKind::rotate, rotation_axis(row.motion)};
  return {MoveKind::translate, translation_axis(row.motion)};
}

double step_size(int fap, const Fapu& fapu) {
  if (fap < kFirstLowLevel || fap > kFapCount) return 0;
  switch (info(fap).unit) {
    case Unit::none:
      return 0;
    case Unit::irisd:
      return fapu.irisd / kStepsPerUnit;
    case Unit::es:
      return fapu.es / kStepsPerUnit;
    case Unit::ens:
      return fapu.ens / kStepsPerUnit;
    case Unit::mns:
      return fapu.mns / kStepsPerUnit;
    case Unit::mw:
      return fapu.mw / kStepsPerUnit;
    case Unit::angle:
      return kRadPerStep;
  }
  return 0;
}

double displacement(int fap, double value, const Fapu& fapu) {
  return value * step_size(fap, fapu);
}

double fap_value(int fap, double amount, const Fapu& fapu) {
  const double step = step_size(fap, fapu);
  return step == 0 ? 0 : amount / step;
}

}  // namespace animeme::fap

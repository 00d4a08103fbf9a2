#include "fap/head/detail/own_steps.h"

#include <functional>

namespace animeme::head::detail {
namespace {

struct Turn {
  std::array<Vec3, 3> rows;

  Vec3 operator()(Vec3 p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
};

// All rotations that bring axes to axes.
std::vector<Turn> turns() {
  std::vector<Turn> out;
  const std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      if (a == b) continue;
      for (const float s : {1.0f, -1.0f}) {
        for (const float t : {1.0f, -1.0f}) {
          const Vec3 x = axes[a] * s;
          const Vec3 y = axes[b] * t;
          out.push_back({{x, y, cross(x, y)}});
        }
      }
    }
  }
  return out;
}

using Change = std::function<Vec3(Vec3)>;

void change(Source& source, const Change& point, const Change& direction) {
  for (Piece& piece : source.pieces) {
    for (Vec3& p : piece.mesh.positions) p = point(p);
  }
  for (PieceTarget& target : source.targets) {
    for (Vec3& d : target.deltas) d = direction(d);
  }
  for (std::optional<Vec3>* p :
       {&source.eyes[0], &source.eyes[1], &source.jaw_axis, &source.neck_pivot}) {
    if (*p) *p = point(**p);
  }
}

}  // namespace

std::optional<Vec3> place_of(const Source& source, std::string_view id) {
  for (const PiecePoint& point : source.points) {
    if (point.id == id) return source.pieces[point.piece].mesh.positions[point.vertex];
  }
  return std::nullopt;
}

std::optional<Vec3> between(const Source& source, std::string_view left, std::string_view right) {
  const std::optional<Vec3> a = place_of(source, left);
  const std::optional<Vec3> b = place_of(source, right);
  if (!a || !b) return std::nullopt;
  return mix(*a, *b, 0.5f);
}

bool turn_upright(Source& source) {
  std::optional<Vec3> to_left;
  for (const auto& [left, right] :
       {std::pair("8.3", "8.4"), {"3.5", "3.6"}, {"3.1", "3.2"}, {"3.7", "3.12"}}) {
    const std::optional<Vec3> a = place_of(source, left);
    const std::optional<Vec3> b = place_of(source, right);
    if (a && b && !to_left) to_left = normalised(*a - *b);
  }
  std::optional<Vec3> high = between(source, "3.1", "3.2");
  if (!high) high = between(source, "3.3", "3.4");
  std::optional<Vec3> low = place_of(source, "2.2");
  if (!low) low = between(source, "8.3", "8.4");
  if (!to_left || !high || !low) return false;
  const Vec3 up = normalised(*high - *low);
  const Vec3 forward = cross(*to_left, up);
  const Turn* best = nullptr;
  float most = 0;
  const std::vector<Turn> all = turns();
  for (const Turn& turn : all) {
    const float fit = turn(*to_left).x + turn(up).y + turn(forward).z;
    if (fit > most) {
      most = fit;
      best = &turn;
    }
  }
  if (best == nullptr) return false;
  if (best->rows[0] == Vec3{1, 0, 0} && best->rows[1] == Vec3{0, 1, 0}) return false;
  const Turn turn = *best;
  const auto apply = [&](Vec3 p) { return turn(p); };
  change(source, apply, apply);
  for (Piece& piece : source.pieces) {
    for (Corner& corner : piece.mesh.corners) corner.normal = turn(corner.normal);
  }
  return true;
}

void move_and_scale(Source& source, Vec3 origin, float scale) {
  change(
      source, [&](Vec3 p) { return (p - origin) * scale; }, [&](Vec3 d) { return d * scale; });
  if (!source.fapu) return;
  for (double* unit : {&source.fapu->irisd, &source.fapu->es, &source.fapu->ens, &source.fapu->mns,
                       &source.fapu->mw}) {
    *unit *= double(scale);
  }
}

LengthUnit unit_of(double distance) {
  constexpr LengthUnit kUnits[] = {
      {1, "centimetres"}, {100, "metres"}, {0.1, "millimetres"}, {2.54, "inches"}};
  for (const LengthUnit& unit : kUnits) {
    const double cm = distance * unit.centimetres;
    if (cm > 4.2 && cm < 9) return unit;
  }
  return {6.3 / distance, ""};
}

}  // namespace animeme::head::detail

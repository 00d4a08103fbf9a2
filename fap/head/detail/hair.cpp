#include <numbers>

#include "fap/head/detail/paint.h"
#include "fap/head/detail/parts.h"
#include "fap/head/detail/scalp.h"

namespace animeme::head::detail {
namespace {

using std::numbers::pi;

// How a wave of strands runs over the hair: 0..1 at a place.
double strand(Vec3d p, double count, double bend) {
  const double around = std::atan2(p.x, p.z + 1.2);
  return 0.5 + 0.5 * std::sin(around * count + bend * std::sin(p.y * 0.35 + around) +
                              0.8 * std::sin(around * count * 0.37 + 1.3));
}

// Rolls of hair along lines on the skin, so that its edge has a body.
double rolls(const std::vector<Vec3d>& line, Vec3d p, double radius, double blend) {
  double d = 1e9;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    d = smooth_min(d, cone(p, line[i], line[i + 1], radius, radius), blend);
  }
  return d;
}

// Where the ends are.
double ends_of(const Shape& shape) { return shape.p.hair == HairStyle::lengthy ? -13.4 : -7.6; }

double bob_field(const Shape& shape, const HairLines& lines, Vec3d p) {
  const HeadParameters& h = shape.p;
  const double x = std::abs(p.x);
  const double cap =
      ellipsoid(p - Vec3d{0, 3.5, -0.7}, {h.skull_width + 0.85, h.skull_height + 0.75, 9.7});
  // Wider towards its ends, which turn in at the neck.
  const double drop = std::clamp((2.0 - p.y) / 9.0, 0.0, 1.0);
  const Vec3d q{x, 0, p.z + 1.6};
  const double wide = 8.1 + 0.75 * std::sin(pi * std::min(drop * 0.95, 1.0));
  const double sides = (std::hypot(q.x / wide, q.z / 8.6) - 1) * 8.2;
  const double ends = smooth_max(-(p.y - ends_of(shape) + 0.25 * strand(p, 9, 0)), p.y - 3.0, 1.0);
  double d = smooth_min(cap, smooth_max(sides, ends, 1.4), 1.6);
  // The face looks out; a parting on the right.
  const double shift = p.x + 0.7;
  const double arch = 5.95 - 0.045 * shift * shift + 0.12 * p.x;
  const double face = smooth_max(
      x - 5.25 - 0.05 * (p.y - 1) - 0.10 * std::max(8.0 - p.z, 0.0) * -1.0, p.y - arch, 2.4);
  const double front = smooth_max(face, 2.2 - p.z, 1.0);
  d = smooth_max(d, -front, 0.8);
  d = smooth_min(d, rolls(lines.left, p, 0.62, 0.2), 0.9);
  d = smooth_min(d, rolls(lines.right, p, 0.62, 0.2), 0.9);
  const double parting = std::exp(-std::pow((p.x + 1.6) / 0.28, 2)) * smooth_step(6.0, 8.5, p.y) *
                         smooth_step(-3.0, 3.0, p.z);
  return d + 0.16 * parting + 0.05 * strand(p, 26, 1.0);
}

using Surface = std::function<double(Vec3d)>;

constexpr Vec3d kInside{0, 3.2, -1.1};

Vec3d onto(const Surface& hair, Vec3d from, Vec3d away, double height) {
  const Vec3d direction = normalised(away);
  return outer_hit(hair, from, direction, 16) + direction * height;
}

// From the parting over the side to the ends, which turn in. Angle 0 is in front, pi behind.
Lock curtain(const Surface& hair, double angle, double lowest, double end, double above) {
  constexpr int kPlaces = 15;
  Lock lock;
  lock.flatness = 0.42;
  const Vec3d aside{std::sin(angle), 0, std::cos(angle)};
  const Vec3d parting{-1.6, 8.0, 4.5 * std::cos(angle)};
  for (int i = 0; i < kPlaces; ++i) {
    const double t = double(i) / (kPlaces - 1);
    const double over = std::min(t / 0.42, 1.0);
    const double down = std::max((t - 0.42) / 0.58, 0.0);
    // Below the lowest ends of the bob, tips hang down.
    const double y = kInside.y + (end - kInside.y) * down;
    const double hanging = std::max(lowest - y, 0.0);
    const Vec3d from{kInside.x, y + hanging, kInside.z};
    const Vec3d away = mix(parting, aside * 8.5, smooth_step(-0.1, 1.0, over));
    const double height = above - 0.5 * smooth_step(0.12, 0.0, t) - 0.3 * smooth_step(0.9, 1.0, t);
    lock.places.push_back(onto(hair, from, away, height) -
                          (aside * 0.3 + Vec3d{0, 1, 0}) * hanging);
    lock.outwards.push_back(normalised(away));
  }
  return lock;
}

// Along the edge of the hair above the face, `above` cm higher.
Lock fringe(const Surface& hair, const std::vector<Vec3d>& line, double above) {
  constexpr std::size_t kPlaces = 14;
  Lock lock;
  std::vector<Vec3d> smooth;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double at = double(i) / (kPlaces - 1) * double(line.size() - 1);
    const auto k = std::min(std::size_t(at), line.size() - 2);
    smooth.push_back(mix(line[k], line[k + 1], at - double(k)));
  }
  for (int round = 0; round < 4; ++round) {
    for (std::size_t i = 1; i + 1 < kPlaces; ++i) {
      smooth[i] = smooth[i] * 0.5 + (smooth[i - 1] + smooth[i + 1]) * 0.25;
    }
  }
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double t = double(i) / (kPlaces - 1);
    const Vec3d away = smooth[i] + Vec3d{0, above * (1 - 0.3 * t), 0} - kInside;
    lock.places.push_back(onto(hair, kInside, away, 0.18 - 0.4 * smooth_step(0.1, 0.0, t)));
    lock.outwards.push_back(normalised(away));
  }
  return lock;
}

void add_bob_locks(const Surface& hair, const HairLines& lines, double ends, Vec3 colour,
                   Mesh& mesh) {
  constexpr int kCurtains = 76;
  for (int i = 0; i < kCurtains; ++i) {
    const double place = (i + 0.7 * scattered(i + 900) - 0.35) / (kCurtains - 1);
    const double angle = 0.9 + (2 * pi - 1.8) * std::clamp(place, 0.0, 1.0);
    const bool front = i < 3 || i > kCurtains - 4;
    const double end = ends - 0.5 + 0.7 * scattered(i) - 0.35 + (front ? 0.5 : 0);
    Lock lock = curtain(hair, angle, ends + 0.6, end, 0.04 + 0.2 * scattered(i + 300));
    lock.width = front ? 0.5 : 0.48 + 0.3 * scattered(i + 500);
    lock.tint = 0.84f + 0.3f * float(scattered(i + 700));
    add_lock(lock, colour, mesh);
  }
  constexpr int kFringes = 9;
  for (int i = kFringes - 1; i >= 0; --i) {
    const double above = 0.05 + 0.31 * i;
    for (const std::vector<Vec3d>* line : {&lines.left, &lines.right}) {
      Lock lock = fringe(hair, *line, above);
      lock.width = 0.4;
      lock.tint = 0.86f + 0.28f * float(scattered(i * 2 + (line == &lines.left ? 1 : 0)));
      add_lock(lock, colour, mesh);
    }
  }
}

}  // namespace

bool hangs(HairStyle style) { return style == HairStyle::bob || style == HairStyle::lengthy; }

HairLines hair_lines(const Shape& shape) {
  const auto on_skin = [&shape](std::initializer_list<std::array<double, 2>> places) {
    std::vector<Vec3d> line;
    for (const auto& [x, y] : places) line.push_back(shape.front(x, y));
    return line;
  };
  switch (shape.p.hair) {
    case HairStyle::bob:
    case HairStyle::lengthy:
      return {on_skin({{-1.7, 7.6}, {0.6, 6.6}, {2.9, 5.7}, {4.8, 4.4}, {5.9, 2.6}, {6.2, 0.6}}),
              on_skin({{-1.7, 7.6}, {-3.4, 6.4}, {-5.0, 4.5}, {-5.9, 2.6}, {-6.2, 0.6}})};
    case HairStyle::short_cut:
    case HairStyle::fringe:
    case HairStyle::bun:
    case HairStyle::curly:
    case HairStyle::bald:
      return {};
  }
  return {};
}

double hair_field(const Shape& shape, const HairLines& lines, Vec3d p) {
  return hangs(shape.p.hair) ? bob_field(shape, lines, p) : short_hair_field(shape, p);
}

Mesh make_hair(const Shape& shape) {
  if (!hangs(shape.p.hair)) return make_short_hair(shape);
  const HairLines lines = hair_lines(shape);
  const auto field = [&](Vec3d p) { return bob_field(shape, lines, p); };
  const Vec3 colour = linear_colour(shape.p.hair_colour);
  Mesh bob = surface_nets(field, {-11.2, ends_of(shape) - 2.8, -12.4}, {11.2, 14, 11.2},
                          0.64 / std::sqrt(shape.p.density));
  for (const Vec3& v : bob.positions) {
    const Vec3d p(v);
    const float streak = float(0.6 * strand(p, 41, 1.5) + 0.4 * strand(p, 97, 2.5));
    bob.colours.push_back(colour * (0.72f + 0.6f * streak));
  }
  bob.occlusion.assign(bob.positions.size(), 1.0f);
  // What lies below comes last: renderers need not paint it then.
  Mesh mesh;
  add_bob_locks(field, lines, ends_of(shape), colour, mesh);
  append(mesh, bob);
  mesh.surface = SurfaceKind::hair;
  return mesh;
}

}  // namespace animeme::head::detail

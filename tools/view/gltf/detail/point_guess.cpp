#include "tools/view/gltf/detail/point_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "fap/tables.h"
#include "tools/view/gltf/detail/midline.h"
#include "tools/view/gltf/detail/slit.h"

namespace animeme::gltf {
namespace {

using head::Part;
using head::PiecePoint;
using head::Vec3;

bool is_eye(std::optional<Part> part) { return part == Part::left_eye || part == Part::right_eye; }
bool is_brow(std::optional<Part> part) { return part == Part::brows; }

// FAPs of what moves: see the table in the header.
constexpr int kJaw = 3, kBlink[] = {19, 20}, kBrowIn[] = {31, 32}, kBrowOut[] = {35, 36};

// How far shapes of one side tell left from right.
struct Sides {
  std::optional<Vec3> left;
  std::optional<Vec3> right;
};

Sides sides_of(const SkinShapes& guess) {
  for (const auto& faps : {kBlink, kBrowOut}) {
    const std::size_t left = guess.shape_for(faps[0], 40), right = guess.shape_for(faps[1], 40);
    if (left == kNone || right == kNone || left == right) continue;
    return {guess.centre(left), guess.centre(right)};
  }
  return {};
}

int largest(Vec3 v, int except = -1) {
  const std::array<float, 3> size = {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
  int best = except == 0 ? 1 : 0;
  for (int i = 0; i < 3; ++i) {
    if (i != except && size[std::size_t(i)] > size[std::size_t(best)]) best = i;
  }
  return best;
}

Vec3 unit(int axis, float sign) {
  return {axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
}

float part(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// The face as it looks from the front, with what it needs to find points.
class FaceMap {
 public:
  explicit FaceMap(const SkinShapes& guess) : guess_(guess) {}

  std::vector<PiecePoint> points() {
    add_lids();
    add_eyes();
    add_brows_and_cheeks();
    add_mouth();
    std::vector<PiecePoint> out;
    for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
      const auto found = std::find_if(spots_.begin(), spots_.end(),
                                      [&](const auto& entry) { return entry.first == info.id; });
      if (found == spots_.end()) continue;
      out.push_back({std::string(info.id), found->second.piece, found->second.vertex});
    }
    return out;
  }

 private:
  void set(std::string_view id, Spot spot) {
    if (spot.exists()) spots_.emplace_back(id, spot);
  }
  Spot at(std::string_view id) const {
    for (const auto& [known, spot] : spots_) {
      if (known == id) return spot;
    }
    return {};
  }
  Vec3 place(Spot spot) const { return guess_.place(spot); }

  void add_lids() {
    const Sides sides = sides_of(guess_);
    if (sides.left && sides.right) middle_ = (sides.left->x + sides.right->x) / 2;
    for (int side = 0; side < 2; ++side) {
      std::size_t shape = guess_.shape_for(kBlink[side], 300);
      const auto lid_of = [&](std::size_t blink) {
        return guess_.farthest(blink,
                               [&](Vec3 p, Vec3 d) { return on_side(p, side) ? -d.y : 0.0f; });
      };
      Spot upper = lid_of(shape);
      if (!upper.exists()) {  // a mirrored file
        shape = guess_.shape_for(kBlink[1 - side], 300);
        upper = lid_of(shape);
      }
      if (!upper.exists()) continue;
      const auto moves = guess_.field(shape);
      const Vec3 from = place(upper);
      const Vec3 down = moves[upper.piece][upper.vertex];
      const float most = -down.y;
      const Spot lower = guess_.nearest(from + down, [&](Spot spot) {
        return -moves[spot.piece][spot.vertex].y < 0.3f * most && place(spot).y < from.y;
      });
      set(side == 0 ? "3.1" : "3.2", upper);
      set(side == 0 ? "3.3" : "3.4", lower);
    }
    if (at("3.1").exists() && at("3.2").exists()) {
      const Vec3 left = place(at("3.1")), right = place(at("3.2"));
      middle_ = (left.x + right.x) / 2;
      between_ = left.x - right.x;
      eye_height_ = (left.y + right.y) / 2;
    } else {
      measure_eyeballs();
    }
  }

  // A head that cannot blink may have eyeballs.
  void measure_eyeballs() {
    constexpr float kLidAbove = 0.08f;  // of an eyeball's middle, of the distance of the eyes
    std::vector<Vec3> places;
    for (const RawPiece& piece : guess_.face().pieces) {
      if (is_eye(part_of(piece))) {
        places.insert(places.end(), piece.positions.begin(), piece.positions.end());
      }
    }
    if (places.empty()) return;
    const auto [right, left] = std::ranges::minmax(places, {}, &Vec3::x);
    const float middle = (left.x + right.x) / 2;
    std::array<Vec3, 2> sums;
    std::array<float, 2> counts = {};
    for (const Vec3& p : places) {
      sums[p.x > middle ? 0 : 1] += p;
      counts[p.x > middle ? 0 : 1] += 1;
    }
    if (counts[0] == 0 || counts[1] == 0) return;
    const Vec3 eyes[] = {sums[0] * (1 / counts[0]), sums[1] * (1 / counts[1])};
    middle_ = (eyes[0].x + eyes[1].x) / 2;
    between_ = eyes[0].x - eyes[1].x;
    eye_height_ = (eyes[0].y + eyes[1].y) / 2 + kLidAbove * between_;
  }

  bool on_side(Vec3 p, int side) const { return side == 0 ? p.x > middle_ : p.x < middle_; }

  // The best vertex of one side of the pieces that are a part.
  Spot of_parts(bool (*wanted)(std::optional<Part>), int side,
                const std::function<float(Vec3)>& measure) const {
    Spot found;
    float most = -std::numeric_limits<float>::infinity();
    const auto& pieces = guess_.face().pieces;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (!wanted(part_of(pieces[p]))) continue;
      for (std::uint32_t v = 0; v < pieces[p].positions.size(); ++v) {
        const Vec3 place = pieces[p].positions[v];
        if (!on_side(place, side) || !(measure(place) > most)) continue;
        most = measure(place);
        found = {p, v};
      }
    }
    return found;
  }

  void add_eyes() {
    if (!(between_ > 0)) return;
    for (int side = 0; side < 2; ++side) {
      const Spot best = of_parts(is_eye, side, [](Vec3 p) { return p.z; });
      set(side == 0 ? "3.5" : "3.6", best);
    }
  }

  // Of what a shape moves nearly farthest, what is nearest to the midline.
  Spot innermost(std::size_t shape, const std::function<float(Vec3, Vec3)>& measure) const {
    const Spot most = guess_.farthest(shape, measure);
    if (!most.exists()) return most;
    const auto moves = guess_.field(shape);
    const float enough = 0.8f * measure(place(most), moves[most.piece][most.vertex]);
    return guess_.farthest(shape, [&](Vec3 p, Vec3 d) {
      return measure(p, d) >= enough ? 1 / (1 + std::abs(p.x - middle_) / between_) : 0.0f;
    });
  }

  void add_brows_and_cheeks() {
    if (!(between_ > 0)) return;
    for (int side = 0; side < 2; ++side) {
      const auto up = [&](Vec3 p, Vec3 d) { return on_side(p, side) ? d.y : 0.0f; };
      const auto out = [&](Vec3 p, Vec3 d) {
        return on_side(p, side) ? (side == 0 ? d.x : -d.x) : 0.0f;
      };
      const auto sideways = [&](Vec3 p) { return side == 0 ? p.x : -p.x; };
      const Spot hairs = of_parts(is_brow, side, [&](Vec3 p) { return -sideways(p); });
      if (hairs.exists()) {
        set(side == 0 ? "4.1" : "4.2", hairs);
        const Spot outer = of_parts(is_brow, side, sideways);
        set(side == 0 ? "4.5" : "4.6", outer);
        // The top between them: at the nose single hairs may stand up.
        const float near = place(hairs).x, far = place(outer).x;
        set(side == 0 ? "4.3" : "4.4", of_parts(is_brow, side, [&](Vec3 p) {
              const bool between = std::abs(p.x - (near + far) / 2) < 0.05f * std::abs(far - near);
              return between ? p.y : -std::numeric_limits<float>::infinity();
            }));
      }
      set(side == 0 ? "5.1" : "5.2", guess_.farthest(guess_.shape_named("cheekPuff"), out));
      if (hairs.exists()) continue;
      const Spot inner = innermost(guess_.shape_for(kBrowIn[side], 40), up);
      const Spot outer = guess_.farthest(guess_.shape_for(kBrowOut[side], 40), up);
      set(side == 0 ? "4.1" : "4.2", inner);
      set(side == 0 ? "4.5" : "4.6", outer);
      if (!inner.exists() || !outer.exists()) continue;
      set(side == 0 ? "4.3" : "4.4",
          guess_.nearest((place(inner) + place(outer)) * 0.5f, [](Spot) { return true; }));
    }
  }

  void add_mouth() {
    if (!(between_ > 0)) return;
    const std::size_t jaw = guess_.shape_for(kJaw, 150);
    if (jaw == kNone) return;
    const Midline midline(guess_, middle_, between_, eye_height_);
    const auto moves = guess_.field(jaw);
    const auto down = [&](Spot spot) { return -moves[spot.piece][spot.vertex].y; };
    float most = 0;
    for (const Spot spot : midline.spots()) most = std::max(most, down(spot));
    if (!(most > 0)) return;
    Spot upper, lower;
    for (const Spot spot : midline.spots()) {  // from above
      const float y = place(spot).y;
      if (down(spot) > 0.5f * most && y < eye_height_ - 0.5f * between_) {
        lower = spot;
        break;
      }
      if (down(spot) < 0.3f * most) upper = spot;
    }
    if (upper.exists() && lower.exists()) {
      upper = midline.nearest_middle(upper, [&](Spot spot) { return down(spot) < 0.3f * most; });
      lower = midline.nearest_middle(lower, [&](Spot spot) { return down(spot) > 0.5f * most; });
    }
    if (!upper.exists() || !lower.exists()) return;
    add_lips(Slit(guess_, moves, most, place(lower), between_));
    if (at("2.2").exists()) upper = at("2.2");
    add_nose_and_chin(midline, place(upper), place(lower));
  }

  void add_nose_and_chin(const Midline& midline, Vec3 upper, Vec3 lower) {
    const float high = eye_height_ - 0.25f * between_;
    const Spot tip = midline.best(high, upper.y + 0.1f * between_, [](Vec3 p) { return p.z; });
    set("9.3", tip);
    const Spot chin = midline.best(lower.y - 0.3f * between_, lower.y - 0.75f * between_,
                                   [](Vec3 p) { return p.z; });
    set("2.10", chin);
    if (chin.exists()) {
      // Where the chin has turned to below.
      set("2.1", midline.best(place(chin).y, place(chin).y - 0.6f * between_,
                              [](Vec3 p) { return p.z - p.y; }));
    }
    if (!tip.exists()) return;
    const Vec3 nose = place(tip);
    // Above the border of the lip, where the profile bends, too.
    const Spot base = midline.corner(nose.y, upper.y + 0.4f * (nose.y - upper.y));
    set("9.15", base);
    if (!base.exists()) return;
    const float mns = place(base).y - upper.y;
    set("8.1", midline.at_height(upper.y + 0.40f * mns));
    set("8.2", midline.at_height(lower.y - 0.46f * mns));
  }

  void add_lips(const Slit& slit) {
    const Slit::Pair middle = slit.contact(middle_);
    set("2.2", middle.upper);
    set("2.3", middle.lower);
    for (int side = 0; side < 2; ++side) {
      const float sign = side == 0 ? 1.0f : -1.0f;
      const Slit::Pair end = slit.end(sign);
      if (!end.exists()) continue;
      set(side == 0 ? "8.3" : "8.4", end.upper);
      const Vec3 corner = place(end.upper) - Vec3{0.05f * between_ * sign, 0, 0};
      set(side == 0 ? "2.4" : "2.5", slit.nearest(corner).upper);
      const Slit::Pair half = slit.contact((corner.x + middle_) / 2);
      set(side == 0 ? "2.6" : "2.7", half.upper);
      set(side == 0 ? "2.8" : "2.9", half.lower);
    }
  }

  const SkinShapes& guess_;
  float middle_ = 0;      // x between the eyes
  float between_ = 0;     // distance of the lids' middles
  float eye_height_ = 0;  // of the upper lids
  std::vector<std::pair<std::string_view, Spot>> spots_;
};

// How far the middle of a face lies before the skin around it, in a direction.
float front_of(const SkinShapes& guess, Vec3 middle, Vec3 forward, float between) {
  float sum = 0;
  std::size_t count = 0;
  guess.for_skin([&](Spot spot) {
    const Vec3 d = guess.place(spot) - middle;
    const float along = head::dot(d, forward);
    if (head::length(d - forward * along) > between) return;
    sum += along;
    ++count;
  });
  return count > 0 ? -sum / float(count) : 0;
}

// How much what moves with the jaw and the lids looks in a direction, -1 to 1: skin shows its
// outside, whatever hangs around the face.
float facing_of(const SkinShapes& guess, std::size_t jaw, Vec3 forward) {
  float along = 0, all = 0;
  for (const std::size_t shape :
       {jaw, guess.shape_for(kBlink[0], 300), guess.shape_for(kBlink[1], 300)}) {
    if (shape == kNone) continue;
    const auto moves = guess.field(shape);
    const std::vector<RawPiece>& pieces = guess.face().pieces;
    for (std::size_t p = 0; p < pieces.size() && p < moves.size(); ++p) {
      const std::vector<Vec3>& places = pieces[p].positions;
      for (const head::Triangle& t : pieces[p].triangles) {
        const bool moved = std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
          return v < moves[p].size() && head::length(moves[p][v]) > 0;
        });
        if (!moved) continue;
        const Vec3 normal = head::cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
        along += head::dot(normal, forward);
        all += head::length(normal);
      }
    }
  }
  return all > 0 ? along / all : 0;
}

}  // namespace

std::optional<std::array<Vec3, 3>> axes_of(const FaceShapes& face,
                                           const std::array<std::optional<Vec3>, 2>& eyes) {
  const SkinShapes guess(face);
  Sides sides = sides_of(guess);
  const bool by_shapes = sides.left && sides.right;
  if (!by_shapes) sides = {eyes[0], eyes[1]};
  const std::size_t jaw = guess.shape_for(kJaw, 150);
  if (!sides.left || !sides.right || jaw == kNone) return std::nullopt;
  const std::optional<Vec3> mouth = guess.centre(jaw);
  if (!mouth) return std::nullopt;
  const Vec3 left = *sides.left - *sides.right;
  const Vec3 up = (*sides.left + *sides.right) * 0.5f - *mouth;
  const int x = largest(left), y = largest(up, x);
  if (part(left, x) == 0 || part(up, y) == 0) return std::nullopt;
  Vec3 to_left = unit(x, part(left, x) > 0 ? 1.0f : -1.0f);
  const Vec3 to_top = unit(y, part(up, y) > 0 ? 1.0f : -1.0f);
  const Vec3 face_middle = ((*sides.left + *sides.right) * 0.5f + *mouth) * 0.5f;
  // In a mirrored file what is called left is on the right; the face still is where it is.
  // (Eyeballs are too deep in the head to tell.)
  // Heads from files have 0.29 to 0.51 here; how far the face is before other skin tells less.
  constexpr float kClearly = 0.1f;  // of the distance of the eyes, or of all that faces
  const Vec3 forward = head::cross(to_left, to_top);
  const float front = front_of(guess, face_middle, forward, head::length(left));
  const float facing = facing_of(guess, jaw, forward);
  const bool shows_back =
      std::abs(facing) > kClearly ? facing < 0 : front < -kClearly * head::length(left);
  if (by_shapes && shows_back) to_left = to_left * -1.0f;
  return std::array<Vec3, 3>{to_left, to_top, head::cross(to_left, to_top)};
}

std::vector<PiecePoint> guess_points(const FaceShapes& face) {
  const SkinShapes guess(face);
  return FaceMap(guess).points();
}

}  // namespace animeme::gltf

#include "tools/view/gltf/detail/face_shapes.h"

#include <cmath>
#include <limits>

#include "fap/arkit.h"

namespace animeme::gltf {

using head::Vec3;

SkinShapes::SkinShapes(const FaceShapes& face) : face_(face) {
  for (const RawPiece& piece : face.pieces) skin_.push_back(part_of(piece) == head::Part::skin);
}

std::size_t SkinShapes::shape_for(int fap, int least) const {
  std::size_t best = kNone;
  int most = least - 1;
  for (std::size_t i = 0; i < face_.shapes.size(); ++i) {
    const int value = face_.shapes[i].meaning.faps.value[std::size_t(fap)];
    // A shape of ARKit is nearer to one motion than a viseme.
    const bool better =
        value > most || (value == most && face_.shapes[i].meaning.set == ShapeSet::arkit);
    if (!better) continue;
    best = i;
    most = value;
  }
  return best;
}

std::size_t SkinShapes::shape_named(std::string_view arkit) const {
  for (std::size_t i = 0; i < face_.shapes.size(); ++i) {
    const auto& parts = face_.shapes[i].meaning.parts;
    if (parts.size() == 1 && fap::kArkitNames[std::size_t(parts[0].channel)] == arkit) return i;
  }
  return kNone;
}

std::optional<Vec3> SkinShapes::centre(std::size_t shape) const {
  Vec3 sum;
  float total = 0;
  for_moves(shape, [&](Spot spot, Vec3 delta) {
    const float size = head::length(delta);
    sum += place(spot) * size;
    total += size;
  });
  if (!(total > 0) || !std::isfinite(total)) return std::nullopt;
  return sum * (1 / total);
}

std::vector<std::vector<Vec3>> SkinShapes::field(std::size_t shape) const {
  std::vector<std::vector<Vec3>> moves;
  for (const RawPiece& piece : face_.pieces) moves.emplace_back(piece.positions.size());
  for_moves(shape, [&](Spot spot, Vec3 delta) { moves[spot.piece][spot.vertex] += delta; });
  return moves;
}

Spot SkinShapes::farthest(std::size_t shape,
                          const std::function<float(Vec3, Vec3)>& measure) const {
  Spot best;
  float most = 0;
  for_moves(shape, [&](Spot spot, Vec3 delta) {
    const float value = measure(place(spot), delta);
    if (!(value > most)) return;
    most = value;
    best = spot;
  });
  return best;
}

Spot SkinShapes::nearest(Vec3 wanted, const std::function<bool(Spot)>& allowed) const {
  Spot best;
  float least = std::numeric_limits<float>::infinity();
  for_skin([&](Spot spot) {
    const Vec3 d = place(spot) - wanted;
    const float square = head::dot(d, d);
    if (!(square < least) || !allowed(spot)) return;
    least = square;
    best = spot;
  });
  return best;
}

}  // namespace animeme::gltf

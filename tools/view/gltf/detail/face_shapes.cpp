#include "tools/view/gltf/detail/face_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fap/arkit.h"

namespace animeme::gltf {

using head::Vec3;

namespace {

// How far the shapes that have one of two FAPs move each piece.
std::vector<float> moved_by(const std::vector<RawPiece>& pieces,
                            const std::vector<ChosenShape>& shapes,
                            const std::vector<std::size_t>& shape_of_name,
                            std::initializer_list<int> faps) {
  constexpr int kMovesIt = 150;  // FAP units
  std::vector<float> farthest;
  for (const RawPiece& piece : pieces) {
    float most = 0;
    for (const PieceMorph& morph : piece.morphs) {
      const std::size_t shape = shape_of_name[morph.shape];
      if (shape == kNone) continue;
      const fap::Frame& does = shapes[shape].meaning.faps;
      const bool wanted = std::any_of(faps.begin(), faps.end(), [&](int fap) {
        return std::abs(does.value[std::size_t(fap)]) >= kMovesIt;
      });
      if (!wanted) continue;
      for (const Vec3& delta : morph.moves.deltas) most = std::max(most, head::length(delta));
    }
    farthest.push_back(most);
  }
  return farthest;
}

}  // namespace

void mark_faces(std::vector<RawPiece>& pieces, const std::vector<ChosenShape>& shapes,
                const std::vector<std::size_t>& shape_of_name) {
  constexpr float kShare = 1.0f / 3;
  // The jaw and corners of the lips; upper lids.
  const auto mouth = moved_by(pieces, shapes, shape_of_name, {3, 5, 6, 7});
  const auto lids = moved_by(pieces, shapes, shape_of_name, {19, 20});
  if (pieces.empty()) return;
  const float most_mouth = *std::max_element(mouth.begin(), mouth.end());
  const float most_lids = *std::max_element(lids.begin(), lids.end());
  const auto moves_both = [&](std::size_t p) {
    return most_mouth > 0 && most_lids > 0 && mouth[p] >= kShare * most_mouth &&
           lids[p] >= kShare * most_lids;
  };
  bool skin = false, told = false;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const bool is_skin = part_of(pieces[p]) == head::Part::skin;
    skin = skin || is_skin;
    told = told || (is_skin && moves_both(p));
  }
  if (told) return;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    pieces[p].face = moves_both(p);
    skin = skin || pieces[p].face;
  }
  if (skin || !(most_mouth > 0)) return;
  std::size_t best = kNone;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const auto part = part_of(pieces[p]);
    if (part == head::Part::upper_teeth || part == head::Part::lower_teeth ||
        part == head::Part::tongue || !(mouth[p] >= kShare * most_mouth)) {
      continue;
    }
    if (best == kNone || pieces[p].positions.size() > pieces[best].positions.size()) best = p;
  }
  if (best != kNone) pieces[best].face = true;
}

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

// What the shapes of a head do to its skin: the questions that estimates of points ask.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "fap/head/own_head.h"
#include "tools/view/gltf/detail/primitive.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {

inline constexpr std::size_t kNone = ~std::size_t(0);

/// The shapes of a head over its pieces.
struct FaceShapes {
  const std::vector<RawPiece>& pieces;
  const std::vector<ChosenShape>& shapes;
  /// For each morph name of the file the index of its shape, kNone: none.
  const std::vector<std::size_t>& shape_of_name;
};

/// A vertex of a piece.
struct Spot {
  std::size_t piece = kNone;
  std::uint32_t vertex = 0;

  bool exists() const { return piece != kNone; }
  friend bool operator==(const Spot&, const Spot&) = default;
};

inline std::optional<head::Part> part_of(const RawPiece& piece) {
  if (piece.face) return head::Part::skin;
  return head::part_by_name(piece.name, piece.paint->name);
}

/// If no piece that is skin by its name has shapes that move lips and lids, marks those that have
/// (RawPiece::face), whatever they are called: both at least a third as far as any piece. If no
/// piece is skin by its name or so, it is what the mouth's shapes move and no name of teeth or
/// tongue is on.
void mark_faces(std::vector<RawPiece>& pieces, const std::vector<ChosenShape>& shapes,
                const std::vector<std::size_t>& shape_of_name);

/// Looks at the pieces that are skin. A shape is given by its index; kNone moves nothing.
class SkinShapes {
 public:
  explicit SkinShapes(const FaceShapes& face);

  const FaceShapes& face() const { return face_; }
  head::Vec3 place(Spot spot) const { return face_.pieces[spot.piece].positions[spot.vertex]; }

  /// The shape with the largest value of a FAP; kNone if none reaches `least`.
  std::size_t shape_for(int fap, int least) const;
  /// That of a name of ARKit alone.
  std::size_t shape_named(std::string_view arkit) const;

  /// Mean place of what a shape moves, by how far. Nothing if it moves nothing.
  std::optional<head::Vec3> centre(std::size_t shape) const;
  /// Moves of a shape by piece and vertex; 0 where there are none.
  std::vector<std::vector<head::Vec3>> field(std::size_t shape) const;
  /// What a shape moves farthest by a measure of place and move, which has to be positive.
  Spot farthest(std::size_t shape,
                const std::function<float(head::Vec3, head::Vec3)>& measure) const;
  Spot nearest(head::Vec3 wanted, const std::function<bool(Spot)>& allowed) const;

  template <class Visit>  // visit(spot, delta)
  void for_moves(std::size_t shape, Visit visit) const {
    for (std::size_t p = 0; p < face_.pieces.size(); ++p) {
      if (!skin_[p] || shape == kNone) continue;
      for (const PieceMorph& morph : face_.pieces[p].morphs) {
        if (face_.shape_of_name[morph.shape] != shape) continue;
        for (std::size_t i = 0; i < morph.moves.vertices.size(); ++i) {
          visit(Spot{p, morph.moves.vertices[i]}, morph.moves.deltas[i]);
        }
      }
    }
  }

  template <class Visit>  // visit(spot)
  void for_skin(Visit visit) const {
    for (std::size_t p = 0; p < face_.pieces.size(); ++p) {
      for (std::uint32_t v = 0; skin_[p] && v < face_.pieces[p].positions.size(); ++v) {
        visit(Spot{p, v});
      }
    }
  }

  template <class Visit>  // visit(corners)
  void for_skin_triangles(Visit visit) const {
    for (std::size_t p = 0; p < face_.pieces.size(); ++p) {
      if (!skin_[p]) continue;
      const std::vector<head::Vec3>& places = face_.pieces[p].positions;
      for (const head::Triangle& t : face_.pieces[p].triangles) {
        visit(std::array{places[t[0]], places[t[1]], places[t[2]]});
      }
    }
  }

 private:
  const FaceShapes& face_;
  std::vector<bool> skin_;
};

}  // namespace animeme::gltf

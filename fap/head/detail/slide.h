// Moves of skin that has something firm below or above it.
#pragma once

#include <vector>

#include "fap/head/model.h"

namespace animeme::head::detail {

/// Turns straight moves of the vertices of a skin into such along it.
class Slide {
 public:
  explicit Slide(const Head& head);

  /// Brows slide on the forehead, which leans back: moved up alone, its skin would stand off.
  void on_bone(std::vector<Vec3>& deltas) const;
  /// Skin that hair covers (Seams::freedom) slides along itself, lest it comes through.
  void below_hair(std::vector<Vec3>& deltas) const;

 private:
  const Head& head_;
  std::vector<Vec3> normals_;
  std::vector<Vec3> broad_normals_;  // without creases
};

}  // namespace animeme::head::detail

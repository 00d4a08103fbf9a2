// Where the lips part.
#pragma once

#include <vector>

#include "tools/view/gltf/detail/face_shapes.h"

namespace animeme::gltf {

/// The vertices of the upper lip next to what an opening jaw takes away from them.
class Slit {
 public:
  struct Pair {
    Spot upper;
    Spot lower;
    float apart = 0;  ///< in the neutral face
    float parts = 0;  ///< by how much the jaw takes the lower from the upper

    bool exists() const { return upper.exists(); }
  };

  /// `jaw`: moves of the skin where the jaw opens, by piece and vertex; `most`: how far down that
  /// takes the chin; `lip`: a place on the mouth; `between`: distance of the eyes, which all
  /// lengths are shares of.
  Slit(const SkinShapes& face, const std::vector<std::vector<head::Vec3>>& jaw, float most,
       head::Vec3 lip, float between);

  /// Its end towards a sign of X.
  Pair end(float sign) const;
  Pair nearest(head::Vec3 place) const;
  /// Where the lips are closest to each other, near an x.
  Pair contact(float x) const;

 private:
  std::vector<Spot> around(head::Vec3 lip) const;
  bool is_lips(const Pair& pair) const;

  const SkinShapes& face_;
  float between_;
  std::vector<Pair> pairs_;  // from above
};

}  // namespace animeme::gltf

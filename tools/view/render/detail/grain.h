// The relief of skin and the fine lines of lips: a small block of numbers that repeats in space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/head/model.h"

namespace animeme::render::detail {

inline constexpr int kGrainSize = 32;           ///< texels a side; a power of two
inline constexpr float kGrainTexel = 0.016f;    ///< cm
inline constexpr float kGrainStrength = 0.09f;  ///< of the shown colour, at most

/// By an extension that g++ and clang++ share.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

/// Two bytes a texel, x fastest: relief, then lines, lit from above; 128 is none. The same bytes on
/// any machine; js/grain.js repeats it.
std::vector<std::uint8_t> grain_block();

/// The block at the sharpness that a picture can show.
class GrainTable {
 public:
  /// `texel`: pixels that one texel takes.
  void set(float texel);

  /// False: it is too fine to be seen.
  bool seen() const { return !values_.empty(); }
  /// Where a place of the head at rest is in the block; not negative. It lies oblique, so that no
  /// surface shows how it repeats.
  head::Vec3 place(const head::Vec3& at_rest) const;
  /// -1..1 at a place; `lines`: those of lips.
  float at(const Float4& p, bool lines) const {
    if (smooth_) return between(p, lines);
    const Int4 i = __builtin_convertvector(p, Int4) & mask_;
    return value(i[0], i[1], i[2], lines);
  }

 private:
  float value(int x, int y, int z, bool lines) const {
    const int texel = (((z << shift_) | y) << shift_) | x;
    return float(values_[std::size_t(2 * texel + int(lines))]) * (1.0f / 128);
  }
  float between(const Float4& p, bool lines) const;

  int level_ = -1 << 20;  // quarters of an octave
  Int4 mask_{};
  int shift_ = 0;
  float scale_ = 1;
  bool smooth_ = false;  // texels are larger than pixels
  std::vector<std::int8_t> values_;
};

}  // namespace animeme::render::detail

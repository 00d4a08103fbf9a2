/// @file
/// A picture that a surface wears: decoded once, with its halves, quarters and so on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/head/vector.h"

namespace animeme::head {

/// A place on a picture: 0..1 from the upper left corner.
struct Uv {
  float u = 0;  ///< to the right
  float v = 0;  ///< down
};

/// Linear RGB and opacity.
struct Colour {
  Vec3 rgb = {1, 1, 1};  ///< light, 0..1
  float alpha = 1;       ///< 0: nothing is there
};

/// What lies beyond the border of a picture.
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// Rows from the top, 4 bytes each: R, G, B, A.
struct Texels {
  int width = 0;                   ///< texels
  int height = 0;                  ///< texels
  std::vector<std::uint8_t> rgba;  ///< width * height * 4
};

/// What the numbers of a picture are: colours (sRGB), or values (normals, roughness).
enum class TexelKind : std::uint8_t { colour, value };

/// A picture with smaller ones of itself. Immutable.
class Picture {
 public:
  /// `texels` has at least one. `file` and `type` ("image/png"): what it was decoded from, for
  /// programs that decode it themselves; may be empty.
  explicit Picture(Texels texels, TexelKind kind = TexelKind::colour,
                   std::vector<std::uint8_t> file = {}, std::string type = {});

  /// At a place; bilinear within the level whose texels are as wide as `footprint` texels of the
  /// picture. Colours are linear, values 0..1.
  Colour at(Uv place, Wrap wrap_u, Wrap wrap_v, double footprint) const;
  /// Between two levels: 0 is the picture, 1 its half and so on. As GPUs do it.
  Colour between(Uv place, Wrap wrap_u, Wrap wrap_v, float level) const;

  /// The largest level whose sides have at most `side` texels, which is 1 or more.
  const Texels& within(int side) const;

  int width() const { return levels_[0].width; }                   ///< texels
  int height() const { return levels_[0].height; }                 ///< texels
  const Texels& texels() const { return levels_[0]; }              ///< as decoded
  TexelKind kind() const { return kind_; }                         ///< see TexelKind
  const std::vector<std::uint8_t>& file() const { return file_; }  ///< see the constructor
  const std::string& type() const { return type_; }                ///< see the constructor

 private:
  Colour sample(std::size_t level, Uv place, Wrap wrap_u, Wrap wrap_v) const;

  TexelKind kind_;
  const float* light_;  // of a byte
  std::vector<Texels> levels_;
  std::vector<std::uint8_t> file_;
  std::string type_;
};

}  // namespace animeme::head

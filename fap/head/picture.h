/// @file
/// A decoded image for textures, with its mipmaps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/head/vector.h"

namespace animeme::head {

/// Texture coordinates: 0..1 from the upper left corner.
struct Uv {
  float u = 0;  ///< to the right
  float v = 0;  ///< down
};

/// Linear RGB and opacity.
struct Colour {
  Vec3 rgb = {1, 1, 1};  ///< 0..1
  float alpha = 1;       ///< 0: transparent
};

/// Continuation beyond the border of an image.
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// Rows from the top, 4 bytes per texel: R, G, B, A.
struct Texels {
  int width = 0;                   ///< texels
  int height = 0;                  ///< texels
  std::vector<std::uint8_t> rgba;  ///< width * height * 4
};

/// Content of an image: colours (sRGB), or values (normals, roughness).
enum class TexelKind : std::uint8_t { colour, value };

/// An image with its mipmaps. Immutable.
class Picture {
 public:
  /// `texels` has at least one. `file` and `type` ("image/png"): the encoded file, for programs
  /// that decode it themselves; may be empty.
  explicit Picture(Texels texels, TexelKind kind = TexelKind::colour,
                   std::vector<std::uint8_t> file = {}, std::string type = {});

  /// Bilinear sample of the mipmap level whose texels are as wide as `footprint` texels of the
  /// image. Colours are linear, values 0..1.
  Colour at(Uv place, Wrap wrap_u, Wrap wrap_v, double footprint) const;
  /// Trilinear sample between two levels: 0 is the image, 1 its half and so on. As on GPUs.
  Colour between(Uv place, Wrap wrap_u, Wrap wrap_v, float level) const;

  /// The largest level whose sides have at most `side` texels; `side` is at least 1.
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

/// @file
/// What is behind a head in pictures and videos.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/view/render/image.h"

namespace animeme::studio {

/// A background as the user names it.
struct Background {
  /// What is behind the head.
  enum class Kind : std::uint8_t {
    usual,    ///< the grey of this program, lighter at the top
    colour,   ///< `colour`
    none,     ///< transparent
    picture,  ///< the file `path`
  };
  Kind kind = Kind::usual;   ///< which of them
  std::uint32_t colour = 0;  ///< 0xRRGGBB (sRGB)
  std::string path;          ///< PNG, JPEG or WebP

  friend bool operator==(const Background&, const Background&) = default;
};

/// Reads "none", "#RRGGBB", "#RGB", a colour by its name in CSS (16 basic ones, orange and green
/// screens: "green" is CSS's, "lime" is #00FF00), or the name of a picture, which ends in .png,
/// .jpg, .jpeg or .webp and is not opened here. Errors: invalid_argument.
Result<Background> parse_background(std::string_view text);

/// The picture of a background of that kind, scaled and cut to width x height pixels; nullptr for
/// the other kinds. Errors: those of reading the file and of media::covering_picture(), with the
/// path.
Result<std::shared_ptr<const render::Image>> picture_behind(const Background& background, int width,
                                                            int height);

}  // namespace animeme::studio

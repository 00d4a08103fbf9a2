/// @file
/// Captions in the pictures of a video, with the word that is said in another colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dam/script/captions.h"
#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/media/picture.h"

namespace animeme::studio {

/// Draws the captions of a script (dam/script/captions.h). The width of a line and the size of the
/// letters follow the picture: 42 columns in wide pictures, 32 in square ones, 22 in upright ones.
/// Lines with letters that are written from right to left are of one colour. Movable, not copyable.
class CaptionPainter {
 public:
  /// `width` and `height`: pixels of the part of the picture that the captions lie in, at its lower
  /// edge.
  CaptionPainter(const dam::Script& script, int width, int height);

  /// Whether there is anything to show.
  bool empty() const { return captions_.empty(); }

  /// Draws what is said at `seconds` over a picture (R, G, B, A not multiplied) of `width` pixels
  /// and at least `height` rows. Text depends on the fonts of the machine. Errors: those of
  /// media::svg_to_overlay().
  Result<void> draw(double seconds, std::vector<std::uint8_t>& rgba);

 private:
  struct Shown {
    std::size_t caption = 0;
    std::size_t word = 0;  // of its words, from 1; 0: none is said
    friend bool operator==(const Shown&, const Shown&) = default;
  };
  std::optional<Shown> shown_at(double seconds) const;
  std::string drawing_of(const Shown& shown) const;

  int width_;
  int height_;
  double letter_;  // size of the font, pixels
  std::vector<dam::Caption> captions_;
  std::optional<Shown> drawn_;  // what overlay_ shows
  media::Pixels overlay_;
};

}  // namespace animeme::studio

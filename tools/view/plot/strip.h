/// @file
/// The strip below a rendered face: curves, phones and a time cursor.
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::plot {

/// Contents of the strip.
struct StripOptions {
  int width = 640;                      ///< pixels
  int height = 128;                     ///< pixels
  std::vector<int> faps;                ///< one colour each, three at most; may be empty
  const dam::Script* script = nullptr;  ///< nullptr: no phones
  double page = 6;                      ///< seconds in view, > 0; then the next page
};

/// Draws strips page by page. Movable, not copyable.
class Strip {
 public:
  /// `clip` is filled; it and the script are borrowed.
  Strip(const fap::Sequence& clip, const StripOptions& options);

  /// Draws the strip at `seconds` over the lowest rows of a picture of options.width x `height`
  /// pixels (RGBA). Errors: those of media::svg_to_rgba().
  Result<void> draw(double seconds, int height, std::vector<std::uint8_t>& rgba);

 private:
  std::string page_svg(double begin) const;

  const fap::Sequence& clip_;
  StripOptions options_;
  std::vector<double> scales_;  // largest amount of each curve
  double begin_ = -1;           // of the page that is drawn
  std::vector<std::uint8_t> page_;
};

}  // namespace animeme::plot

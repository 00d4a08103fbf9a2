/// @file
/// Animated GIF files, as chats, slides and bug trackers show them.
///
///     Gif gif(320, 320);
///     for (...) gif.push(image.rgba, milliseconds);
///     auto file = gif.finish(end);
///
/// Each picture holds only the rectangle that changes, with a palette of its own; a pixel that
/// differs from what is shown by no more than a few steps stays, so that a still background costs
/// nothing and does not flicker. Source: CompuServe, "Graphics Interchange Format, version 89a",
/// 1990.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/result.h"

namespace animeme::studio {

/// In an endless loop. Movable, copyable; the file so far stays in memory.
class Gif {
 public:
  /// Sides 1..16383, checked by push(). `quality` 1..100: the number of colours (32 to 255 a
  /// picture) and how far a pixel may be off before it is coded again.
  Gif(int width, int height, int quality = 80);

  /// Adds the picture shown from `milliseconds`; times ascend. A picture that would be shown for
  /// less than 0.02 s, which players would stretch to 0.1 s, takes the place of the one before.
  /// Alpha is ignored. Errors: invalid_argument (size).
  Result<void> push(std::span<const std::uint8_t> rgba, int milliseconds);
  /// Returns the file; the last picture lasts until `milliseconds`. Error: invalid_argument (there
  /// was no picture).
  Result<std::vector<std::uint8_t>> finish(int milliseconds);

 private:
  void write_pending(int until);
  void begin_file();

  int width_, height_, colours_, tolerance_;
  std::vector<std::uint8_t> file_;
  std::vector<std::uint8_t> shown_;    // R G B of what a player shows
  std::vector<std::uint8_t> pending_;  // the picture that came last, R G B A
  int pending_time_ = 0;               // hundredths of a second
  std::size_t delay_at_ = 0;           // in file_, of the last picture written
  int delay_ = 0;                      // of it, hundredths
};

}  // namespace animeme::studio

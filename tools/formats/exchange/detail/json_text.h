// What the JSON files of this folder have in common. They are put together from text, so that a
// frame is a line and numbers have as many decimals as they are worth.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/rate.h"

namespace animeme::exchange {

/// A number with `digits` decimals; 0 has no sign.
std::string decimals(double value, int digits);

/// A string in quotes; bytes that are no UTF-8 become U+FFFD.
std::string json_text(std::string_view text);

/// The start of a track up to its names: format, version, fps, rate and audio (null if empty).
std::string track_head(std::string_view format, const fap::Rate& rate, std::string_view audio);

/// The end of a track: its frames, each an array of numbers.
template <class Frame>
std::string track_frames(const std::vector<Frame>& frames, int digits) {
  std::string text = ",\n \"frames\": [";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    text += i == 0 ? "\n  " : ",\n  ";
    char separator = '[';
    for (const double value : frames[i]) {
      text += separator;
      if (separator == ',') text += ' ';
      text += decimals(value, digits);
      separator = ',';
    }
    text += "]";
  }
  return text + "\n]}\n";
}

}  // namespace animeme::exchange

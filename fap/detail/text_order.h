// Brings the frames of a text into order. Internal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fap/detail/text_notes.h"
#include "fap/result.h"

namespace animeme::fap::detail {

/// Frame numbers lie within +-this, so that sums of them stay exact and far inside 64 bits.
inline constexpr std::int64_t kLargestNumber = 1'000'000'000'000'000;

template <class Frame>
bool all_numbers_equal(const std::vector<Frame>& frames) {
  for (const Frame& frame : frames) {
    if (frame.number != frames.front().number) return false;
  }
  return frames.size() > 1;
}

/// Makes the frame numbers ascend strictly by the rules of text.h. `lines` has the line of each
/// frame number; merge(into, later) is called for frames of the same number.
template <class Frame, class Merge>
std::optional<Error> order_frames(std::vector<Frame>& frames,
                                  const std::vector<std::int64_t>& lines, bool keep_numbers,
                                  TextNotes& notes, Merge merge) {
  if (frames.empty()) return std::nullopt;
  if (all_numbers_equal(frames)) {
    notes.add(Quirk::constant_number, lines.front(),
              [] { return "all frames have the same number, they are numbered in their order"; });
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].number = std::int64_t(i);
    return std::nullopt;
  }
  std::int64_t shift = 0;
  if (!keep_numbers && frames.front().number != 0) {
    shift = -frames.front().number;
    notes.add(Quirk::first_number, lines.front(), [&] {
      return "the frame numbers start at " + std::to_string(-shift) + ", they are shifted to 0";
    });
  }
  std::size_t kept = 0;
  std::int64_t previous = frames.front().number;
  frames.front().number += shift;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::int64_t number = frames[i].number;
    if (number == previous) {
      notes.add(Quirk::repeated_number, lines[i], [&] {
        return "frame number " + std::to_string(number) + " comes again, the frames are merged";
      });
      merge(frames[kept], frames[i]);
      continue;
    }
    if (number < previous) {
      shift = frames[kept].number + 1 - number;
      notes.add(Quirk::restarted_number, lines[i], [&] {
        return "frame number " + std::to_string(number) + " comes after " +
               std::to_string(previous) + ", the numbering goes on behind it";
      });
    }
    previous = number;
    const std::int64_t shifted = number + shift;
    if (shifted > 4 * kLargestNumber) {
      return error_at_line(Code::out_of_range, "the frame numbers run beyond 10^15", lines[i]);
    }
    frames[++kept] = frames[i];
    frames[kept].number = shifted;
  }
  frames.resize(kept + 1);
  return std::nullopt;
}

}  // namespace animeme::fap::detail

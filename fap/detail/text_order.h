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

/// Makes frame numbers ascend strictly by the rules of text.h, one after the other. A text whose
/// numbers are all equal has to be known as such.
class FrameOrder {
 public:
  FrameOrder(bool keep_numbers, bool all_equal)
      : keep_numbers_(keep_numbers), all_equal_(all_equal) {}

  /// The number of the next frame, whose own is `number`, at `line` of the text. nullopt: the frame
  /// is to be merged into the one before. Error: out_of_range.
  Result<std::optional<std::int64_t>> take(std::int64_t number, std::int64_t line,
                                           TextNotes& notes) {
    if (all_equal_) {
      if (last_ < 0) {
        notes.add(Quirk::constant_number, line, [] {
          return "all frames have the same number, they are numbered in their order";
        });
      }
      return std::optional(++last_);
    }
    if (!begun_) {
      if (!keep_numbers_ && number != 0) {
        shift_ = -number;
        notes.add(Quirk::first_number, line, [&] {
          return "the frame numbers start at " + std::to_string(number) + ", they are shifted to 0";
        });
      }
    } else if (number == previous_) {
      notes.add(Quirk::repeated_number, line, [&] {
        return "frame number " + std::to_string(number) + " comes again, the frames are merged";
      });
      return std::optional<std::int64_t>();
    } else if (number < previous_) {
      shift_ = last_ + 1 - number;
      notes.add(Quirk::restarted_number, line, [&] {
        return "frame number " + std::to_string(number) + " comes after " +
               std::to_string(previous_) + ", the numbering goes on behind it";
      });
    }
    const std::int64_t shifted = number + shift_;
    if (begun_ && shifted > 4 * kLargestNumber) {
      return error_at_line(Code::out_of_range, "the frame numbers run beyond 10^15", line);
    }
    begun_ = true;
    previous_ = number;
    last_ = shifted;
    return std::optional(shifted);
  }

 private:
  bool keep_numbers_;
  bool all_equal_;
  bool begun_ = false;
  std::int64_t shift_ = 0;
  std::int64_t previous_ = 0;  // as the text has it
  std::int64_t last_ = -1;     // as it was given
};

template <class Frame>
bool all_numbers_equal(const std::vector<Frame>& frames) {
  for (const Frame& frame : frames) {
    if (frame.number != frames.front().number) return false;
  }
  return frames.size() > 1;
}

/// The same for all frames of a text. `lines` has the line of each frame number; merge(into, later)
/// is called for frames of the same number.
template <class Frame, class Merge>
std::optional<Error> order_frames(std::vector<Frame>& frames,
                                  const std::vector<std::int64_t>& lines, bool keep_numbers,
                                  TextNotes& notes, Merge merge) {
  FrameOrder order(keep_numbers, all_numbers_equal(frames));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto number = order.take(frames[i].number, lines[i], notes);
    if (!number) return number.error();
    if (!*number) {
      merge(frames[kept - 1], frames[i]);
      continue;
    }
    if (kept != i) frames[kept] = frames[i];
    frames[kept++].number = **number;
  }
  frames.resize(kept);
  return std::nullopt;
}

}  // namespace animeme::fap::detail

/// @file
/// What a line of input asks for: text to speak, a piece of sound, or a command among them.
///
///     {"do": "stop"}                                          be silent now, forget what waits
///     {"do": "drop"}                                          forget what waits
///     {"do": "say", "text": "Yes?", "when": "now", "id": "7"} stop, then say this
///     {"do": "mark", "id": "half"}                            tell when all before it is spoken
///     {"do": "end"}                                           end when all is spoken
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "fap/result.h"

namespace animeme::speech {

/// One line of input.
struct LineCommand {
  /// What it asks for.
  enum class Do : std::uint8_t { say, stop, drop, mark, end };
  /// When something is said.
  enum class When : std::uint8_t {
    now,   ///< instead of all that is spoken and waits
    next,  ///< before what waits
    last,  ///< after it
  };
  Do what = Do::say;       ///< what
  When when = When::last;  ///< say: when
  std::string id;          ///< say, mark: as given; empty: none
  std::string text;        ///< say: the words, as far as they are known
  std::string payload;     ///< say: for LineMaker::make
};

/// Bytes of the longest command among lines of text.
inline constexpr std::size_t kMostCommand = std::size_t(1) << 20;

/// A line, without blanks around it. A JSON object with a member "do" is a command; any other line
/// is said. `json`: lines are pieces (pieces.h), whose "id" and "text" are taken over; a piece with
/// "do": "say" is one with a place in the queue. Where lines are text, one that begins with { and
/// is no command stays text, unless it is broken JSON with a "do" in it, which nobody wants to
/// hear. Errors: syntax (broken JSON, a member of another kind), not_found (another "do" or
/// "when"), invalid_argument (nothing to say).
Result<LineCommand> read_line(std::string line, bool json);

}  // namespace animeme::speech

/// @file
/// A parsed line of input: text to speak, a piece of sound, or a command.
///
///     {"do": "stop"}                                          stop speaking, clear the queue
///     {"do": "drop"}                                          clear the queue
///     {"do": "say", "text": "Yes?", "when": "now", "id": "7"} stop, then say this
///     {"do": "pause"}, "resume"                               speech halts, and goes on there
///     {"do": "mark", "id": "half"}                            report when this is reached
///     {"do": "mood", "mood": "joy:0.6"}                       the mood from now on
///     {"do": "look", "target": "20,-5"}                       where the eyes look (dam/behaviour)
///     {"do": "listen"}, "think", "idle"                       what the face does between lines
///     {"do": "hear", "voice": true}                           the other speaks; false: it pauses
///     {"do": "end"}                                           end when everything is spoken
///     {"text": "Yes?"}                                        among lines of text: as "do": "say"
///
/// Lines to say may have a "lang" ("de", "en-gb+f3") in place of that of the head, and a "mood" of
/// their own: "joy", "joy:0.6" or {"name": "joy", "intensity": 0.6}; names are those of
/// dam::read_mood().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dam/behaviour/behaviour.h"
#include "dam/script/mood.h"
#include "fap/result.h"

namespace animeme::speech {

/// One line of input.
struct LineCommand {
  /// Kind of the line.
  enum class Do : std::uint8_t {
    say,
    stop,
    drop,
    mark,
    end,
    mood,
    look,
    listen,
    think,
    idle,
    hear,
    pause,
    resume
  };
  /// Position in the queue.
  enum class When : std::uint8_t {
    now,   ///< replaces current speech and the queue
    next,  ///< at the front of the queue
    last,  ///< at the end of the queue
  };
  Do what = Do::say;       ///< kind
  When when = When::last;  ///< say: position
  std::string id;          ///< say, mark: as given; empty: none
  std::string text;        ///< say: the words, if known
  std::string payload;     ///< say: input of LineMaker::make
  std::string language;    ///< say: of the text; empty: that of the head
  /// say: of the line, nullopt: that of the head; mood: given
  std::optional<dam::Mood> mood;
  dam::Look target;    ///< look: the target
  bool voice = false;  ///< hear: the other party speaks
};

/// Maximum size of a command among lines of text, bytes.
inline constexpr std::size_t kMostCommand = std::size_t(1) << 20;

/// Parses a line without surrounding blanks and without a byte order mark of UTF-8. A JSON object
/// with a member "do" is a command; any other line is spoken. `json`: lines are pieces (pieces.h),
/// whose "id" and "text" are used; a piece with "do": "say" has a position in the queue. If lines
/// are text, an object with a "text" and no "do" is to be said; any other line that begins with {
/// remains text, unless it is broken JSON with a "do" or "text" in it. Errors: syntax (broken JSON,
/// a member of a wrong type), not_found (unknown "do", "when" or mood),
/// invalid_argument (nothing to say, no target, no voice, an intensity out of range; a member that
/// the command does not have, except among pieces, where "say" has those of a piece), those of
/// dam::parse_look().
Result<LineCommand> read_line(std::string line, bool json);

}  // namespace animeme::speech

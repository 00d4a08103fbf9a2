/// @file
/// What is told of lines while they are spoken: for subtitles, turn-taking, logs.
///
///     {"event": "queued", "time": 2.36, "line": 1, "id": "1", "text": "Hello there."}
///     {"event": "started", "time": 2.4, "line": 1, "id": "1", "text": "Hello there."}
///     {"event": "word", "time": 2.5, "line": 1, "id": "1", "word": "Hello", "duration": 0.41}
///     {"event": "phone", "time": 2.5, "line": 1, "id": "1", "phone": "HH", "duration": 0.06}
///     {"event": "done", "time": 3.92, "line": 1, "id": "1"}
///
/// Every line that was queued ends in exactly one `done` or `cancelled`. Times are those of the
/// presentation, in seconds; they never go back from one event to the next.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "dam/script/script.h"
#include "tools/speech/talking/lines.h"

namespace animeme::speech {

/// Something that happened to a line.
struct LineEvent {
  /// What happened.
  enum class What : std::uint8_t {
    queued,     ///< it came
    started,    ///< it begins
    word,       ///< a word of it begins
    phone,      ///< a sound of it begins
    mark,       ///< all before a mark has been spoken, or a mark of SSML in the line
    done,       ///< it has been spoken
    cancelled,  ///< it will not be spoken (to its end)
    stopped,    ///< a command was followed; `cancelled` of what it ended comes behind it
    dropped,    ///< likewise
  };
  What what = What::queued;  ///< what
  double time = 0;           ///< seconds, presentation time
  std::uint64_t line = 0;    ///< SpokenLine::line; 0: of no line
  std::string id;            ///< SpokenLine::id
  std::string text;          ///< queued, started: what is said; word, phone, mark: which;
                             ///< cancelled: the words that had begun, if it was being spoken
  double duration = 0;       ///< word, phone: seconds
  std::string why;           ///< cancelled
};

/// As a line of JSON, without its end.
std::string to_json(const LineEvent& event);

/// Holds events back until their time has come.
class LineEvents {
 public:
  /// Says something at `time`, which must not lie before the last one given to tell().
  void add(LineEvent event);
  /// A line begins: its words and phones, and its end. Times of the line's script count from
  /// `start`.
  void begin(const SpokenLine& line, double start, double end);
  /// Ends all lines before number `before` that have begun and are not over at `time`; marks behind
  /// them, too.
  void cut(double time, std::uint64_t before, const std::string& why);
  /// Gives out what lies at or before `time`.
  void tell(double time);
  /// What has been given out since the last call.
  std::vector<LineEvent> take();

 private:
  struct Begun {
    std::uint64_t line = 0;
    std::string id;
    double end = 0;
    std::vector<std::pair<double, std::string>> words;
  };
  std::deque<LineEvent> waiting_;  // ascending
  std::deque<Begun> begun_;
  std::vector<LineEvent> told_;
};

}  // namespace animeme::speech

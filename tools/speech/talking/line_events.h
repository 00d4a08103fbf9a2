/// @file
/// Events of spoken lines, for subtitles, turn-taking and logs.
///
///     {"event": "queued", "time": 2.36, "line": 1, "id": "1", "text": "Hello there."}
///     {"event": "started", "time": 2.4, "line": 1, "id": "1", "text": "Hello there."}
///     {"event": "word", "time": 2.5, "line": 1, "id": "1", "word": "Hello", "duration": 0.41}
///     {"event": "phone", "time": 2.5, "line": 1, "id": "1", "phone": "HH", "duration": 0.06}
///     {"event": "done", "time": 3.92, "line": 1, "id": "1"}
///
/// Every line that was queued ends in exactly one `done` or `cancelled`. Times are presentation
/// times in seconds, and ascend.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dam/script/script.h"
#include "tools/speech/talking/lines.h"

namespace animeme::speech {

/// An event of a line.
struct LineEvent {
  /// Kind of the event.
  enum class What : std::uint8_t {
    queued,   ///< it was received
    started,  ///< it begins
    word,     ///< a word of it begins
    phone,    ///< a phone of it begins
    mark,     ///< everything before a mark has been spoken, or an SSML mark in the line is reached
    done,     ///< it has been spoken
    cancelled,  ///< it, or its rest, will not be spoken
    stopped,    ///< a command was executed; `cancelled` events of the affected lines follow
    dropped,    ///< the same for "drop"
    paused,     ///< speech halts; what is told of lines until it goes on comes later
    resumed,    ///< it goes on
  };
  What what = What::queued;  ///< kind
  double time = 0;           ///< seconds, presentation time
  std::uint64_t line = 0;    ///< SpokenLine::line; 0: no line
  std::string id;            ///< SpokenLine::id
  std::string text;          ///< queued, started: the text; word, phone, mark: its name;
                             ///< cancelled: the words that had begun, if it was being spoken
  double duration = 0;       ///< word, phone: seconds
  std::string why;           ///< cancelled
};

/// The event as JSON on one line, without a line end.
std::string to_json(const LineEvent& event);

/// Delays events until they are due.
class LineEvents {
 public:
  /// Adds an event, whose time must not be before the last time passed to tell().
  void add(LineEvent event);
  /// Adds the events of a line: its words and phones, and its end. Times of its script count from
  /// `start`.
  void begin(const SpokenLine& line, double start, double end);
  /// Adds a word of a line that has begun and not ended, `start` seconds after its begin, or as
  /// soon as possible.
  void add_word(std::uint64_t line, double start, const std::string& word, double duration);
  /// Cancels all lines before number `before` that have begun and not ended at `time`, and their
  /// marks.
  void cut(double time, std::uint64_t before, const std::string& why);
  /// Adds the end of a text that is spoken in parts, unless it has ended. Its number is that of its
  /// first part.
  void cancel_parts(LineEvent event);
  /// What is to come of lines behind `time` waits until go_on().
  void hold(double time);
  /// It comes, `later` seconds later than it would have.
  void go_on(double later);
  /// Releases events up to and including `time`.
  void tell(double time);
  /// Events released since the last call.
  std::vector<LineEvent> take();

 private:
  struct Begun {
    std::uint64_t line = 0;
    std::string id;
    double start = 0, end = 0;
    std::vector<std::pair<double, std::string>> words;
    bool part = false;
  };
  std::deque<LineEvent> waiting_;  // ascending
  std::deque<Begun> begun_;
  double time_ = 0;                                        // of the last tell()
  double held_ = std::numeric_limits<double>::infinity();  // instant of hold()
  std::vector<LineEvent> told_;
  std::set<std::uint64_t> ended_parts_;  // texts in parts that were cancelled
};

}  // namespace animeme::speech

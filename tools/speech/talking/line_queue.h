/// @file
/// Lines that wait to be spoken, from the reader by way of the voice to the head.
///
/// Three threads may use it: one pushes lines and commands, one makes speech of them, one takes
/// what is made. A command takes effect when it is pushed, whatever the voice is at.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/talking/line_command.h"
#include "tools/speech/talking/lines.h"

namespace animeme::speech {

/// Thread safe.
class LineQueue : public LineSource {
 public:
  /// `most_bytes`, `cut`, `json`: as LineMaker.
  LineQueue(std::size_t most_bytes, bool cut, bool json)
      : most_bytes_(most_bytes), cut_(cut), json_(json) {}

  /// A line of the input, without blanks around it; an empty one is nothing. Errors: those of
  /// read_line(), which are warnings, too (take_warnings()).
  Result<void> push(std::string line, double arrived);
  /// No more lines will come: what waits is spoken, then it is over.
  void close();
  /// As much waits as may: 64 MB or 100000 lines. More can be pushed all the same.
  bool full();
  std::size_t waiting();  ///< lines and marks that take() has not given
  std::size_t bytes();    ///< of these, before the voice made speech of them

  /// A line for the voice.
  struct Job {
    std::uint64_t line = 0;  ///< its number
    std::string payload;     ///< LineCommand::payload
  };
  /// The next line to be made, in the order in which they are going to be spoken. Waits while four
  /// that are made wait before it. Nothing: leave() was called.
  std::optional<Job> next_job();
  /// The same without waiting.
  std::optional<Job> try_job();
  /// Whether a line still waits, so that its speech is wanted.
  bool wanted(std::uint64_t line);
  /// What the voice made of it at instant `spoken`. Thrown away if it is not wanted any more.
  void made(std::uint64_t line, Result<SpokenLine> speech, double spoken);
  /// Ends next_job().
  void leave();

  std::optional<SpokenLine> take(bool only_joining) override;
  std::vector<LineNews> take_news() override;
  bool ended() override;
  void abandon(const std::string& why) override;

  /// One sentence for every line that was left out or is in doubt, since the last call.
  std::vector<std::string> take_warnings();

 private:
  struct Entry {
    std::uint64_t line = 0;
    std::string id, text, payload;
    double arrived = 0;
    bool mark = false;
    std::optional<SpokenLine> speech;  // nothing: not made
  };
  using Entries = std::list<Entry>;

  void say(LineCommand command, double arrived);
  void forget_all(LineNews::What what, const std::string& why, double at);
  Entries::iterator find(std::uint64_t line);
  std::optional<Job> look_for_job();
  void tell(LineNews::What what, const Entry& entry, const std::string& why, double at);

  const std::size_t most_bytes_;
  const bool cut_, json_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  Entries entries_;
  std::size_t bytes_ = 0;  // of payloads
  std::size_t made_ = 0;   // entries with speech
  std::uint64_t number_ = 0;
  std::vector<LineNews> news_;
  std::vector<std::string> warnings_;
  bool closed_ = false, left_ = false;
};

}  // namespace animeme::speech

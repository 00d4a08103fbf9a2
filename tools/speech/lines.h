/// @file
/// Lines that become speech while they arrive: text, or pieces of sound with their times.
///
///     auto maker = voice_lines({});
///     auto lines = VoiceLines::open(STDIN_FILENO, *maker, media::steady_clock());
///     for (;;) for (SpokenLine& line : (*lines)->take()) ...      // never waits
///
/// Reading and the voice run in a thread of their own, so that the clock of a presentation never
/// stands still for them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/media/live/pacer.h"
#include "tools/voice/voice.h"

namespace animeme::speech {

/// A line and what the voice made of it. Instants are those of one media::Clock.
struct SpokenLine {
  std::string text;      ///< as it was typed
  voice::Speech speech;  ///< sound and phones
  double arrived = 0;    ///< when its last character was read
  double spoken = 0;     ///< when the voice was done with it
  /// Its sound follows that of the line before without a gap, if it comes in time; else 0.1 s after
  /// it came, in which the mouth opens. False: it brings silence of its own.
  bool joins = false;
  std::string doubt;  ///< what is not sure about it, a sentence; empty: nothing
};

/// Makes speech of lines as they come.
struct LineMaker {
  /// Called in the thread of the lines. Sets all but the instants. An error leaves the line out.
  std::function<Result<SpokenLine>(std::string line)> make;
  int sample_rate = 22050;        ///< Hz; lines may have others, which are converted
  std::size_t most_bytes = 4000;  ///< of a line
  bool cut = true;                ///< longer ones are cut at a blank; false: they are left out
};

/// Speaks each line. Says something once, so that a voice that is missing is known at once and the
/// first line finds everything warm. Errors: those of voice::speak_text() except a text without
/// words.
Result<LineMaker> voice_lines(const voice::VoiceOptions& options);

/// Where lines come from. To be used from one thread.
class LineSource {
 public:
  virtual ~LineSource() = default;
  /// The lines that were finished since the last call, in their order. Does not wait.
  virtual std::vector<SpokenLine> take() = 0;
  /// True when take() will never return anything again.
  virtual bool ended() = 0;
};

/// Lines from a file descriptor, made into speech in a thread of their own. Empty lines are
/// skipped; a last line without its end counts. While four lines wait to be taken, no more are
/// made, so that a whole book at once needs no more memory.
class VoiceLines : public LineSource {
 public:
  /// `descriptor` is borrowed; the clock must outlive the lines. Errors: io (no thread).
  static Result<std::unique_ptr<VoiceLines>> open(int descriptor, LineMaker maker,
                                                  media::Clock& clock);
  /// Stops reading. A line that is just being made is waited for.
  ~VoiceLines() override;

  std::vector<SpokenLine> take() override;
  bool ended() override;
  /// LineMaker::sample_rate.
  int sample_rate() const { return sample_rate_; }
  /// One sentence for every line that was left out or is in doubt, since the last call.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  VoiceLines(std::unique_ptr<Impl> impl, int sample_rate);
  std::unique_ptr<Impl> impl_;
  int sample_rate_;
};

}  // namespace animeme::speech

/// @file
/// Lines of text that become speech while they arrive.
///
///     auto lines = VoiceLines::open(STDIN_FILENO, {}, media::steady_clock());
///     for (;;) for (SpokenLine& line : (*lines)->take()) ...      // never waits
///
/// Reading and the voice run in a thread of their own, so that the clock of a presentation never
/// stands still for them.
#pragma once

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
};

/// Where lines come from. To be used from one thread.
class LineSource {
 public:
  virtual ~LineSource() = default;
  /// The lines that were finished since the last call, in their order. Does not wait.
  virtual std::vector<SpokenLine> take() = 0;
  /// True when take() will never return anything again.
  virtual bool ended() = 0;
};

/// Text by the line from a file descriptor, spoken by tools/voice. Empty lines are skipped; a last
/// line without its end counts. A line longer than 4000 bytes is cut at a blank. While four lines
/// wait to be taken, no more are spoken, so that a whole book at once needs no more memory.
class VoiceLines : public LineSource {
 public:
  /// Says something once, so that a voice that is missing is known at once and the first line finds
  /// everything warm. `descriptor` is borrowed; the clock must outlive the lines.
  /// Errors: those of voice::speak_text() except a text without words; io (no thread).
  static Result<std::unique_ptr<VoiceLines>> open(int descriptor,
                                                  const voice::VoiceOptions& options,
                                                  media::Clock& clock);
  /// Stops reading. A line that is just being spoken is waited for.
  ~VoiceLines() override;

  std::vector<SpokenLine> take() override;
  bool ended() override;
  /// Sample rate of all lines, Hz.
  int sample_rate() const { return sample_rate_; }
  /// One sentence for every line that could not be spoken, since the last call.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  VoiceLines(std::unique_ptr<Impl> impl, int sample_rate);
  std::unique_ptr<Impl> impl_;
  int sample_rate_;
};

}  // namespace animeme::speech

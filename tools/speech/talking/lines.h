/// @file
/// Lines that become speech while they arrive: text, or pieces of sound with their times.
///
///     auto maker = voice_lines({});
///     auto lines = VoiceLines::open(STDIN_FILENO, *maker, media::steady_clock());
///     for (;;) while (auto line = (*lines)->take(false)) ...      // never waits
///
/// Reading and the voice run in threads of their own, so that the clock of a presentation never
/// stands still for them, and a command (line_command.h) never waits for the voice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/speech/voice/voice.h"

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
  std::string doubt;       ///< what is not sure about it, a sentence; empty: nothing
  std::uint64_t line = 0;  ///< number of the line in the input, from 1; later ones are larger
  std::string id;          ///< the name that it was given, or else its number
  bool mark = false;       ///< nothing to say: a place in the queue, called `id`
};

/// What became of a line that a source does not give out, or is about to give out.
struct LineNews {
  /// What happened.
  enum class What : std::uint8_t {
    queued,     ///< it has come and waits
    cancelled,  ///< it will never be given out: `why`
    stopped,    ///< what is spoken is to end now, with all lines before number `line`
    dropped,  ///< lines before number `line` that were given out and not begun are to be forgotten
  };
  What what = What::queued;  ///< what
  std::uint64_t line = 0;    ///< SpokenLine::line
  std::string id;            ///< SpokenLine::id
  std::string text;          ///< what is to be said
  std::string why;           ///< a few words
  bool mark = false;         ///< it is a mark
  double at = 0;             ///< when, on the clock of the lines
};

/// Asked by who makes speech of a line whether somebody still wants it.
using Wanted = std::function<bool()>;

/// Makes speech of lines as they come.
struct LineMaker {
  /// Called in the thread of the voice. Sets sound, phones, `joins` and `doubt`, and `text` where
  /// only it knows that. An error leaves the line out. May give up where `wanted` says no.
  std::function<Result<SpokenLine>(std::string line, const Wanted& wanted)> make;
  int sample_rate = 22050;        ///< Hz; lines may have others, which are converted
  std::size_t most_bytes = 4000;  ///< of a line
  bool cut = true;                ///< longer ones are cut at a blank; false: they are left out
  bool json = false;              ///< lines are pieces (pieces.h), not text
};

/// Speaks each line. Says something once, so that a voice that is missing is known at once and the
/// first line finds everything warm. Errors: those of voice::speak_text() except a text without
/// words.
Result<LineMaker> voice_lines(const voice::VoiceOptions& options);

/// Where lines come from. To be used from one thread.
class LineSource {
 public:
  virtual ~LineSource() = default;
  /// The next line or mark, if it is ready. Does not wait. `only_joining`: no line that does not
  /// join the one before.
  virtual std::optional<SpokenLine> take(bool only_joining) = 0;
  /// What happened since the last call, in order. Of what take() gives out before, nothing in it is
  /// meant but by its number.
  virtual std::vector<LineNews> take_news() { return {}; }
  /// True when neither will ever return anything again.
  virtual bool ended() = 0;
  /// No more lines are wanted: those that wait are cancelled.
  virtual void abandon(const std::string& why) { (void)why; }
};

class ControlSocket;

/// Lines from a file descriptor, and from a control socket, made into speech in a thread of their
/// own. Empty lines are skipped; a last line without its end counts. While four lines wait to be
/// taken, no more are made; while 64 MB of them wait, no more are read from the descriptor.
class VoiceLines : public LineSource {
 public:
  /// `descriptor` is borrowed; -1: lines come from the control socket alone. The clock and the
  /// socket must outlive the lines. Errors: io (no thread).
  static Result<std::unique_ptr<VoiceLines>> open(int descriptor, LineMaker maker,
                                                  media::Clock& clock,
                                                  ControlSocket* control = nullptr);
  /// Stops reading. A line that is just being made is waited for.
  ~VoiceLines() override;

  std::optional<SpokenLine> take(bool only_joining) override;
  std::vector<LineNews> take_news() override;
  bool ended() override;
  void abandon(const std::string& why) override;
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

/// @file
/// Synthesises lines as they arrive: text, or pieces of sound with timings.
///
///     auto maker = voice_lines({});
///     auto lines = VoiceLines::open(STDIN_FILENO, *maker, media::steady_clock());
///     for (;;) while (auto line = (*lines)->take(false)) ...      // never waits
///
/// Reader and voice run in separate threads, so that they never block the presentation clock, and a
/// command (line_command.h) never waits for the voice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dam/behaviour/behaviour.h"
#include "dam/script/words.h"
#include "fap/result.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {

/// A synthesised line. Instants are those of one media::Clock.
struct SpokenLine {
  std::string text;      ///< as it was typed
  voice::Speech speech;  ///< sound and phones
  dam::Prosody prosody;  ///< of the sound; empty: not known
  double arrived = 0;    ///< when its last character was read
  double spoken = 0;     ///< when synthesis ended
  /// Its sound directly follows that of the previous line if it arrives in time, else it starts 0.1
  /// s after its arrival, while the mouth opens. False: it includes silence.
  bool joins = false;
  std::string doubt;       ///< a sentence about an uncertainty; empty: none
  std::uint64_t line = 0;  ///< number of the line in the input, from 1; later ones are larger
  std::string id;          ///< the given name, or else its number
  bool mark = false;       ///< a mark in the queue without speech, named `id`
  std::optional<dam::Mood> mood;  ///< of the whole line; nullopt: that of the head
  /// Words to report, whose times count as those of the script; nullopt: those of the script.
  std::optional<std::vector<dam::ScriptWord>> words;
  bool goes_on = false;     ///< its first phone is the rest of the last one of the line before
  bool improvable = false;  ///< it may be made better when more is known (pieces.h)
  /// Of a long text that is spoken in parts: number of its first part, whose events all of them
  /// report; 0: it is no part.
  std::uint64_t whole = 0;
  bool first_part = true;  ///< it begins the text
  bool last_part = true;   ///< it ends the text
};

/// News of a line in the queue.
struct LineNews {
  /// Kind of the news.
  enum class What : std::uint8_t {
    queued,     ///< it was received
    cancelled,  ///< it will never be returned: `why`
    stopped,    ///< end current speech and all lines before number `line`
    dropped,    ///< drop lines before number `line` that were returned but have not begun
    mood,       ///< the head has another mood: `mood`
    look,       ///< the eyes look at `target`
    activity,   ///< what the face does between lines: `activity`
    word,       ///< a word of a line that take() has returned became known: `text`, `start`
    hear,       ///< the other party begins or ends to speak: `voice`
    paused,     ///< speech halts, and no line begins
    resumed,    ///< it goes on
  };
  What what = What::queued;                      ///< kind
  std::uint64_t line = 0;                        ///< SpokenLine::line
  std::string id;                                ///< SpokenLine::id
  std::string text;                              ///< the text
  std::string why;                               ///< a few words
  bool mark = false;                             ///< it is a mark
  bool part = false;                             ///< it is a part of a text, named `line`
  dam::Mood mood;                                ///< a mood
  dam::Look target;                              ///< of the eyes
  dam::Activity activity = dam::Activity::idle;  ///< between lines
  bool voice = false;                            ///< of the other party
  double at = 0;                                 ///< instant on the clock of the lines
  double start = 0;     ///< word: seconds from the begin of the line's sound
  double duration = 0;  ///< word: seconds
};

/// Returns whether the speech of a line is still needed.
using Wanted = std::function<bool()>;

class PieceStream;

/// Synthesises lines.
struct LineMaker {
  /// Called in the voice thread. Sets sound, phones, `joins` and `doubt`, and `text` if it alone
  /// knows the text. An error skips the line. May stop early if `wanted` returns false.
  std::function<Result<SpokenLine>(std::string line, const Wanted& wanted)> make;
  /// The same for a line in another language, a code as those of voice::VoiceOptions. Empty: there
  /// is one language.
  std::function<Result<SpokenLine>(std::string line, const std::string& language,
                                   const Wanted& wanted)>
      make_in = nullptr;
  int sample_rate = 22050;        ///< Hz; other rates of lines are converted
  std::size_t most_bytes = 4000;  ///< maximum size of a line
  bool cut = true;                ///< longer lines are cut behind a sentence; false: skipped
  bool json = false;              ///< lines are pieces (pieces.h), not text
  bool one_line = false;          ///< the parts of a longer line are one line, also without a name
  std::shared_ptr<PieceStream> pieces;  ///< makes them, in place of `make`; null: none
};

/// Speaks each line. Synthesises something once, so that a missing voice is detected immediately
/// and the first line is fast. `speak_marks` as of line_to_say() (written_text.h).
/// Errors: those of voice::speak_text() except a text without words.
Result<LineMaker> voice_lines(const voice::VoiceOptions& options, bool speak_marks = false);

/// A source of lines. Use from one thread.
class LineSource {
 public:
  virtual ~LineSource() = default;
  /// The next line or mark, if ready. Does not wait. `only_joining`: only a line that joins the
  /// previous one.
  virtual std::optional<SpokenLine> take(bool only_joining) = 0;
  /// When the next line arrived, if it would be better if it were taken later (pieces.h).
  virtual std::optional<double> improvable_since() { return std::nullopt; }
  /// News since the last call, in order. Lines that take() has already returned are referred to by
  /// number.
  virtual std::vector<LineNews> take_news() { return {}; }
  /// True when neither will return anything again.
  virtual bool ended() = 0;
  /// Ends the source: queued lines are cancelled.
  virtual void abandon(const std::string& why) { (void)why; }
};

class ControlSocket;

/// Reads lines from a file descriptor and from a control socket, and synthesises them in a separate
/// thread. Empty lines are skipped; a last line without a line end counts. At most four lines are
/// synthesised ahead; while 64 MB are queued, the descriptor is not read.
class VoiceLines : public LineSource {
 public:
  /// `descriptor` is borrowed; -1: only the control socket. Clock and socket must outlive the
  /// lines. Errors: io (no thread).
  static Result<std::unique_ptr<VoiceLines>> open(int descriptor, LineMaker maker,
                                                  media::Clock& clock,
                                                  ControlSocket* control = nullptr);
  /// Stops reading and waits for the line being synthesised.
  ~VoiceLines() override;

  std::optional<SpokenLine> take(bool only_joining) override;
  std::optional<double> improvable_since() override;
  std::vector<LineNews> take_news() override;
  bool ended() override;
  void abandon(const std::string& why) override;
  /// LineMaker::sample_rate.
  int sample_rate() const { return sample_rate_; }
  /// One sentence for every skipped or doubtful line since the last call.
  std::vector<std::string> take_warnings();

 private:
  struct Impl;
  VoiceLines(std::unique_ptr<Impl> impl, int sample_rate);
  std::unique_ptr<Impl> impl_;
  int sample_rate_;
};

}  // namespace animeme::speech

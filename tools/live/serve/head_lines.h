/// @file
/// The lines of one head, and commands among them (tools/speech/talking/line_command.h): they are
/// queued as text and synthesised shortly before they are needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/live/serve/voices.h"
#include "tools/speech/talking/line_queue.h"
#include "tools/speech/talking/lines.h"

namespace animeme::serve {

/// Thread safe, except that take() may only be called from one thread at a time.
class HeadLines : public speech::LineSource, public std::enable_shared_from_this<HeadLines> {
 public:
  static constexpr std::size_t kMostLines = 1000;                   ///< in the queue
  static constexpr std::size_t kMostBytes = 65536;                  ///< of these
  static constexpr std::size_t kMostSound = std::size_t(16) << 20;  ///< bytes of pieces
  /// Bytes of a part of a line that is synthesised at once: some 10 to 20 s, 1 to 2 MB of sound.
  static constexpr std::size_t kPartBytes = 300;

  /// `most_seconds`: of speech that may wait, besides a line of any length. `changed` is called
  /// when take() or take_news() returns something new. Voices and clock must outlive the lines.
  /// With LineMaker::pieces lines may be pieces, too. `slow`: the maker may take long.
  HeadLines(speech::LineMaker maker, Voices& voices, media::Clock& clock,
            std::function<void()> changed, double most_seconds = 1800, bool slow = false);

  /// Another voice for all lines that are not spoken yet; the stream of pieces stays.
  void speak_with(speech::LineMaker maker, bool slow);

  /// Adds lines and commands in order; empty ones are skipped. Long lines are spoken in parts.
  /// Errors: out_of_range (too many or too much in the queue behind the last "stop" or "drop",
  /// which are always accepted), invalid_argument ("end", which a head does not support; the
  /// message has the alternative), those of read_line(). Lines before a wrong one are executed,
  /// except for out_of_range and "end". Gives the ids of the lines in their events.
  Result<std::vector<std::string>> push(std::vector<std::string> lines);
  /// Sound of an utterance as samples, as LineQueue::push_sound(). It is never refused for what
  /// waits: who sends looks at piece_bytes(). Errors: those of PieceStream::add_sound();
  /// unsupported (without LineMaker::pieces).
  Result<void> push_sound(const std::string& id, media::Pcm sound, bool last);
  bool idle() const;                ///< no queued lines and no pending news
  std::size_t waiting() const;      ///< lines not yet returned by take(), parts of lines included
  std::size_t bytes() const;        ///< of these, before synthesis; without pieces
  std::size_t piece_bytes() const;  ///< of the pieces among them
  double seconds() const;           ///< that these take to speak, about
  std::int64_t given() const;       ///< lines returned by take()
  /// Drops all lines; `changed` is not called after this returns.
  void stop();

  std::optional<speech::SpokenLine> take(bool only_joining) override;
  std::vector<speech::LineNews> take_news() override;
  bool ended() override { return false; }  ///< never: more may come
  void abandon(const std::string& why) override;
  int sample_rate() const { return sample_rate_; }  ///< Hz, of the first voice
  /// The sentence for the last skipped or doubtful line; empty: none.
  std::string last_warning() const;

 private:
  void order();
  void make_one();
  void tell();
  void changed_by_push();

  const std::shared_ptr<speech::PieceStream> pieces_;
  const int sample_rate_;
  const double most_seconds_;
  Voices& voices_;
  media::Clock& clock_;
  mutable speech::LineQueue queue_;

  std::mutex pushing_;        // lines of a request follow each other
  mutable std::mutex mutex_;  // for what follows
  std::shared_ptr<const speech::LineMaker> maker_;
  bool slow_ = false;
  bool making_ = false;
  bool news_ = false;  // not read yet
  std::int64_t given_ = 0;
  mutable std::string warning_;
  std::mutex telling_;  // while changed_ is called
  std::function<void()> changed_;
};

}  // namespace animeme::serve

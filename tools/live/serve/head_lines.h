/// @file
/// The lines of one head, and commands among them (tools/speech/talking/line_command.h): they wait
/// as text, and become speech shortly before they are wanted.
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

/// Thread safe, but for take(), which is one thread's at a time.
class HeadLines : public speech::LineSource, public std::enable_shared_from_this<HeadLines> {
 public:
  static constexpr std::size_t kMostLines = 1000;   ///< that wait
  static constexpr std::size_t kMostBytes = 65536;  ///< of these

  /// `changed` is called when take() or take_news() has something. Voices and clock must outlive
  /// the lines.
  HeadLines(speech::LineMaker maker, Voices& voices, media::Clock& clock,
            std::function<void()> changed);

  /// Lines and commands, in their order; empty ones are skipped. Errors: out_of_range (too many
  /// wait, or one is too long), invalid_argument ("end", which a head has not; the sentence says
  /// what to do), those of read_line(). What stands in front of the one that is wrong is done
  /// unless it is out_of_range or "end".
  Result<void> push(std::vector<std::string> lines);
  bool idle() const;            ///< nothing waits, and nothing is left to be told
  std::size_t waiting() const;  ///< lines that take() has not given
  std::int64_t given() const;   ///< lines that it has
  /// All lines are forgotten; `changed` is not called any more when this returns.
  void stop();

  std::optional<speech::SpokenLine> take(bool only_joining) override;
  std::vector<speech::LineNews> take_news() override;
  bool ended() override { return false; }  ///< never: more may come
  void abandon(const std::string& why) override;
  int sample_rate() const { return maker_.sample_rate; }  ///< Hz
  /// The sentence for the line that was last left out or in doubt; empty: none was.
  std::string last_warning() const;

 private:
  void order();
  void make_one();
  void tell();

  const speech::LineMaker maker_;
  Voices& voices_;
  media::Clock& clock_;
  mutable speech::LineQueue queue_;

  mutable std::mutex mutex_;  // for what follows
  bool making_ = false;
  bool news_ = false;  // that nobody has taken
  std::int64_t given_ = 0;
  mutable std::string warning_;
  std::mutex telling_;  // while changed_ is called
  std::function<void()> changed_;
};

}  // namespace animeme::serve

/// @file
/// The lines of one head: they wait as text, and become speech shortly before they are wanted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/serve/voices.h"
#include "tools/speech/lines.h"

namespace animeme::serve {

/// Thread safe, but for take(), which is one thread's at a time.
class HeadLines : public speech::LineSource, public std::enable_shared_from_this<HeadLines> {
 public:
  static constexpr std::size_t kMostLines = 1000;   ///< that wait as text
  static constexpr std::size_t kMostBytes = 65536;  ///< of these

  /// `made` is called in the thread of the voices when take() has something. Voices and clock must
  /// outlive the lines.
  HeadLines(speech::LineMaker maker, Voices& voices, media::Clock& clock,
            std::function<void()> made);

  /// Lines to be spoken behind those that wait; empty ones are skipped. All or none are taken:
  /// errors: out_of_range (too many wait, or one has more than LineMaker::most_bytes).
  Result<void> push(std::vector<std::string> lines);
  /// Lines that the voice has not begun are forgotten. Returns how many.
  std::size_t drop();
  /// Nothing waits and nothing is being made.
  bool idle() const;
  std::size_t waiting() const;  ///< lines that take() has not given
  std::int64_t given() const;   ///< lines that it has
  /// `made` is not called any more when this returns.
  void stop();

  std::vector<speech::SpokenLine> take() override;
  bool ended() override { return false; }                 ///< never: more may come
  int sample_rate() const { return maker_.sample_rate; }  ///< Hz
  /// The sentence for the line that was last left out or in doubt; empty: none was.
  std::string last_warning() const;

 private:
  void order();  // with the lock held
  void make_one();

  const speech::LineMaker maker_;
  Voices& voices_;
  media::Clock& clock_;

  mutable std::mutex mutex_;  // for what follows
  struct Text {
    std::string line;
    double arrived = 0;
  };
  std::deque<Text> texts_;
  std::size_t bytes_ = 0;  // of the texts
  bool making_ = false;
  std::int64_t given_ = 0;
  std::vector<speech::SpokenLine> done_;
  std::string warning_;
  std::mutex telling_;  // while made_ is called
  std::function<void()> made_;
};

}  // namespace animeme::serve

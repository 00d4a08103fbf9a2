/// @file
/// The voice of all heads: a thread that makes speech of lines in the order in which they come.
///
/// espeak-ng can speak one text at a time, 500 times faster than it is heard, so one thread is
/// enough for hundreds of heads.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "fap/result.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/voice/voice.h"

namespace animeme::serve {

/// Makes the maker of lines for a voice.
using MakerOf = std::function<Result<speech::LineMaker>(const voice::VoiceOptions&)>;

/// Thread safe, but for its end.
class Voices {
 public:
  /// `maker_of` is called in the thread, once for each voice that is asked for; as a rule
  /// speech::voice_lines(). std::system_error if no thread can be started.
  explicit Voices(MakerOf maker_of);
  ~Voices();  ///< the job that runs is waited for, others are dropped
  Voices(const Voices&) = delete;
  Voices& operator=(const Voices&) = delete;

  /// Waits for the jobs before it. Errors: those of `maker_of`; io (it is over).
  Result<speech::LineMaker> maker(const voice::VoiceOptions& options);
  /// Runs `job` in the thread behind all that wait. It must throw nothing.
  void post(std::function<void()> job);

 private:
  void run();
  Result<speech::LineMaker> find(const voice::VoiceOptions& options);

  const MakerOf maker_of_;
  std::map<std::string, speech::LineMaker> makers_;  // the thread's
  std::mutex mutex_;                                 // for what follows
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace animeme::serve

/// @file
/// The threads that make speech for all heads, in order of arrival.
///
/// espeak-ng speaks one text at a time, but 500 times faster than real time, so one thread is
/// enough for hundreds of heads. What may take longer than what it says, external commands, and the
/// sound that others send, has threads of its own, kMostSlow of them at most.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fap/result.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/voice/voice.h"

namespace animeme::serve {

/// Creates the LineMaker for a voice.
using MakerOf = std::function<Result<speech::LineMaker>(const voice::VoiceOptions&)>;

/// Thread safe, except destruction.
class Voices {
 public:
  /// `maker_of` is called in the thread, once for each requested voice; usually
  /// speech::voice_lines(). std::system_error if no thread can be started.
  explicit Voices(MakerOf maker_of);
  ~Voices();  ///< waits for the running jobs and drops the others
  Voices(const Voices&) = delete;
  Voices& operator=(const Voices&) = delete;

  /// Waits for the running job, not for those that wait. Errors: those of `maker_of`; io (already
  /// ended).
  Result<speech::LineMaker> maker(const voice::VoiceOptions& options);
  /// Queues `job` for the thread. It must not throw.
  void post(std::function<void()> job);
  static constexpr int kMostSlow = 10;  ///< threads for what may take long
  /// Queues `job` for one of the others. It must not throw.
  void post_slow(std::function<void()> job);

 private:
  void post_first(std::function<void()> job);
  void run();
  void run_slow();
  Result<speech::LineMaker> find(const voice::VoiceOptions& options);

  const MakerOf maker_of_;
  std::map<std::string, speech::LineMaker> makers_;  // the thread's
  std::mutex mutex_;                                 // for what follows
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::deque<std::function<void()>> slow_jobs_;
  int idle_ = 0;  // of the slow threads
  bool stopping_ = false;
  std::vector<std::thread> slow_;
  std::thread thread_;
};

}  // namespace animeme::serve

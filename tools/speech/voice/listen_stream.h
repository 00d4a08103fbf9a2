/// @file
/// Speech from sound alone while it comes: what may have been said up to now, again and again.
///
///     auto listener = voice::SoundListener::open(48000, {});
///     for (const auto& block : blocks_as_they_come) {
///       (*listener)->push(block);
///       const voice::Heard tail = (*listener)->hear(from);      // from `from` seconds to the end
///     }
///
/// Each answer is about all that has been heard so far; what lies 0.2 s back hardly changes any
/// more. Memory and the cost of a second do not grow with time. Source:
/// tools/speech/voice/engines.md, section 3.
#pragma once

#include <memory>
#include <span>

#include "fap/result.h"
#include "tools/speech/voice/listen.h"

namespace animeme::voice {

/// Not thread safe, but several may be used at once.
class SoundListener {
 public:
  /// `rate` is that of the samples, 4000 to 384000 Hz. `options.progress` is not used. Errors:
  /// those of listen() that are about options and models, invalid_argument (the rate).
  static Result<std::unique_ptr<SoundListener>> open(int rate, const ListenOptions& options);
  virtual ~SoundListener() = default;

  /// The next samples, full scale +-1, one channel; those that are no numbers count as 0.
  virtual void push(std::span<const float> samples) = 0;
  /// Seconds of sound up to which is heard: all of it but the last 70 ms, at the
  /// beginning but the last 120 ms.
  virtual double heard() const = 0;
  /// What was heard from `from` (seconds of sound, not before what forget() named) on. The scripts
  /// begin at 0, which is `from`, and end at heard(). Empty scripts if there is nothing yet.
  virtual Heard hear(double from) const = 0;
  /// Nothing before `before` seconds will be asked for.
  virtual void forget(double before) = 0;
};

}  // namespace animeme::voice

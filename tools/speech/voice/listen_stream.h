/// @file
/// Phone recognition of live sound.
///
///     auto listener = voice::SoundListener::open(48000, {});
///     for (const auto& block : blocks_as_they_come) {
///       (*listener)->push(block);
///       const voice::Recognition tail = (*listener)->hear(from);      // from `from` seconds to
///       the end
///     }
///
/// Each result covers everything so far; what is more than 0.2 s old hardly changes. Memory and CPU
/// time per second are constant. Source: tools/speech/voice/engines.md, section 3.
#pragma once

#include <memory>
#include <span>

#include "fap/result.h"
#include "tools/speech/voice/listen.h"

namespace animeme::voice {

/// Not thread safe, but several may be used at once.
class SoundListener {
 public:
  /// `rate`: sample rate, 4000 to 384000 Hz. `options.progress` is not used. Errors: those of
  /// listen() about options and models, invalid_argument (the rate).
  static Result<std::unique_ptr<SoundListener>> open(int rate, const ListenOptions& options);
  virtual ~SoundListener() = default;

  /// The next samples, full scale +-1, one channel; NaN counts as 0.
  virtual void push(std::span<const float> samples) = 0;
  /// Seconds of sound that have been recognised: all except the last 70 ms (at the beginning 120
  /// ms).
  virtual double heard() const = 0;
  /// Result from time `from` (seconds, not before the argument of forget()). The scripts begin at
  /// 0, which is `from`, and end at heard(); they are empty if there is nothing yet.
  virtual Recognition hear(double from) const = 0;
  /// Discards results before `before` seconds.
  virtual void forget(double before) = 0;
};

}  // namespace animeme::voice

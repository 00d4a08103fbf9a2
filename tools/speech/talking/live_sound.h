/// @file
/// Coded sound without an end: silence into which pieces of sound are laid while it is made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::speech {

/// Where a piece begins without one before it, or ends without one behind it, it fades within 2 ms:
/// sound that comes too late breaks off and begins anew without a click. Movable, not copyable.
/// Memory does not grow with time.
class LiveSound {
 public:
  /// Pieces will have `sample_rate`. Errors: those of media::AudioEncoder::open().
  static Result<LiveSound> open(int sample_rate, const media::AudioSettings& settings);

  const media::AudioFormat& format() const { return encoder_.format(); }  ///< of the packets
  /// Lays in a piece (full scale +-1) whose first sample is heard at sample `start` of
  /// `sample_rate`. What of it lies before made() is lost.
  void add(std::int64_t start, std::vector<float> samples);
  /// All that was added fades over `fade` samples and is silent from sample `end` on. What of that
  /// lies before made() stays as it is: the fade is then shorter.
  void end_at(std::int64_t end, std::int64_t fade);
  /// Samples of `sample_rate` that the encoder has been given, so that nothing can be added there.
  std::int64_t made() const { return made_; }
  /// Time of the packet that next() will make, in samples of the format.
  std::int64_t next_time() const { return next_time_; }
  /// The next packet; gives the encoder no more sound than it needs. Errors: those of the encoder.
  Result<media::AudioPacket> next();

 private:
  struct Piece {
    std::int64_t start = 0;
    std::vector<float> samples;
  };
  LiveSound(media::AudioEncoder encoder, int sample_rate)
      : encoder_(std::move(encoder)),
        block_(std::size_t(sample_rate / 100)),
        fade_(sample_rate / 500),
        next_time_(-encoder_.format().priming) {}
  bool goes_on(std::int64_t at) const;
  std::vector<float> block();

  media::AudioEncoder encoder_;
  std::size_t block_;  // samples, 10 ms
  std::int64_t fade_;  // samples, 2 ms
  std::deque<Piece> pieces_;
  std::deque<media::AudioPacket> ready_;
  std::int64_t made_ = 0;
  std::int64_t next_time_;
};

}  // namespace animeme::speech

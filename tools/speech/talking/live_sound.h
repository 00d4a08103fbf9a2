/// @file
/// An endless coded audio stream: silence into which pieces of sound are mixed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::speech {

/// A piece without a predecessor or successor is faded in or out over 2 ms, so that late sound
/// stops and restarts without a click. Movable, not copyable. Uses constant memory.
class LiveSound {
 public:
  /// Pieces will have `sample_rate`. Errors: those of media::AudioEncoder::open().
  static Result<LiveSound> open(int sample_rate, const media::AudioSettings& settings);

  const media::AudioFormat& format() const { return encoder_.format(); }  ///< of the packets
  /// Adds a piece (full scale +-1) that begins at sample `start`, counted at `sample_rate`. Samples
  /// before made() are lost.
  void add(std::int64_t start, std::vector<float> samples);
  /// Fades everything out over `fade` samples to silence from sample `end`. Samples before made()
  /// do not change, which may shorten the fade.
  void end_at(std::int64_t end, std::int64_t fade);
  /// As media::AudioEncoder::expect_loss(); values out of range do nothing.
  void expect_loss(int percent) { (void)encoder_.expect_loss(percent); }
  /// The samples from made() on, up to the end of all pieces; they stay.
  std::vector<float> rest() const;
  /// Number of samples, at `sample_rate`, already passed to the encoder.
  std::int64_t made() const { return made_; }
  /// Time of the next packet, in samples of the format.
  std::int64_t next_time() const { return next_time_; }
  /// The next packet; passes the encoder no more sound than it needs. Errors: those of the encoder.
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

// The sound of a file that is being written, packet by packet: coded already, or coded now.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tools/media/encoded_audio.h"

namespace animeme::media {

class SoundSource {
 public:
  /// Codes `pcm` while it is asked for packets. `pcm` must outlive the source. Errors: those of
  /// AudioEncoder::open().
  static Result<SoundSource> coding(const Pcm& pcm, const AudioSettings& settings);
  /// Gives out the packets of `audio`, which must outlive the source.
  static SoundSource copying(const EncodedAudio& audio);

  const AudioFormat& format() const { return audio_ ? audio_->format : encoder_->format(); }
  /// Bits a second: of the packets, or as the encoder was told.
  std::int64_t bit_rate() const { return bit_rate_; }
  /// The next packet, valid until the next call; nullptr: no more. Error: io.
  Result<const AudioPacket*> next();

 private:
  SoundSource() = default;
  Result<void> refill();
  const AudioPacket* next_copy();

  const EncodedAudio* audio_ = nullptr;
  const Pcm* pcm_ = nullptr;
  std::optional<AudioEncoder> encoder_;
  std::int64_t bit_rate_ = 0;
  std::vector<AudioPacket> coded_;
  std::size_t at_ = 0;      // in coded_ or audio_->packets
  std::size_t pushed_ = 0;  // samples of pcm_
  bool finished_ = false;
};

}  // namespace animeme::media

// The sound of a file that is being written, packet by packet: coded already, or coded now.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/media/audio.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/stored.h"

namespace animeme::media {

class SoundSource {
 public:
  /// Codes `pcm` while it is asked for packets. `pcm` must outlive the source. Errors: those of
  /// AudioEncoder::open().
  static Result<SoundSource> coding(const Pcm& pcm, const AudioSettings& settings);
  /// The same for a sound file, which is decoded meanwhile; two channels stay two. `warnings` may
  /// be null. Errors: also those of AudioReader.
  static Result<SoundSource> decoding(const std::string& path, const AudioSettings& settings,
                                      std::vector<std::string>* warnings);
  /// Gives out the packets of `audio`, which must outlive the source.
  static SoundSource copying(const EncodedAudio& audio);
  /// The same, read meanwhile from its first packet on. Error: io.
  static Result<SoundSource> copying(StoredAudio& audio);

  const AudioFormat& format() const;
  /// Bits a second: of the packets, or the encoder's target.
  std::int64_t bit_rate() const { return bit_rate_; }
  /// Length of the sound, or the length in the header of the file.
  double seconds() const;
  /// Length of what was coded or copied so far.
  double seconds_so_far() const;
  /// The next packet, valid until the next call; nullptr: no more. Errors: io; those of
  /// AudioReader.
  Result<const AudioPacket*> next();

 private:
  SoundSource() = default;
  Result<void> start(int sample_rate, const AudioSettings& settings, int channels);
  Result<std::span<const float>> more_samples();
  Result<void> refill();
  Result<const AudioPacket*> next_copy();
  bool copies() const { return audio_ != nullptr || stored_ != nullptr; }

  const EncodedAudio* audio_ = nullptr;
  StoredAudio* stored_ = nullptr;
  std::int64_t length_ = 0;        // of what is copied; 0: not known
  std::int64_t copied_until_ = 0;  // samples
  const Pcm* pcm_ = nullptr;
  std::optional<AudioReader> reader_;
  std::string path_;  // of reader_
  std::optional<AudioEncoder> encoder_;
  std::int64_t bit_rate_ = 0;
  std::vector<AudioPacket> coded_;
  std::size_t at_ = 0;      // in coded_ or audio_->packets
  std::size_t pushed_ = 0;  // samples that went to the encoder, of all channels
  bool finished_ = false;
};

}  // namespace animeme::media

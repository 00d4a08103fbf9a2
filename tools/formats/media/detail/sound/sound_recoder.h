// Sound into another codec, packet by packet, for files that do not take its own.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/formats/media/detail/sound/packet_decoder.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

class SoundRecoder {
 public:
  /// From `format` to AAC. Errors: those of PacketDecoder::open() and AudioEncoder::open().
  static Result<SoundRecoder> open(const AudioFormat& format);

  const AudioFormat& format() const { return encoder_.format(); }
  /// The packets that are complete, on the same clock (in samples of format()). What is missing is
  /// silence. Errors: those of decoder and encoder.
  Result<std::vector<AudioPacket>> push(const AudioPacket& packet);
  Result<std::vector<AudioPacket>> finish();

 private:
  SoundRecoder(PacketDecoder decoder, AudioEncoder encoder, int from)
      : decoder_(std::move(decoder)), encoder_(std::move(encoder)), from_(from) {}
  Result<void> code(std::int64_t at, std::span<const float> samples);
  Result<void> encode(std::span<const float> samples);

  PacketDecoder decoder_;
  AudioEncoder encoder_;
  int from_;                           // samples a second that are decoded
  std::optional<std::int64_t> begin_;  // of the first sample that was coded
  std::int64_t next_ = 0;              // of the next one
  std::vector<AudioPacket> coded_;
};

}  // namespace animeme::media

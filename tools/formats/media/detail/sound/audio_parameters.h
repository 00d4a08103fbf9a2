// Between our description of coded sound and libavcodec's.
#pragma once

#include <cstdint>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// The rate in which sound of `sample_rate` is coded: AAC's lowest that is not below it (96000
/// above that), 48000 for Opus.
int coded_sample_rate(AudioCodec codec, int sample_rate);

/// Lowest and highest bit rate of an encoder, bits a second, and the usual one of a channel.
struct BitRates {
  int lowest, highest, usual;
};
BitRates bit_rates(AudioCodec codec);

/// The bit rate for the encoder: that of the settings or the default, at most 6 bits a sample of
/// AAC.
std::int64_t coded_bit_rate(const AudioSettings& settings, int sample_rate, int channels);

/// Stream parameters for a muxer or decoder. `bit_rate`: mean bits a second, 0: not known.
/// Errors: invalid_argument (rate or channels not positive), out_of_range (memory).
Result<av::Parameters> codec_parameters(const AudioFormat& format, std::int64_t bit_rate = 0);

/// Bits a second of all packets; 0: there are none.
std::int64_t mean_bit_rate(const EncodedAudio& audio);

/// Refuses what no muxer or decoder could use: no packets or no configuration, empty packets,
/// times that do not ascend. Error: invalid_argument.
Result<void> check_audio(const EncodedAudio& audio);

/// Makes `target` a copy of `source` with time stamps in samples; a packet that is heard in part
/// only, because the sound ends in it, says so (as Opus in Matroska needs it). Error:
/// out_of_range (memory).
Result<void> copy_packet(const AudioPacket& source, const AudioFormat& format, AVPacket& target);

}  // namespace animeme::media

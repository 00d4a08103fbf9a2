/// @file
/// Coded sound, as all containers and live transports carry it.
///
///     Result<EncodedAudio> sound = encode_audio(voice, {.codec = AudioCodec::opus});
///     Result<Pcm> heard = decode_audio(*sound);     // as long as `voice`, sample 0 at sample 0
///
/// Source: tools/formats/media/containers.md, sections 5.1 and 5.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/pcm.h"

namespace animeme::media {

/// Codecs that all containers and transports here support.
enum class AudioCodec : std::uint8_t { aac, opus };

/// "aac" or "opus".
const char* name_of(AudioCodec codec);

/// What a decoder needs before the first packet.
struct AudioFormat {
  AudioCodec codec = AudioCodec::aac;  ///< determines the meaning of the other fields
  int sample_rate = 48000;             ///< Hz; Opus: 48000
  int channels = 1;                    ///< as decoded
  int frame_samples = 1024;            ///< samples a packet; 0: variable
  int priming = 0;                     ///< samples that a decoder outputs before sample 0
  std::vector<std::uint8_t> config;    ///< AudioSpecificConfig of AAC, OpusHead of Opus

  friend bool operator==(const AudioFormat&, const AudioFormat&) = default;
};

/// One packet of coded sound.
struct AudioPacket {
  std::vector<std::uint8_t> bytes;  ///< raw: no ADTS, no container
  std::int64_t time = 0;      ///< samples; the first packet of a whole track begins at -priming
  std::int64_t duration = 0;  ///< samples, > 0

  friend bool operator==(const AudioPacket&, const AudioPacket&) = default;
};

/// A sound track. Times ascend.
struct EncodedAudio {
  AudioFormat format;                ///< of all packets
  std::vector<AudioPacket> packets;  ///< ascending times
  /// Number of samples to be played, from sample 0; 0: up to the end of the last packet.
  std::int64_t length = 0;

  friend bool operator==(const EncodedAudio&, const EncodedAudio&) = default;
};

/// Search of the AAC encoder for scale factors. Speed and quality of both:
/// tools/formats/media/containers.md, section 5.1.
enum class AacSearch : std::uint8_t {
  fast,      ///< one pass
  two_loop,  ///< FFmpeg's default: several passes per frame
};

/// Encoder settings.
struct AudioSettings {
  AudioCodec codec = AudioCodec::aac;  ///< aac in mp4, opus for browsers
  /// Bits a second, 8000..320000 (Opus: 6000..256000). AAC allows at most 6 bits a sample and
  /// channel, so 64000 becomes 48000 at 8 kHz. 0: for each channel 64000 for AAC, 40000 for Opus.
  int bit_rate = 0;
  /// Opus: how hard its encoder works (libopus' complexity), 0..10. Below 7 it does not look what
  /// kind of sound it has: a quarter of the time, and the bit rate is held by the packet, since
  /// it would be missed by half without that look. A voice of 22 kHz at 40000 bits a second has a
  /// signal to noise ratio of 17.7 dB with 10, 16.7 dB with 5.
  int effort = 10;
  AacSearch aac_search = AacSearch::fast;  ///< AAC only
  /// Opus: percent of the packets that receivers are expected to lose, 0..50. Each packet of speech
  /// then has the one before it again, coarsely (in-band FEC, RFC 6716, section 2.1.7), within the
  /// same bit rate. Above 0 the encoder works as for a voice. kLossByReports: none, until
  /// AudioEncoder::expect_loss() says how many.
  int expected_loss = 0;
  static constexpr int kLossByReports = -1;  ///< value of expected_loss
};

/// Sound in, packets out, for sound that is still being made. Movable, not copyable. Same sound in
/// any cut gives the same packets.
class AudioEncoder {
 public:
  /// Sound with `sample_rate` will be pushed, in one channel or two. A rate that the codec lacks is
  /// resampled: AAC to the next higher one it has, Opus to 48000. Errors: invalid_argument (rate,
  /// bit rate, channels), unsupported (this FFmpeg lacks the encoder), out_of_range (memory).
  static Result<AudioEncoder> open(int sample_rate, const AudioSettings& settings = {},
                                   int channels = 1);
  AudioEncoder(AudioEncoder&&) noexcept;  ///< movable
  AudioEncoder& operator=(AudioEncoder&&) noexcept;
  ~AudioEncoder();

  const AudioFormat& format() const;  ///< fixed from open() on
  /// Opus that was opened with AudioSettings::kLossByReports: as if it had been opened with this
  /// expected loss, from 0.2 s of sound later on; no packet is missing or longer in between. Others
  /// stay as they are. Errors: invalid_argument (not 0..50).
  Result<void> expect_loss(int percent);
  /// Appends sound, of two channels in pairs (left, right), and gives out the packets that are
  /// complete. Values outside +-1 are clipped, NaN is 0. Errors: io (the encoder fails),
  /// invalid_argument (after finish()).
  Result<std::vector<AudioPacket>> push(std::span<const float> samples);
  /// The rest. Nothing can be pushed after it.
  Result<std::vector<AudioPacket>> finish();

 private:
  struct Impl;
  explicit AudioEncoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// All of it at once. Errors: those of AudioEncoder; invalid_argument (no sound).
Result<EncodedAudio> encode_audio(const Pcm& pcm, const AudioSettings& settings = {});

/// Decodes to one channel; sample 0 is time 0, priming and padding are cut off. Packets that are
/// missing are silence. Errors: unsupported (no decoder), syntax (nothing can be decoded),
/// out_of_range (longer than 3 hours, memory), invalid_argument (times that do not ascend).
Result<Pcm> decode_audio(const EncodedAudio& audio);

}  // namespace animeme::media

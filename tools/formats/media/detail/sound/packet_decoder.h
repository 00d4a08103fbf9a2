// Coded sound to samples of one channel, packet by packet, each at its time.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/sound/resampler.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

class PacketDecoder {
 public:
  /// Samples from time `at` on, as the packets count it; priming comes, too.
  using Take = std::function<Result<void>(std::int64_t at, std::span<const float> samples)>;

  /// `format` is copied. Errors: unsupported (no decoder), out_of_range (memory).
  Result<void> open(const AudioFormat& format);
  /// nullptr: the rest. A packet that cannot be decoded is as good as missing. Errors: unsupported
  /// (another rate than the format says), those of `take`.
  Result<void> decode(const AudioPacket* packet, const Take& take);

 private:
  Result<void> mix(AVFrame& frame, const Take& take);

  AudioFormat format_;
  av::Codec codec_;
  av::Packet packet_{av_packet_alloc()};
  av::Frame frame_{av_frame_alloc()};
  std::vector<float> mono_;
  std::optional<Resampler> mixer_;    // to one channel; the rate stays
  std::int64_t at_ = 0;               // where the next decoded sample belongs
  std::optional<std::int64_t> next_;  // where the next packet belongs if none is missing
};

}  // namespace animeme::media

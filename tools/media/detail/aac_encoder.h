// Mono AAC-LC, packet by packet.
#pragma once

#include <cstdint>

#include "tools/media/detail/ffmpeg.h"
#include "tools/media/pcm.h"

namespace animeme::media {

/// The lowest rate of AAC that is not below `sample_rate`; 96000 above that.
int aac_sample_rate(int sample_rate);

class AacEncoder {
 public:
  /// `pcm` must have a rate that AAC knows and outlive the encoder.
  static Result<AacEncoder> open(const Pcm& pcm, int bit_rate);

  const AVCodecContext& codec() const { return *codec_; }
  /// Next packet, times in 1/sample_rate s, the first at minus the priming. False: no more.
  Result<bool> next(AVPacket& packet);

 private:
  AacEncoder() = default;
  int send_frame();

  const Pcm* pcm_ = nullptr;
  std::size_t at_ = 0;
  bool flushed_ = false;
  av::Codec codec_;
  av::Frame frame_;
};

}  // namespace animeme::media

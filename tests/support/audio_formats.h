// Descriptions of sound whose packets nobody decodes.
#pragma once

#include "tools/formats/media/encoded_audio.h"

namespace animeme::test {

inline media::AudioFormat aac_format() {
  return {.codec = media::AudioCodec::aac,
          .sample_rate = 48000,
          .channels = 1,
          .frame_samples = 1024,
          .priming = 1024,
          .config = {0x11, 0x88}};
}

inline media::AudioFormat opus_format() {
  return {
      .codec = media::AudioCodec::opus,
      .sample_rate = 48000,
      .channels = 1,
      .frame_samples = 960,
      .priming = 312,
      .config = {'O', 'p', 'u', 's', 'H', 'e', 'a', 'd', 1, 1, 0x38, 1, 0x80, 0xBB, 0, 0, 0, 0, 0}};
}

}  // namespace animeme::test

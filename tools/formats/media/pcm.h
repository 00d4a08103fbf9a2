/// @file
/// Sound in memory. Without dependencies, so that voices and aligners do not need FFmpeg.
#pragma once

#include <cstddef>
#include <vector>

namespace animeme::media {

/// One channel of sound. Sample k is at k / sample_rate seconds; full scale is +-1.
struct Pcm {
  int sample_rate = 48000;     ///< Hz, > 0
  std::vector<float> samples;  ///< +-1 is full scale

  double duration() const { return double(samples.size()) / double(sample_rate); }  ///< seconds
};

}  // namespace animeme::media

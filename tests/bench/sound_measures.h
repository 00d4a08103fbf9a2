// Perceptual distances between a sound and its coded form.
#pragma once

#include <cstddef>
#include <span>

namespace animeme::bench {

/// Means over the frames that hold sound: those within 40 dB of the loudest one.
struct SoundDistance {
  double snr = 0;        ///< segmental signal to noise ratio, dB; each frame between -10 and 35
  double spectrum = 0;   ///< distance of the levels in half Bark bands, dB RMS
  double nmr = 0;        ///< noise to mask ratio, dB: below 0 the noise is masked on average
  double disturbed = 0;  ///< share of frames with a band whose noise passes its mask by 1.5 dB
  std::size_t frames = 0;
};

/// Compares two sounds of the same rate, sample by sample. Frames of about 46 ms, half of one
/// apart. The mask of a band: the spectrum of `original` spread by 27 dB a Bark downwards and 15 dB
/// a Bark upwards, lowered by the mask offset of ITU-R BS.1387 (3 dB, above 12 Bark 0.25 dB a
/// Bark), at least -90 dB of full scale.
SoundDistance sound_distance(std::span<const float> original, std::span<const float> coded,
                             int sample_rate);

}  // namespace animeme::bench

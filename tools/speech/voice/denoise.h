/// @file
/// Speech without the noise of its room, before it is recognised. Internal.
#pragma once

#include <vector>

namespace animeme::voice {

/// Samples at 16 kHz with less noise where `snr`, of speech to noise in dB, is low: the lower, the
/// more is taken. As long as before; what the filter delays is taken out.
std::vector<float> denoised(const std::vector<float>& samples, double snr);

}  // namespace animeme::voice

/// @file
/// Speech without the noise of its room, before it is recognised. Internal.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace animeme::voice {

/// Hands over samples at 16 kHz with less noise where `snr`, of speech to noise in dB, is low: the
/// lower, the more is taken. As many as before, in order and in blocks, so that a long recording is
/// not copied; what the filter delays is taken out.
void denoise(const std::vector<float>& samples, double snr,
             const std::function<void(std::span<const float>)>& take);

}  // namespace animeme::voice

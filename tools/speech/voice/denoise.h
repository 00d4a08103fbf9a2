/// @file
/// A recording without its room, before it is aligned. Internal.
#pragma once

#include <vector>

namespace animeme::voice {

/// The recording without rumble and, where its pauses are loud, with less noise: the less there is
/// between them and the speech, the more is taken. `samples` are at 16 kHz. As long as before; what
/// the filters delay is taken out. Samples that are no numbers become 0.
std::vector<float> denoised(const std::vector<float>& samples);

}  // namespace animeme::voice

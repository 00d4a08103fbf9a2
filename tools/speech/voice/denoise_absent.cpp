// Stands in for denoise.cpp where there is no aligner, which alone wants it.
#include "tools/speech/voice/denoise.h"

namespace animeme::voice {

std::vector<float> denoised(const std::vector<float>& samples) { return samples; }

}  // namespace animeme::voice

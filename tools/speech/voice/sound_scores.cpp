// Most of the time of listening is spent here.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "tools/speech/voice/sound_model.h"

namespace animeme::voice {

namespace {

// exp() of what is not above 0, within 1e-4 of itself, in a form that is computed four at a time:
// a power of two by its bits, what is left by a polynomial. Below -40 it is as at -40.
inline float exp_below(float value) {
  const float power = std::max(value, -40.0f) * std::numbers::log2e_v<float>;
  const auto whole = std::int32_t(power) - 1;  // towards 0, so at or below
  const float rest = power - float(whole);     // 0..2
  const float half = 0.5f * rest * std::numbers::ln2_v<float>;
  const float root =
      1 + half * (1 + half * (0.5f + half * (1.0f / 6 + half * (1.0f / 24 + half / 120))));
  return std::bit_cast<float>((whole + 127) << 23) * root * root;
}

}  // namespace

void score_states(const SoundModel& model, const Features& frame, std::span<float> scores) {
  std::vector<float> fits(model.densities);
  for (std::size_t phone = 0; phone < model.phones.size(); ++phone) {
    float* out = &scores[phone * kStatesPerPhone];
    std::fill_n(out, kStatesPerPhone, 0.0f);
    for (std::size_t stream = 0; stream < kStreams; ++stream) {
      const std::size_t book = phone * kStreams + stream;
      std::copy_n(&model.constants[book * model.densities], model.densities, fits.begin());
      for (std::size_t i = 0; i < kCepstra; ++i) {
        const float* mean = &model.means[(book * kCepstra + i) * model.densities];
        const float* precision = &model.precisions[(book * kCepstra + i) * model.densities];
        const float value = frame[stream][i];
        for (std::size_t d = 0; d < model.densities; ++d) {
          const float difference = value - mean[d];
          fits[d] -= difference * difference * precision[d];
        }
      }
      const float best = *std::max_element(fits.begin(), fits.end());
      for (float& fit : fits) fit = exp_below(fit - best);
      for (std::size_t part = 0; part < kStatesPerPhone; ++part) {
        const float* weight = &model.weights[(book * kStatesPerPhone + part) * model.densities];
        float sum = 1e-30f;
        for (std::size_t d = 0; d < model.densities; ++d) sum += weight[d] * fits[d];
        out[part] += best + std::log(sum);
      }
    }
  }
}

}  // namespace animeme::voice

#include "tools/speech/voice/rate_change.h"

#include <speex/speex_resampler.h>

#include <algorithm>

#include "tools/speech/voice/align.h"

namespace animeme::voice {

namespace {

constexpr int kQuality = 5;  // of 10: its filter delays by a few milliseconds
constexpr int kSlowest = 4000, kFastest = 384000;
constexpr std::size_t kMostAtOnce = 4096;

struct FreeResampler {
  void operator()(SpeexResamplerState* state) const { speex_resampler_destroy(state); }
};

class SpeexRate : public RateChange {
 public:
  explicit SpeexRate(SpeexResamplerState* state) : state_(state) {
    speex_resampler_skip_zeros(state);
  }
  void push(std::span<const float> samples, std::vector<float>& out) override {
    float block[kMostAtOnce];
    while (!samples.empty()) {
      auto in = spx_uint32_t(std::min(samples.size(), kMostAtOnce));
      auto made = spx_uint32_t(kMostAtOnce);
      speex_resampler_process_float(state_.get(), 0, samples.data(), &in, block, &made);
      out.insert(out.end(), block, block + made);
      if (in == 0 && made == 0) return;
      samples = samples.subspan(in);
    }
  }

 private:
  std::unique_ptr<SpeexResamplerState, FreeResampler> state_;
};

class SameRate : public RateChange {
 public:
  void push(std::span<const float> samples, std::vector<float>& out) override {
    out.insert(out.end(), samples.begin(), samples.end());
  }
};

}  // namespace

Result<std::unique_ptr<RateChange>> RateChange::open(int rate) {
  if (rate < kSlowest || rate > kFastest) {
    return make_error(Code::invalid_argument,
                      "sound of " + std::to_string(rate) + " Hz; 4000 to 384000 are heard");
  }
  std::unique_ptr<RateChange> change;
  if (rate == kAlignRate) {
    change = std::make_unique<SameRate>();
    return change;
  }
  int error = 0;
  SpeexResamplerState* state =
      speex_resampler_init(1, spx_uint32_t(rate), spx_uint32_t(kAlignRate), kQuality, &error);
  if (state == nullptr) return make_error(Code::io, "the change of the rate cannot be set up");
  change = std::make_unique<SpeexRate>(state);
  return change;
}

}  // namespace animeme::voice

// libswresample for one stretch of sound with a constant format: anything to float, in one channel
// or two. Two channels are mixed to one by StereoMix.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/sound/stereo_mix.h"

namespace animeme::media {

inline constexpr int kLowestRate = 1000;
inline constexpr int kHighestRate = 384000;
inline constexpr std::size_t kMostSamples = std::size_t(1) << 29;

/// What a decoder delivers; a change of it needs a new Resampler.
struct SoundFormat {
  int sample_rate = 0;
  AVSampleFormat format = AV_SAMPLE_FMT_NONE;
  int channels = 0;
  std::uint64_t mask = 0;  ///< 0: unspecified layout

  friend bool operator==(const SoundFormat&, const SoundFormat&) = default;
};

class Resampler {
 public:
  /// Appends to `out`, which must outlive the resampler: samples, or pairs for two `channels`. They
  /// may be taken from it meanwhile.
  static Result<Resampler> open(const SoundFormat& from, int sample_rate, std::vector<float>& out,
                                int channels = 1);

  /// `planes` as in AVFrame::extended_data. Error: out_of_range, syntax.
  Result<void> add(const std::uint8_t* const* planes, int count);
  Result<void> add_silence(std::int64_t count);
  /// Drains what is left and makes the length exact: input length x rate ratio, rounded.
  /// Error: out_of_range.
  Result<void> finish();

  const SoundFormat& from() const { return from_; }

 private:
  Result<void> convert(const std::uint8_t** planes, int count);

  SoundFormat from_;
  int rate_ = 0;
  std::size_t channels_ = 1;  // of what comes out
  av::Swr swr_;
  std::optional<StereoMix> stereo_;  // swr_ makes pairs, which become one channel
  std::vector<float> pairs_;
  std::vector<float>* out_ = nullptr;
  std::int64_t taken_ = 0;  // of each channel
  std::int64_t given_ = 0;
};

}  // namespace animeme::media

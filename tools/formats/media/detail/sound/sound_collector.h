// Decoded frames as samples one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/formats/media/audio.h"
#include "tools/formats/media/detail/sound/audio_decoder.h"
#include "tools/formats/media/detail/sound/resampler.h"

namespace animeme::media {

/// Puts decoded frames one after the other on a time line that begins with the first of them.
class SoundCollector {
 public:
  SoundCollector(const Input& input, const AVStream& stream, const ReadAudioOptions& options)
      : input_(input), stream_(stream), options_(options) {}

  /// Errors: out_of_range (too long, a gap that is), syntax.
  Result<void> add(AVFrame& frame);
  /// There are no more frames. Errors: those of add(); syntax (there was none).
  Result<void> finish();
  /// Of the samples; 0: not known before the first frame.
  int sample_rate() const { return rate_; }
  /// Moves what is certain to be sound to `out`.
  void take(std::vector<float>& out);

 private:
  std::optional<std::int64_t> stated_end() const;
  std::int64_t count() const { return given_ + std::int64_t(samples_.size()); }
  Result<void> change_format(const SoundFormat& format);
  Result<void> fill_gap(const AVFrame& frame);
  Result<void> check_length() const;
  int drop_before_start(const AVFrame& frame);

  const Input& input_;
  const AVStream& stream_;
  const ReadAudioOptions& options_;
  int rate_ = 0;
  std::vector<float> samples_;  // made and not yet taken
  std::int64_t given_ = 0;      // taken
  bool finished_ = false;
  std::optional<Resampler> resampler_;
  std::int64_t start_ = AV_NOPTS_VALUE;  // time stamp of sample 0, stream time base
  std::int64_t next_ = AV_NOPTS_VALUE;   // expected time stamp, in samples of the source
};

}  // namespace animeme::media

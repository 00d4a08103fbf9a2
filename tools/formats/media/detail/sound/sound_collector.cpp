#include "tools/formats/media/detail/sound/sound_collector.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace animeme::media {
namespace {

// Time stamps of some containers are rounded to milliseconds; only more than this is a gap.
constexpr int kSilencePerSecond = 50;
// A longer gap in a format that may restart its clock (TS) is a restart, not silence.
constexpr std::int64_t kLongestRestartGap = 10;
constexpr double kLongestGap = 3 * 3600;  // seconds; silence is made at once

SoundFormat format_of(const AVFrame& frame) {
  const bool native = frame.ch_layout.order == AV_CHANNEL_ORDER_NATIVE;
  return {frame.sample_rate, AVSampleFormat(frame.format), frame.ch_layout.nb_channels,
          native ? frame.ch_layout.u.mask : 0};
}

}  // namespace

Result<void> SoundCollector::change_format(const SoundFormat& format) {
  if (resampler_) {
    Result<void> finished = resampler_->finish();
    if (!finished) return finished;
  }
  if (rate_ == 0) rate_ = options_.sample_rate > 0 ? options_.sample_rate : format.sample_rate;
  Result<Resampler> made = Resampler::open(format, rate_, samples_);
  if (!made) return made.error();
  resampler_.emplace(std::move(*made));
  next_ = AV_NOPTS_VALUE;
  return {};
}

// Samples at the head of a frame that lie before the edit list's start.
int SoundCollector::drop_before_start(const AVFrame& frame) {
  if (start_ != AV_NOPTS_VALUE && start_ > 0) return 0;
  if (!input_.is_mp4_family() || frame.pts >= 0 || frame.pts == AV_NOPTS_VALUE) return 0;
  const std::int64_t early = av_rescale_q(frame.pts, stream_.time_base, {1, frame.sample_rate});
  return int(std::clamp<std::int64_t>(-early, 0, frame.nb_samples));
}

Result<void> SoundCollector::fill_gap(const AVFrame& frame) {
  if (frame.pts == AV_NOPTS_VALUE || next_ == AV_NOPTS_VALUE) return {};
  const std::int64_t now = av_rescale_q(frame.pts, stream_.time_base, {1, frame.sample_rate});
  const std::int64_t gap = now - next_;
  if (gap <= frame.sample_rate / kSilencePerSecond) return {};
  const bool restarts = (input_.context()->iformat->flags & AVFMT_TS_DISCONT) != 0;
  if (restarts && gap > kLongestRestartGap * frame.sample_rate) return {};
  const double seconds = double(gap) / double(frame.sample_rate);
  const double limit = std::min(options_.max_seconds, kLongestGap);
  if (seconds > limit) {
    return make_error(Code::out_of_range, "the sound has a gap longer than the limit of " +
                                              std::to_string(std::llround(limit)) +
                                              " s; the file is probably damaged");
  }
  return resampler_->add_silence(gap);
}

Result<void> SoundCollector::check_length() const {
  if (double(count()) <= options_.max_seconds * double(rate_)) return {};
  return make_error(Code::out_of_range, "the sound is longer than the limit of " +
                                            std::to_string(std::llround(options_.max_seconds)) +
                                            " s; raise the limit or cut the file");
}

Result<void> SoundCollector::add(AVFrame& frame) {
  if (frame.nb_samples <= 0) return {};
  const SoundFormat format = format_of(frame);
  if (!resampler_ || resampler_->from() != format) {
    Result<void> changed = change_format(format);
    if (!changed) return changed;
  }
  const int drop = drop_before_start(frame);
  const int count = frame.nb_samples - drop;
  if (count == 0) return {};
  if (start_ == AV_NOPTS_VALUE && frame.pts != AV_NOPTS_VALUE) {
    start_ = first_played(input_, frame.pts);
  }
  Result<void> filled = fill_gap(frame);
  if (!filled) return filled;
  const bool planar = av_sample_fmt_is_planar(format.format) != 0;
  const int stride = av_get_bytes_per_sample(format.format) * (planar ? 1 : format.channels);
  std::vector<const std::uint8_t*> planes(planar ? std::size_t(format.channels) : 1);
  for (std::size_t c = 0; c < planes.size(); ++c) {
    planes[c] = frame.extended_data[c] + std::ptrdiff_t(drop) * stride;
  }
  Result<void> added = resampler_->add(planes.data(), count);
  if (!added) return added;
  if (frame.pts != AV_NOPTS_VALUE) {
    next_ = av_rescale_q(frame.pts, stream_.time_base, {1, frame.sample_rate}) + frame.nb_samples;
  } else if (next_ != AV_NOPTS_VALUE) {
    next_ += frame.nb_samples;
  }
  return check_length();
}

// The sample behind the last one, where the file tells it.
std::optional<std::int64_t> SoundCollector::stated_end() const {
  const std::optional<std::int64_t> told = end_of_sound(input_, stream_);
  if (!told || start_ == AV_NOPTS_VALUE || rate_ == 0) return {};
  const std::int64_t end = av_rescale_q(*told - start_, stream_.time_base, {1, rate_});
  return end > 0 ? std::optional(end) : std::nullopt;
}

Result<void> SoundCollector::finish() {
  if (!resampler_) return make_error(Code::syntax, "nothing in the audio track can be decoded");
  Result<void> done = resampler_->finish();
  if (!done) return done;
  finished_ = true;
  if (const auto end = stated_end();
      end && count() > *end && *end >= given_ && count() - *end <= rate_ / kPaddingPerSecond) {
    samples_.resize(std::size_t(*end - given_));
  }
  if (auto fits = check_length(); !fits) return fits;
  if (count() == 0) return make_error(Code::syntax, "the audio track is empty");
  return {};
}

void SoundCollector::take(std::vector<float>& out) {
  // What lies behind the stated end stays until it is clear whether that is padding.
  const auto end = finished_ ? std::nullopt : stated_end();
  const bool padding = end && count() > *end && count() - *end <= rate_ / kPaddingPerSecond;
  const std::int64_t sure =
      padding ? std::max<std::int64_t>(*end - given_, 0) : std::int64_t(samples_.size());
  const auto border = samples_.begin() + std::ptrdiff_t(sure);
  out.assign(samples_.begin(), border);
  samples_.erase(samples_.begin(), border);
  given_ += sure;
}

}  // namespace animeme::media

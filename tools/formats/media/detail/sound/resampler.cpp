#include "tools/formats/media/detail/sound/resampler.h"

#include <algorithm>
#include <string>

#include "tools/formats/media/audio.h"

namespace animeme::media {

Result<Resampler> Resampler::open(const SoundFormat& from, int sample_rate, std::vector<float>& out,
                                  int channels) {
  if (from.sample_rate < kLowestRate || from.sample_rate > kHighestRate || from.channels <= 0) {
    return make_error(Code::out_of_range, "a sample rate of " + std::to_string(from.sample_rate) +
                                              " Hz is not supported; 1000 to 384000 Hz are");
  }
  AVChannelLayout layout{};
  if (from.mask == 0 || av_channel_layout_from_mask(&layout, from.mask) < 0) {
    av_channel_layout_default(&layout, from.channels);
  }
  const bool stereo = from.channels == 2 && (from.mask == 0 || from.mask == AV_CH_LAYOUT_STEREO);
  AVChannelLayout to = AV_CHANNEL_LAYOUT_MONO;
  if (stereo || channels == 2) to = AV_CHANNEL_LAYOUT_STEREO;
  SwrContext* raw = nullptr;
  const int made = swr_alloc_set_opts2(&raw, &to, AV_SAMPLE_FMT_FLT, sample_rate, &layout,
                                       from.format, from.sample_rate, 0, nullptr);
  av_channel_layout_uninit(&layout);
  Resampler resampler;
  resampler.swr_.reset(raw);
  const int status = made < 0 ? made : swr_init(raw);
  if (status < 0) {
    return make_error(Code::unsupported,
                      std::to_string(from.channels) + " channels cannot be mixed down to " +
                          std::to_string(channels) + ": " + av::error_text(status));
  }
  if (stereo && channels == 1) resampler.stereo_.emplace(sample_rate);
  resampler.channels_ = std::size_t(channels);
  resampler.from_ = from;
  resampler.rate_ = sample_rate;
  resampler.out_ = &out;
  return resampler;
}

Result<void> Resampler::convert(const std::uint8_t** planes, int count) {
  const int room = swr_get_out_samples(swr_.get(), count);
  if (room < 0) return av::make_av_error(room, "the sound cannot be resampled");
  const std::size_t old = out_->size();
  if (old + std::size_t(room) > kMostSamples + (std::size_t(1) << 20)) {
    return make_error(Code::out_of_range, "the sound is too long");
  }
  const bool mixes = stereo_.has_value();
  const std::size_t each = mixes ? 2 : channels_;
  std::vector<float>& made = mixes ? pairs_ : *out_;
  const std::size_t begin = mixes ? 0 : old;
  made.resize(begin + std::size_t(room) * each);
  auto* target = reinterpret_cast<std::uint8_t*>(made.data() + begin);
  const int got = swr_convert(swr_.get(), &target, room, planes, count);
  made.resize(begin + std::size_t(std::max(got, 0)) * each);
  if (mixes) stereo_->mix(pairs_, *out_);
  if (got < 0) return av::make_av_error(got, "the sound cannot be resampled");
  given_ += got;
  return {};
}

Result<void> Resampler::add(const std::uint8_t* const* planes, int count) {
  taken_ += count;
  // The older signature of swr_convert() lacks a const; the data is not written to.
  return convert(const_cast<const std::uint8_t**>(planes), count);
}

Result<void> Resampler::add_silence(std::int64_t count) {
  constexpr std::int64_t kStep = 4096;
  const bool planar = av_sample_fmt_is_planar(from_.format) != 0;
  const std::size_t plane_count = planar ? std::size_t(from_.channels) : 1;
  const std::size_t stride = std::size_t(av_get_bytes_per_sample(from_.format)) *
                             (planar ? 1 : std::size_t(from_.channels));
  std::vector<std::uint8_t> zeros(stride * kStep);
  std::vector<std::uint8_t*> planes(plane_count, zeros.data());
  av_samples_set_silence(planes.data(), 0, int(kStep), from_.channels, from_.format);
  for (std::int64_t left = count; left > 0; left -= kStep) {
    Result<void> added = add(planes.data(), int(std::min(left, kStep)));
    if (!added) return added;
  }
  return {};
}

Result<void> Resampler::finish() {
  Result<void> drained = convert(nullptr, 0);
  if (!drained) return drained;
  const std::int64_t exact = av_rescale_rnd(taken_, rate_, from_.sample_rate, AV_ROUND_NEAR_INF);
  const std::int64_t size = std::int64_t(out_->size()) + (exact - given_) * std::int64_t(channels_);
  if (exact < 0 || size > std::int64_t(kMostSamples)) {
    return make_error(Code::out_of_range, "the sound is too long");
  }
  out_->resize(std::size_t(std::max<std::int64_t>(size, 0)), 0.0f);
  return {};
}

Result<Pcm> resample(const Pcm& pcm, int sample_rate) {
  return av::guarded([&]() -> Result<Pcm> {
    const av::LogCapture log;
    if (sample_rate < kLowestRate || sample_rate > kHighestRate) {
      return make_error(Code::invalid_argument, "the sample rate must be 1000 to 384000 Hz");
    }
    Pcm result{sample_rate, {}};
    if (pcm.sample_rate == sample_rate) return pcm;
    Result<Resampler> resampler = Resampler::open(
        {pcm.sample_rate, AV_SAMPLE_FMT_FLT, 1, AV_CH_LAYOUT_MONO}, sample_rate, result.samples);
    if (!resampler) return make_error(Code::invalid_argument, resampler.error().message);
    constexpr std::size_t kBlock = 65536;
    for (std::size_t at = 0; at < pcm.samples.size(); at += kBlock) {
      const auto* plane = reinterpret_cast<const std::uint8_t*>(pcm.samples.data() + at);
      const std::size_t count = std::min(kBlock, pcm.samples.size() - at);
      Result<void> added = resampler->add(&plane, int(count));
      if (!added) return added.error();
    }
    Result<void> finished = resampler->finish();
    if (!finished) return finished.error();
    return result;
  });
}

}  // namespace animeme::media

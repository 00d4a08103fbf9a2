#include "tools/media/audio.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/media/detail/audio_decoder.h"
#include "tools/media/detail/presentation.h"
#include "tools/media/detail/resampler.h"

namespace animeme::media {
namespace {

// Time stamps of some containers are rounded to milliseconds; only more than this is a gap.
constexpr int kSilencePerSecond = 50;
// A longer gap in a format that may restart its clock (TS) is a restart, not silence.
constexpr std::int64_t kLongestRestartGap = 10;

// Puts decoded frames one after the other on a time line that begins with the first of them.
class SoundCollector {
 public:
  SoundCollector(const Input& input, const AVStream& stream, const ReadAudioOptions& options)
      : input_(input), stream_(stream), options_(options) {}

  Result<void> add(AVFrame& frame);
  Result<Pcm> finish();

 private:
  Result<void> change_format(const SoundFormat& format);
  Result<void> fill_gap(const AVFrame& frame);
  Result<void> check_length() const;
  int drop_before_start(const AVFrame& frame);

  const Input& input_;
  const AVStream& stream_;
  const ReadAudioOptions& options_;
  Pcm pcm_{0, {}};
  std::optional<Resampler> resampler_;
  std::int64_t start_ = AV_NOPTS_VALUE;  // time stamp of sample 0, stream time base
  std::int64_t next_ = AV_NOPTS_VALUE;   // expected time stamp, in samples of the source
};

SoundFormat format_of(const AVFrame& frame) {
  const bool native = frame.ch_layout.order == AV_CHANNEL_ORDER_NATIVE;
  return {frame.sample_rate, AVSampleFormat(frame.format), frame.ch_layout.nb_channels,
          native ? frame.ch_layout.u.mask : 0};
}

Result<void> SoundCollector::change_format(const SoundFormat& format) {
  if (resampler_) {
    Result<void> finished = resampler_->finish();
    if (!finished) return finished;
  }
  if (pcm_.sample_rate == 0) {
    pcm_.sample_rate = options_.sample_rate > 0 ? options_.sample_rate : format.sample_rate;
  }
  Result<Resampler> made = Resampler::open(format, pcm_.sample_rate, pcm_.samples);
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
  if (seconds > options_.max_seconds) {
    return make_error(Code::out_of_range, "the sound has a gap longer than the limit of " +
                                              std::to_string(std::llround(options_.max_seconds)) +
                                              " s; the file is probably damaged");
  }
  return resampler_->add_silence(gap);
}

Result<void> SoundCollector::check_length() const {
  const double limit = options_.max_seconds * double(pcm_.sample_rate);
  if (double(pcm_.samples.size()) <= std::min(limit, double(kMostSamples))) return {};
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

Result<Pcm> SoundCollector::finish() {
  if (!resampler_) return make_error(Code::syntax, "nothing in the audio track can be decoded");
  Result<void> finished = resampler_->finish();
  if (!finished) return finished.error();
  const std::optional<std::int64_t> told = end_of_sound(input_, stream_);
  if (told && start_ != AV_NOPTS_VALUE) {
    const std::int64_t end = av_rescale_q(*told - start_, stream_.time_base, {1, pcm_.sample_rate});
    const std::int64_t surplus = std::int64_t(pcm_.samples.size()) - end;
    if (end > 0 && surplus > 0 && surplus <= pcm_.sample_rate / kPaddingPerSecond) {
      pcm_.samples.resize(std::size_t(end));
    }
  }
  Result<void> fits = check_length();
  if (!fits) return fits.error();
  if (pcm_.samples.empty()) return make_error(Code::syntax, "the audio track is empty");
  return std::move(pcm_);
}

void warn(const ReadAudioOptions& options, std::string text) {
  if (options.warnings != nullptr) options.warnings->push_back(std::move(text));
}

Result<Pcm> decode_all(Input& input, const ReadAudioOptions& options) {
  Result<AVStream*> chosen = choose_audio(input);
  if (!chosen) return chosen.error();
  const AVStream& stream = **chosen;
  Result<av::Codec> codec = open_audio_decoder(*stream.codecpar, stream.time_base);
  if (!codec) return codec.error();

  SoundCollector sound(input, stream, options);
  const auto take = [&](AVFrame& frame) { return sound.add(frame); };
  const av::Frame frame(av_frame_alloc());
  if (!frame) return av::no_memory();
  std::int64_t damaged = 0;
  const auto decode = [&](AVPacket& packet) -> Result<void> {
    Result<bool> good = decode_packet(**codec, &packet, *frame, take);
    if (!good) return good.error();
    if (!*good) ++damaged;
    return {};
  };
  Result<int> status = read_packets(input, stream.index, decode);
  if (!status) return status.error();
  Result<bool> flushed = decode_packet(**codec, nullptr, *frame, take);
  if (!flushed) return flushed.error();
  if (damaged > 0) warn(options, std::to_string(damaged) + " damaged audio packets were skipped");
  if (*status != AVERROR_EOF || input.exhausted()) {
    warn(options, "the file ends early or is damaged: " + av::error_text(*status));
  }
  return sound.finish();
}

Result<void> check(const ReadAudioOptions& options) {
  const int rate = options.sample_rate;
  if (rate != 0 && (rate < kLowestRate || rate > kHighestRate)) {
    return make_error(Code::invalid_argument, "the sample rate must be 1000 to 384000 Hz, or 0");
  }
  if (!(options.max_seconds > 0)) {
    return make_error(Code::invalid_argument, "the longest duration must be positive");
  }
  return {};
}

template <class Source>
Result<Pcm> read_from(const Source& source, const ReadAudioOptions& options) {
  Result<void> legal = check(options);
  if (!legal) return legal.error();
  const av::LogCapture log;
  Result<std::unique_ptr<Input>> input = Input::open(source, nullptr);
  if (!input) return input.error();
  return decode_all(**input, options);
}

}  // namespace

Result<Pcm> read_audio(const std::string& path, const ReadAudioOptions& options) {
  return av::guarded(path, [&] {
    return read_sound_of(path, [&](const auto& source) { return read_from(source, options); });
  });
}

Result<Pcm> read_audio(std::span<const std::uint8_t> file, const ReadAudioOptions& options) {
  return av::guarded([&] { return read_from(file, options); });
}

}  // namespace animeme::media

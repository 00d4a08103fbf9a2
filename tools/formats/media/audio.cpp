#include "tools/formats/media/audio.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/sound/audio_decoder.h"
#include "tools/formats/media/detail/sound/resampler.h"

namespace animeme::media {

namespace {

// Puts decoded frames one after the other on a time line that begins with the first of them.
class SoundCollector {
 public:
  SoundCollector(const Input& input, const AVStream& stream, const ReadAudioOptions& options)
      : input_(input), stream_(stream), options_(options) {}

  // Errors: out_of_range (too long, a gap that is), syntax.
  Result<void> add(AVFrame& frame);
  // There are no more frames. Errors: those of add(); syntax (there was none).
  Result<void> finish();
  // Of the samples; 0: not known before the first frame.
  int sample_rate() const { return rate_; }
  int channels() const { return channels_; }
  // Moves what is certain to be sound to `out`.
  void take(std::vector<float>& out);

 private:
  std::optional<std::int64_t> stated_end() const;
  // Samples of each channel.
  std::int64_t made() const { return std::int64_t(samples_.size()) / channels_; }
  std::int64_t count() const { return given_ + made(); }
  Result<void> change_format(const SoundFormat& format);
  Result<void> fill_gap(const AVFrame& frame);
  Result<void> check_length() const;
  int drop_before_start(const AVFrame& frame);

  const Input& input_;
  const AVStream& stream_;
  const ReadAudioOptions& options_;
  int rate_ = 0;
  int channels_ = 1;
  std::vector<float> samples_;  // made and not yet taken
  std::int64_t given_ = 0;      // taken, of each channel
  bool finished_ = false;
  std::optional<Resampler> resampler_;
  std::int64_t start_ = AV_NOPTS_VALUE;  // time stamp of sample 0, stream time base
  std::int64_t next_ = AV_NOPTS_VALUE;   // expected time stamp, in samples of the source
};

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

Result<void> SoundCollector::change_format(const SoundFormat& format) {
  if (resampler_) {
    Result<void> finished = resampler_->finish();
    if (!finished) return finished;
  }
  if (rate_ == 0) {
    rate_ = options_.sample_rate > 0 ? options_.sample_rate : format.sample_rate;
    const int told = std::max(format.channels, stream_.codecpar->ch_layout.nb_channels);
    channels_ = std::clamp(told, 1, options_.most_channels);
  }
  Result<Resampler> made = Resampler::open(format, rate_, samples_, channels_);
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

// The end in samples, if the file states it.
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
    samples_.resize(std::size_t((*end - given_) * channels_));
  }
  if (auto fits = check_length(); !fits) return fits;
  if (count() == 0) return make_error(Code::syntax, "the audio track is empty");
  return {};
}

void SoundCollector::take(std::vector<float>& out) {
  // What lies behind the stated end stays until it is clear whether that is padding.
  const auto end = finished_ ? std::nullopt : stated_end();
  const bool padding = end && count() > *end && count() - *end <= rate_ / kPaddingPerSecond;
  const std::int64_t sure = padding ? std::max<std::int64_t>(*end - given_, 0) : made();
  const auto border = samples_.begin() + std::ptrdiff_t(sure * channels_);
  out.assign(samples_.begin(), border);
  samples_.erase(samples_.begin(), border);
  given_ += sure;
}

void warn(const ReadAudioOptions& options, std::string text) {
  if (options.warnings != nullptr) options.warnings->push_back(std::move(text));
}

Result<void> check(const ReadAudioOptions& options) {
  const int rate = options.sample_rate;
  if (rate != 0 && (rate < kLowestRate || rate > kHighestRate)) {
    return make_error(Code::invalid_argument, "the sample rate must be 1000 to 384000 Hz, or 0");
  }
  if (!(options.max_seconds > 0)) {
    return make_error(Code::invalid_argument, "the longest duration must be positive");
  }
  if (options.most_channels != 1 && options.most_channels != 2) {
    return make_error(Code::invalid_argument, "sound is read in one or two channels");
  }
  return {};
}

}  // namespace

struct AudioReader::Impl {
  std::vector<std::uint8_t> memory;  // of a playlist
  std::unique_ptr<Input> input;
  AVStream* stream = nullptr;
  av::Codec codec;
  av::Frame frame;
  av::Packet packet;
  ReadAudioOptions options;
  std::optional<SoundCollector> sound;
  std::vector<float> block;  // given out
  bool begun = false;        // `block` waits to be given out
  bool ended = false;
  std::int64_t damaged = 0;

  template <class Source>
  Result<void> open(const Source& source);
  Result<void> fill();

 private:
  Result<void> read_one();
  Result<void> end(int status);
};

template <class Source>
Result<void> AudioReader::Impl::open(const Source& source) {
  Result<std::unique_ptr<Input>> opened = Input::open(source, nullptr);
  if (!opened) return opened.error();
  input = std::move(*opened);
  Result<AVStream*> chosen = choose_audio(*input);
  if (!chosen) return chosen.error();
  stream = *chosen;
  Result<av::Codec> decoder = open_audio_decoder(*stream->codecpar, stream->time_base);
  if (!decoder) return decoder.error();
  codec = std::move(*decoder);
  frame.reset(av_frame_alloc());
  packet.reset(av_packet_alloc());
  if (!frame || !packet) return av::no_memory();
  sound.emplace(*input, *stream, options);
  begun = true;
  return fill();
}

// Reads until there is a block, or no more.
Result<void> AudioReader::Impl::fill() {
  constexpr std::size_t kBlock = 1 << 14;  // samples
  block.clear();
  std::vector<float> part;
  while (!ended && block.size() < kBlock) {
    if (auto done = read_one(); !done) return done;
    sound->take(part);
    block.insert(block.end(), part.begin(), part.end());
  }
  return {};
}

Result<void> AudioReader::Impl::read_one() {
  const int status = av_read_frame(input->context(), packet.get());
  if (status < 0) return end(status);
  Result<bool> good = true;
  if (packet->stream_index == stream->index) {
    good = decode_packet(*codec, packet.get(), *frame, [&](AVFrame& f) { return sound->add(f); });
  }
  av_packet_unref(packet.get());
  if (!good) return good.error();
  if (!*good) ++damaged;
  return {};
}

Result<void> AudioReader::Impl::end(int status) {
  ended = true;
  Result<bool> flushed =
      decode_packet(*codec, nullptr, *frame, [&](AVFrame& f) { return sound->add(f); });
  if (!flushed) return flushed.error();
  if (damaged > 0) warn(options, std::to_string(damaged) + " damaged audio packets were skipped");
  if (status != AVERROR_EOF || input->exhausted()) {
    warn(options, "the file ends early or is damaged: " + av::error_text(status));
  }
  return sound->finish();
}

AudioReader::AudioReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
AudioReader::AudioReader(AudioReader&&) noexcept = default;
AudioReader& AudioReader::operator=(AudioReader&&) noexcept = default;
AudioReader::~AudioReader() = default;

Result<AudioReader> AudioReader::open(std::span<const std::uint8_t> file,
                                      const ReadAudioOptions& options) {
  return av::guarded([&]() -> Result<AudioReader> {
    if (auto legal = check(options); !legal) return legal.error();
    const av::LogCapture log;
    auto impl = std::make_unique<Impl>();
    impl->options = options;
    if (auto opened = impl->open(file); !opened) return opened.error();
    return AudioReader(std::move(impl));
  });
}

Result<AudioReader> AudioReader::open(const std::string& path, const ReadAudioOptions& options) {
  return av::guarded(path, [&]() -> Result<AudioReader> {
    if (auto legal = check(options); !legal) return legal.error();
    const av::LogCapture log;
    auto impl = std::make_unique<Impl>();
    impl->options = options;
    Result<void> opened;
    if (is_playlist(path)) {
      Result<std::vector<std::uint8_t>> sound = sound_of_playlist(path);
      if (!sound) return sound.error();
      impl->memory = std::move(*sound);
      opened = impl->open(std::span<const std::uint8_t>(impl->memory));
    } else {
      opened = impl->open(path);
    }
    if (!opened) return opened.error();
    return AudioReader(std::move(impl));
  });
}

int AudioReader::sample_rate() const { return impl_->sound->sample_rate(); }

int AudioReader::channels() const { return impl_->sound->channels(); }

double AudioReader::told_seconds() const {
  const std::int64_t told = impl_->input->context()->duration;
  return told == AV_NOPTS_VALUE || told < 0 ? 0 : double(told) / AV_TIME_BASE;
}

Result<std::span<const float>> AudioReader::next() {
  return av::guarded([&]() -> Result<std::span<const float>> {
    const av::LogCapture log;
    if (!std::exchange(impl_->begun, false)) {
      if (auto done = impl_->fill(); !done) return done.error();
    }
    return std::span<const float>(impl_->block);
  });
}

namespace {

template <class Source>
Result<Pcm> read_all(const Source& source, const ReadAudioOptions& options) {
  ReadAudioOptions mono = options;
  mono.most_channels = 1;
  Result<AudioReader> reader = AudioReader::open(source, mono);
  if (!reader) return reader.error();
  return av::guarded([&]() -> Result<Pcm> {
    Pcm pcm{reader->sample_rate(), {}};
    for (;;) {
      const Result<std::span<const float>> block = reader->next();
      if (!block) return block.error();
      if (block->empty()) return pcm;
      if (pcm.samples.size() + block->size() > kMostSamples) {
        return make_error(Code::out_of_range,
                          "the sound is longer than 2^29 samples; cut the file");
      }
      pcm.samples.insert(pcm.samples.end(), block->begin(), block->end());
    }
  });
}

}  // namespace

Result<Pcm> read_audio(const std::string& path, const ReadAudioOptions& options) {
  return av::guarded(path, [&] { return read_all(path, options); });
}

Result<Pcm> read_audio(std::span<const std::uint8_t> file, const ReadAudioOptions& options) {
  return read_all(file, options);
}

}  // namespace animeme::media

#include "tools/formats/media/audio.h"

#include <optional>
#include <utility>

#include "tools/formats/media/detail/segments/presentation.h"
#include "tools/formats/media/detail/sound/audio_decoder.h"
#include "tools/formats/media/detail/sound/resampler.h"
#include "tools/formats/media/detail/sound/sound_collector.h"

namespace animeme::media {
namespace {

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
  Result<AudioReader> reader = AudioReader::open(source, options);
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

// 16-bit WAV output.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "tools/formats/files/output_file.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"

namespace animeme::media {
namespace {

constexpr std::size_t kHeaderSize = 44;

using Header = std::array<std::uint8_t, kHeaderSize>;

void put(Header& header, std::size_t at, std::uint32_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) header[at + i] = std::uint8_t(value >> (8 * i));
}

Header make_header(std::uint32_t sample_rate, std::uint32_t data_bytes) {
  Header header{};
  std::memcpy(header.data(), "RIFF....WAVEfmt ", 16);
  std::memcpy(header.data() + 36, "data", 4);
  put(header, 4, data_bytes + std::uint32_t(kHeaderSize) - 8, 4);
  put(header, 16, 16, 4);  // size of the format chunk
  put(header, 20, 1, 2);   // PCM
  put(header, 22, 1, 2);   // channels
  put(header, 24, sample_rate, 4);
  put(header, 28, sample_rate * 2, 4);  // bytes a second
  put(header, 32, 2, 2);                // bytes a sample
  put(header, 34, 16, 2);               // bits a sample
  put(header, 40, data_bytes, 4);
  return header;
}

// 32768 is the factor that readers divide by, so 16-bit sound survives a round trip.
std::int16_t to_s16(float sample) {
  if (std::isnan(sample)) return 0;
  return std::int16_t(std::lround(std::clamp(double(sample) * 32768.0, -32768.0, 32767.0)));
}

bool write_samples(std::FILE* file, std::span<const float> samples) {
  std::vector<std::uint8_t> block;
  constexpr std::size_t kBlock = 32768;
  for (std::size_t at = 0; at < samples.size(); at += kBlock) {
    const std::size_t end = std::min(at + kBlock, samples.size());
    block.clear();
    for (std::size_t i = at; i < end; ++i) {
      const auto value = std::uint16_t(to_s16(samples[i]));
      block.push_back(std::uint8_t(value & 255));
      block.push_back(std::uint8_t(value >> 8));
    }
    if (std::fwrite(block.data(), 1, block.size(), file) != block.size()) return false;
  }
  return true;
}

constexpr std::size_t kMostSamples = (0xffffffffu - kHeaderSize) / 2;

Error cannot_write(const std::string& path, int reason) {
  return make_error(Code::io, std::string("cannot be written: ") + std::strerror(reason))
      .in_file(path);
}

Result<void> write(const std::string& path, const Pcm& pcm) {
  if (pcm.sample_rate <= 0) {
    return make_error(Code::invalid_argument, "the sample rate must be positive").in_file(path);
  }
  if (pcm.samples.size() > kMostSamples) {
    return make_error(Code::out_of_range, "a WAV file cannot be larger than 4 GB").in_file(path);
  }
  tools::OutputFile out(path);
  const Result<std::string> place = out.place();
  if (!place) return place.error();
  std::FILE* file = std::fopen(place->c_str(), "wb");
  bool good = file != nullptr;
  if (good) {
    const Header header =
        make_header(std::uint32_t(pcm.sample_rate), std::uint32_t(pcm.samples.size() * 2));
    good = std::fwrite(header.data(), 1, header.size(), file) == header.size() &&
           write_samples(file, pcm.samples);
  }
  int reason = errno;
  if (file != nullptr && std::fclose(file) != 0) {
    if (good) reason = errno;
    good = false;
  }
  if (!good) return cannot_write(path, reason);
  return out.publish();
}

}  // namespace

Result<void> write_wav(const std::string& path, const Pcm& pcm) {
  return av::guarded([&] { return write(path, pcm); });
}

struct WavWriter::Impl {
  std::string path;
  int sample_rate = 0;
  std::FILE* file = nullptr;
  std::size_t samples = 0;

  Impl(std::string name, int rate) : path(std::move(name)), sample_rate(rate) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (file != nullptr) std::fclose(file);
  }
  bool put_header() const {
    const Header header = make_header(std::uint32_t(sample_rate), std::uint32_t(samples * 2));
    return std::fwrite(header.data(), 1, header.size(), file) == header.size();
  }
};

WavWriter::WavWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
WavWriter::WavWriter(WavWriter&&) noexcept = default;
WavWriter& WavWriter::operator=(WavWriter&&) noexcept = default;
WavWriter::~WavWriter() = default;

Result<WavWriter> WavWriter::open(const std::string& path, int sample_rate) {
  if (sample_rate <= 0) {
    return make_error(Code::invalid_argument, "the sample rate must be positive").in_file(path);
  }
  auto impl = std::make_unique<Impl>(path, sample_rate);
  impl->file = std::fopen(path.c_str(), "wbe");
  if (impl->file == nullptr || !impl->put_header()) return cannot_write(path, errno);
  return WavWriter(std::move(impl));
}

Result<void> WavWriter::write(std::span<const float> samples) {
  if (samples.size() > kMostSamples - impl_->samples) {
    return make_error(Code::out_of_range, "a WAV file cannot be larger than 4 GB")
        .in_file(impl_->path);
  }
  if (!write_samples(impl_->file, samples)) return cannot_write(impl_->path, errno);
  impl_->samples += samples.size();
  return {};
}

Result<void> WavWriter::finish() {
  bool good = std::fseek(impl_->file, 0, SEEK_SET) == 0 && impl_->put_header();
  const int reason = errno;
  good = std::fclose(std::exchange(impl_->file, nullptr)) == 0 && good;
  if (!good) return cannot_write(impl_->path, reason);
  return {};
}

}  // namespace animeme::media

// 16-bit WAV output.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

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

bool write_samples(std::FILE* file, const Pcm& pcm) {
  std::vector<std::uint8_t> block;
  constexpr std::size_t kBlock = 32768;
  for (std::size_t at = 0; at < pcm.samples.size(); at += kBlock) {
    const std::size_t end = std::min(at + kBlock, pcm.samples.size());
    block.clear();
    for (std::size_t i = at; i < end; ++i) {
      const auto value = std::uint16_t(to_s16(pcm.samples[i]));
      block.push_back(std::uint8_t(value & 255));
      block.push_back(std::uint8_t(value >> 8));
    }
    if (std::fwrite(block.data(), 1, block.size(), file) != block.size()) return false;
  }
  return true;
}

Result<void> write(const std::string& path, const Pcm& pcm) {
  if (pcm.sample_rate <= 0) {
    return make_error(Code::invalid_argument, "the sample rate must be positive").in_file(path);
  }
  if (pcm.samples.size() > (0xffffffffu - kHeaderSize) / 2) {
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
           write_samples(file, pcm);
  }
  int reason = errno;
  if (file != nullptr && std::fclose(file) != 0) {
    if (good) reason = errno;
    good = false;
  }
  if (!good) {
    return make_error(Code::io, std::string("cannot be written: ") + std::strerror(reason))
        .in_file(path);
  }
  return out.publish();
}

}  // namespace

Result<void> write_wav(const std::string& path, const Pcm& pcm) {
  return av::guarded([&] { return write(path, pcm); });
}

}  // namespace animeme::media

#include "tools/formats/media/mp3_stream.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/formats/media/detail/sound/audio_decoder.h"
#include "tools/formats/media/detail/sound/resampler.h"

namespace animeme::media {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kMostNoise = 64 * 1024;  // bytes without a frame, but for tags
constexpr std::size_t kId3Header = 10;
constexpr int kMp3Delay = 528 + 1;  // samples that every decoder adds

struct Mp3Frame {
  std::size_t size = 0;
  int samples = 0;
  int sample_rate = 0;
};

// ISO/IEC 11172-3, 2.4.2.3, and 13818-3: layer III with a bit rate of the table.
std::optional<Mp3Frame> mp3_frame(Bytes bytes) {
  constexpr std::array<int, 15> kFirst{0,   32,  40,  48,  56,  64,  80, 96,
                                       112, 128, 160, 192, 224, 256, 320};
  constexpr std::array<int, 15> kSecond{0,  8,  16, 24,  32,  40,  48, 56,
                                        64, 80, 96, 112, 128, 144, 160};
  constexpr std::array<int, 3> kRates{44100, 48000, 32000};
  if (bytes.size() < 4 || bytes[0] != 0xFF || (bytes[1] & 0xE0) != 0xE0) return std::nullopt;
  const unsigned version = bytes[1] >> 3 & 3U, layer = bytes[1] >> 1 & 3U;
  const unsigned rate = bytes[2] >> 4, sampling = bytes[2] >> 2 & 3U, padding = bytes[2] >> 1 & 1U;
  if (version == 1 || layer != 1 || rate == 0 || rate == 15 || sampling == 3) return std::nullopt;
  const bool first = version == 3;
  Mp3Frame frame;
  frame.sample_rate = kRates[sampling] >> (first ? 0 : version == 2 ? 1 : 2);
  frame.samples = first ? 1152 : 576;
  const int kbits = first ? kFirst[rate] : kSecond[rate];
  frame.size = std::size_t((first ? 144 : 72) * kbits * 1000 / frame.sample_rate) + padding;
  return frame;
}

// The bytes of an ID3 tag in front; 0: there is none, or not all of its header.
std::size_t id3_size(Bytes bytes) {
  if (bytes.size() < kId3Header || std::memcmp(bytes.data(), "ID3", 3) != 0) return 0;
  std::size_t size = 0;
  for (std::size_t i = 6; i < kId3Header; ++i) size = size << 7 | (bytes[i] & 0x7FU);
  return size + kId3Header;
}

// Of a frame that tells of its file, and has no sound: the samples that its encoder put in front.
std::optional<int> delay_of_info(Bytes frame) {
  const std::string_view text(reinterpret_cast<const char*>(frame.data()), frame.size());
  std::size_t at = text.substr(0, 48).find("Xing");
  if (at == std::string_view::npos) at = text.substr(0, 48).find("Info");
  if (at == std::string_view::npos) return std::nullopt;
  // Behind the flags: number of frames, bytes, a table, quality; then the tag of LAME.
  if (at + 8 > frame.size()) return 0;
  const unsigned flags = frame[at + 7];
  std::size_t lame = at + 8;
  if (flags & 1U) lame += 4;
  if (flags & 2U) lame += 4;
  if (flags & 4U) lame += 100;
  if (flags & 8U) lame += 4;
  constexpr std::size_t kDelayAt = 21;
  if (lame + kDelayAt + 3 > frame.size()) return 0;
  const int delay = frame[lame + kDelayAt] << 4 | frame[lame + kDelayAt + 1] >> 4;
  return delay > 0 ? delay + kMp3Delay : 0;
}

}  // namespace

struct Mp3Stream::Impl {
  std::vector<std::uint8_t> bytes;  // that are no whole frame yet
  av::Codec codec;
  av::Packet packet{av_packet_alloc()};
  av::Frame frame{av_frame_alloc()};
  std::optional<Resampler> mixer;  // to one channel; the rate stays
  std::vector<float> mono;
  bool in_step = false;  // the last bytes were a frame
  int skip = 0;          // samples
  int rate = 0;          // Hz
  std::size_t noise = 0;

  Result<void> open();
  Result<void> decode(Bytes coded, const Mp3Frame& head, Pcm& out);
  Result<void> mix(const AVFrame& decoded);
};

Result<void> Mp3Stream::Impl::open() {
  if (!packet || !frame) return av::no_memory();
  if (codec) return {};
  const AVCodec* decoder = avcodec_find_decoder(AV_CODEC_ID_MP3);
  if (decoder == nullptr) return make_error(Code::unsupported, "this FFmpeg does not decode MP3");
  codec.reset(avcodec_alloc_context3(decoder));
  if (!codec) return av::no_memory();
  codec->thread_count = 1;
  const int status = avcodec_open2(codec.get(), decoder, nullptr);
  if (status < 0) return av::make_av_error(status, "MP3 cannot be decoded");
  return {};
}

Result<void> Mp3Stream::Impl::mix(const AVFrame& decoded) {
  const SoundFormat format{decoded.sample_rate, AVSampleFormat(decoded.format),
                           decoded.ch_layout.nb_channels, 0};
  if (!mixer || mixer->from() != format) {
    Result<Resampler> made = Resampler::open(format, decoded.sample_rate, mono);
    if (!made) return made.error();
    mixer.emplace(std::move(*made));
  }
  return mixer->add(decoded.extended_data, decoded.nb_samples);
}

Result<void> Mp3Stream::Impl::decode(Bytes coded, const Mp3Frame& head, Pcm& out) {
  if (auto opened = open(); !opened) return opened;
  if (rate != 0 && head.sample_rate != rate) {
    return make_error(Code::unsupported, "the sample rate of the MP3 changes");
  }
  rate = head.sample_rate;
  if (av_new_packet(packet.get(), int(coded.size())) < 0) return av::no_memory();
  std::copy(coded.begin(), coded.end(), packet->data);
  mono.clear();
  const Result<bool> good = decode_packet(*codec, packet.get(), *frame,
                                          [this](AVFrame& decoded) { return mix(decoded); });
  av_packet_unref(packet.get());
  if (!good) return good.error();
  mono.resize(std::size_t(head.samples), 0.0F);  // what is damaged is silence
  const auto gone = std::min<std::size_t>(std::size_t(skip), mono.size());
  skip -= int(gone);
  out.samples.insert(out.samples.end(), mono.begin() + std::ptrdiff_t(gone), mono.end());
  return {};
}

Mp3Stream::Mp3Stream() : impl_(std::make_unique<Impl>()) {}
Mp3Stream::Mp3Stream(Mp3Stream&&) noexcept = default;
Mp3Stream& Mp3Stream::operator=(Mp3Stream&&) noexcept = default;
Mp3Stream::~Mp3Stream() = default;

bool Mp3Stream::begins(Bytes bytes) {
  if (bytes.size() >= 3 && std::memcmp(bytes.data(), "ID3", 3) == 0) return true;
  const auto first = mp3_frame(bytes);
  if (!first || bytes.size() < first->size + 4) return false;
  const auto second = mp3_frame(bytes.subspan(first->size));
  return second && second->sample_rate == first->sample_rate;
}

Result<Pcm> Mp3Stream::push(Bytes piece) {
  return av::guarded([&]() -> Result<Pcm> {
    const av::LogCapture log;
    std::vector<std::uint8_t>& bytes = impl_->bytes;
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    Pcm pcm;
    std::size_t at = 0;
    while (at + kId3Header <= bytes.size()) {
      const Bytes rest = Bytes(bytes).subspan(at);
      const std::size_t tag = id3_size(rest);
      if (tag > 0) {
        if (tag > rest.size()) break;
        at += tag;
        continue;
      }
      const auto head = mp3_frame(rest);
      if (head && rest.size() < head->size) break;
      // Behind what is no frame, two in a row tell that these are some.
      if (head && !impl_->in_step && rest.size() < head->size + 4) break;
      if (!head || (!impl_->in_step && !mp3_frame(rest.subspan(head->size)))) {
        impl_->in_step = false;
        ++at;
        if (++impl_->noise > kMostNoise) {
          return make_error(Code::syntax, "this is no MP3: there is no frame in it");
        }
        continue;
      }
      impl_->in_step = true;
      impl_->noise = 0;
      const Bytes coded = rest.first(head->size);
      at += head->size;
      if (const auto delay = delay_of_info(coded)) {
        impl_->skip = *delay;
        if (impl_->codec) avcodec_flush_buffers(impl_->codec.get());
        impl_->rate = 0;
        continue;
      }
      if (auto ok = impl_->decode(coded, *head, pcm); !ok) return ok.error();
    }
    bytes.erase(bytes.begin(), bytes.begin() + std::ptrdiff_t(at));
    if (impl_->rate > 0) pcm.sample_rate = impl_->rate;
    return pcm;
  });
}

}  // namespace animeme::media

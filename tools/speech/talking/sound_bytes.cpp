#include "tools/speech/talking/sound_bytes.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

namespace animeme::speech {

namespace {

constexpr int kSlowestRate = 4000, kFastestRate = 384000, kMostChannels = 16;
constexpr std::uint64_t kLongestHead = 1 << 20;
constexpr std::uint32_t kBelieved = 0x7fffffff;  // what is more is what pipes write
constexpr std::size_t kLongestFormat = 4096;
constexpr int kWavPcm = 1, kWavFloat = 3, kWavALaw = 6, kWavMuLaw = 7, kWavExtensible = 0xfffe;

template <class T>
T little(const std::uint8_t* bytes) {
  T value = 0;
  std::memcpy(&value, bytes,
              sizeof value);  // the machines that this is built for are little endian
  return value;
}

bool is_tag(const std::uint8_t* bytes, const char* tag) { return std::memcmp(bytes, tag, 4) == 0; }

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool rate_fits(std::int64_t rate) { return rate >= kSlowestRate && rate <= kFastestRate; }

}  // namespace

Result<BareSound> parse_bare_sound(const std::string& text) {
  BareSound bare;
  bool good = !text.empty(), rate_known = false, channels_known = false, coding_known = false;
  for (std::size_t at = 0; good && at <= text.size();) {
    const std::size_t colon = std::min(text.find(':', at), text.size());
    const std::string_view part = std::string_view(text).substr(at, colon - at);
    at = colon + 1;
    const std::optional<int> number = whole_number(part);
    const std::optional<SoundCoding> coding = read_coding(part).coding;
    if (number && !rate_known && !coding_known) {
      bare.sample_rate = *number;
      rate_known = true;
    } else if (number && !channels_known) {
      bare.channels = *number;
      channels_known = true;
    } else if (!coding_known && (coding == SoundCoding::mulaw || coding == SoundCoding::alaw)) {
      bare.coding = *coding;
      if (!rate_known) bare.sample_rate = read_coding(part).sample_rate;
      coding_known = rate_known = true;
    } else {
      good = false;
    }
  }
  if (!good || !rate_fits(bare.sample_rate) || bare.channels < 1 || bare.channels > kMostChannels) {
    return make_error(Code::invalid_argument,
                      "'" + text +
                          "' is not a sample rate; write 16000, 48000:2 for two channels, or "
                          "mulaw or alaw for a telephone");
  }
  return bare;
}

SoundBytes::SoundBytes(std::optional<BareSound> bare) {
  if (!bare) return;
  in_sound_ = true;
  rate_ = bare->sample_rate;
  channels_ = bare->channels;
  if (bare->coding != SoundCoding::s16) telephone_ = bare->coding;
  bits_ = telephone_ ? 8 : 16;
  left_ = std::numeric_limits<std::uint64_t>::max();
}

Result<void> SoundBytes::read_format(std::span<const std::uint8_t> chunk) {
  if (chunk.size() < 16) return make_error(Code::syntax, "the format of this WAV is cut off");
  format_ = little<std::uint16_t>(&chunk[0]);
  channels_ = little<std::uint16_t>(&chunk[2]);
  const auto rate = little<std::uint32_t>(&chunk[4]);
  bits_ = little<std::uint16_t>(&chunk[14]);
  if (format_ == kWavExtensible && chunk.size() >= 26) format_ = little<std::uint16_t>(&chunk[24]);
  is_float_ = format_ == kWavFloat;
  if (bits_ == 8 && format_ == kWavMuLaw) telephone_ = SoundCoding::mulaw;
  if (bits_ == 8 && format_ == kWavALaw) telephone_ = SoundCoding::alaw;
  const bool known =
      is_float_ ? bits_ == 32 || bits_ == 64
                : format_ == kWavPcm && (bits_ == 8 || bits_ == 16 || bits_ == 24 || bits_ == 32);
  if (!known && !telephone_) {
    return make_error(
        Code::unsupported,
        "WAV of another coding than PCM and G.711; convert it: ffmpeg -i IN -f wav -");
  }
  if (!rate_fits(rate) || channels_ < 1 || channels_ > kMostChannels) {
    return make_error(Code::unsupported, "WAV of " + std::to_string(rate) + " Hz and " +
                                             std::to_string(channels_) +
                                             " channels; 4000 to 384000 Hz and up to 16 are read");
  }
  rate_ = int(rate);
  return {};
}

// True when the sound begins; false: more bytes are wanted.
Result<bool> SoundBytes::read_head() {
  if (!riff_read_) {
    if (rest_.size() < 12) return false;
    if (!(is_tag(&rest_[0], "RIFF") || is_tag(&rest_[0], "RF64")) || !is_tag(&rest_[8], "WAVE")) {
      return make_error(Code::syntax,
                        "this does not begin like WAV; raw samples need their rate (--pcm 16000), "
                        "other formats ffmpeg -i IN -f wav -");
    }
    rest_.erase(rest_.begin(), rest_.begin() + 12);
    riff_read_ = true;
  }
  while (rest_.size() >= 8) {
    const auto size = little<std::uint32_t>(&rest_[4]);
    if (is_tag(&rest_[0], "data")) {
      if (rate_ == 0) return make_error(Code::syntax, "this WAV has sound before its format");
      left_ = size == 0 || size > kBelieved ? std::numeric_limits<std::uint64_t>::max() : size;
      rest_.erase(rest_.begin(), rest_.begin() + 8);
      in_sound_ = true;
      return true;
    }
    const std::uint64_t padded = std::uint64_t(size) + (size & 1);
    head_bytes_ += padded + 8;
    if (head_bytes_ > kLongestHead) {
      return make_error(Code::syntax, "there is no sound in the first MB of this WAV");
    }
    if (is_tag(&rest_[0], "fmt ")) {
      if (size > kLongestFormat)
        return make_error(Code::syntax, "the format of this WAV is invalid");
      if (rest_.size() < 8 + padded) return false;
      if (auto ok = read_format(std::span(rest_).subspan(8, size)); !ok) return ok.error();
      rest_.erase(rest_.begin(), rest_.begin() + std::ptrdiff_t(8 + padded));
      continue;
    }
    if (rest_.size() < 8 + padded) {
      head_bytes_ -= padded + 8;  // it is looked at again
      return false;
    }
    rest_.erase(rest_.begin(), rest_.begin() + std::ptrdiff_t(8 + padded));
  }
  return false;
}

float SoundBytes::sample(const std::uint8_t* bytes) const {
  if (telephone_) return *telephone_ == SoundCoding::mulaw ? from_mulaw(*bytes) : from_alaw(*bytes);
  if (is_float_) {
    if (bits_ == 64) return float(std::bit_cast<double>(little<std::uint64_t>(bytes)));
    return std::bit_cast<float>(little<std::uint32_t>(bytes));
  }
  if (bits_ == 8) return (float(*bytes) - 128) / 128;
  if (bits_ == 16) return float(little<std::int16_t>(bytes)) / 32768;
  if (bits_ == 32) return float(double(little<std::int32_t>(bytes)) / 2147483648.0);
  const std::int32_t value = std::int32_t(
      std::uint32_t(bytes[0]) << 8 | std::uint32_t(bytes[1]) << 16 | std::uint32_t(bytes[2]) << 24);
  return float(double(value) / 2147483648.0);
}

Result<void> SoundBytes::push(std::span<const std::uint8_t> bytes, std::vector<float>& out) {
  rest_.insert(rest_.end(), bytes.begin(), bytes.end());
  if (!in_sound_) {
    auto begun = read_head();
    if (!begun) return begun.error();
    if (!*begun) return {};
  }
  const std::size_t width = std::size_t(bits_) / 8, step = width * std::size_t(channels_);
  const auto usable = std::size_t(std::min<std::uint64_t>(rest_.size(), left_));
  std::size_t at = 0;
  for (; at + step <= usable; at += step) {
    float sum = 0;
    for (std::size_t c = 0; c < std::size_t(channels_); ++c) sum += sample(&rest_[at + c * width]);
    out.push_back(sum / float(channels_));
  }
  if (left_ != std::numeric_limits<std::uint64_t>::max()) left_ -= at;
  if (left_ < step) {
    rest_.clear();  // what follows the sound is no sound
    left_ = 0;
  } else {
    rest_.erase(rest_.begin(), rest_.begin() + std::ptrdiff_t(at));
  }
  return {};
}

}  // namespace animeme::speech

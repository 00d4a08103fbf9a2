#include "tools/speech/talking/sound_coding.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <string>

namespace animeme::speech {

namespace {

constexpr int kTelephoneRate = 8000;
constexpr int kLeastNamedRate = 4000;  // smaller numbers in a name are no rates: 16, 128, 711

// "PCM_24000" and "pcm24000" are one name.
std::string plain_name(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c))) {
      out += char(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return out;
}

// The first number of a name that is a rate: 24000, or 24khz.
int rate_in(std::string_view name) {
  for (std::size_t i = 0; i < name.size();) {
    if (!std::isdigit(static_cast<unsigned char>(name[i]))) {
      ++i;
      continue;
    }
    int value = 0;
    for (; i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])); ++i) {
      value = std::min(value * 10 + (name[i] - '0'), 1000000);
    }
    const std::string unit = plain_name(name.substr(i, 3));
    if (unit == "khz") value *= 1000;
    if (value >= kLeastNamedRate) return value;
  }
  return 0;
}

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool is_file(std::string_view name) {
  for (const std::string_view start : {"riff", "wav", "mp3", "mpeg", "ogg", "opus", "flac", "webm",
                                       "aac", "audiowav", "audiompeg", "audioogg", "audio24khz"}) {
    if (name.starts_with(start)) return true;
  }
  return false;
}

bool is_s16(std::string_view name) {
  for (const std::string_view known : {"s16", "s16le", "pcm", "pcm16", "pcms16", "pcms16le",
                                       "linear16", "l16", "lpcm", "int16", "pcm16bit"}) {
    if (name == known) return true;
  }
  if (name.starts_with("raw") && has(name, "16bit")) return true;
  // "pcm_24000" of a rate, not "pcm_24" of 24 bits.
  return name.starts_with("pcm") && rate_in(name) > 0 &&
         std::all_of(name.begin() + 3, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

float sample_at(std::span<const std::uint8_t> bytes, std::size_t at, SoundCoding coding) {
  if (coding == SoundCoding::mulaw) return from_mulaw(bytes[at]);
  if (coding == SoundCoding::alaw) return from_alaw(bytes[at]);
  if (coding == SoundCoding::s16) {
    return float(std::int16_t(std::uint16_t(bytes[at] | bytes[at + 1] << 8))) / 32768.0F;
  }
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t(bytes[at + i]) << (8 * i);
  const float value = std::bit_cast<float>(bits);
  return value >= -1 && value <= 1 ? value : value > 1 ? 1.0F : value < -1 ? -1.0F : 0.0F;
}

}  // namespace

std::size_t bytes_of(SoundCoding coding) {
  if (coding == SoundCoding::f32) return 4;
  return coding == SoundCoding::s16 ? 2 : 1;
}

NamedCoding read_coding(std::string_view name) {
  const std::string plain = plain_name(name);
  NamedCoding named;
  named.sample_rate = rate_in(name);
  if (is_file(plain)) return named;
  if (has(plain, "mulaw") || has(plain, "ulaw") || has(plain, "pcmu")) {
    named.coding = SoundCoding::mulaw;
  } else if (has(plain, "alaw") || has(plain, "pcma")) {
    named.coding = SoundCoding::alaw;
  } else if (plain == "f32" || plain == "f32le" || has(plain, "pcmf32") || plain == "float32") {
    named.coding = SoundCoding::f32;
  } else if (is_s16(plain)) {
    named.coding = SoundCoding::s16;
  }
  const bool telephone = named.coding == SoundCoding::mulaw || named.coding == SoundCoding::alaw;
  if (telephone && named.sample_rate == 0) named.sample_rate = kTelephoneRate;
  return named;
}

float from_mulaw(std::uint8_t byte) {
  constexpr int kBias = 0x84;
  const unsigned code = ~unsigned(byte) & 0xFFU;
  const int magnitude = ((int(code & 0xFU) << 3) + kBias) * (1 << ((code >> 4) & 7U)) - kBias;
  return float(code & 0x80U ? -magnitude : magnitude) / 32768.0F;
}

float from_alaw(std::uint8_t byte) {
  const unsigned code = byte ^ 0x55U;
  const int segment = int((code >> 4) & 7U);
  int magnitude = (int(code & 0xFU) << 4) + 8;
  if (segment > 0) magnitude = (magnitude + 0x100) * (1 << (segment - 1));
  return float(code & 0x80U ? magnitude : -magnitude) / 32768.0F;
}

std::vector<float> decode_samples(std::span<const std::uint8_t> bytes, SoundCoding coding,
                                  int channels) {
  const std::size_t size = bytes_of(coding), step = size * std::size_t(std::max(channels, 1));
  std::vector<float> samples;
  samples.reserve(bytes.size() / step);
  for (std::size_t at = 0; at + step <= bytes.size(); at += step) {
    float sum = 0;
    for (std::size_t c = 0; c < step; c += size) sum += sample_at(bytes, at + c, coding);
    samples.push_back(sum / float(step / size));
  }
  return samples;
}

}  // namespace animeme::speech

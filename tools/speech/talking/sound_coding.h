/// @file
/// Codings of raw samples and the names that speech services and telephones give them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::speech {

/// How a sample is stored.
enum class SoundCoding : std::uint8_t {
  s16,    ///< 16 bit, little-endian
  f32,    ///< float of 32 bit, little-endian
  mulaw,  ///< G.711 mu-law, a byte a sample
  alaw,   ///< G.711 A-law, a byte a sample
};

/// Bytes of one sample.
std::size_t bytes_of(SoundCoding coding);

/// What a name says.
struct NamedCoding {
  std::optional<SoundCoding> coding;  ///< nullopt: a file (WAV, MP3 ...), or an unknown name
  int sample_rate = 0;                ///< Hz; 0: the name has no rate
};

/// Reads names such as "s16le", "pcm_f32le", "linear16", "pcm_24000", "ulaw_8000", "g711_alaw",
/// "PCMU", "raw-8khz-8bit-mono-mulaw", in any case. G.711 without a rate has 8000 Hz.
NamedCoding read_coding(std::string_view name);

/// A sample of G.711, full scale +-1 (ITU-T G.711, tables 1a to 2b).
float from_mulaw(std::uint8_t byte);
/// The same for A-law.
float from_alaw(std::uint8_t byte);

/// The samples of whole groups of `channels`, each the mean of its group; a part of a group at the
/// end is left out. Floats beyond full scale are limited, NaN is 0.
std::vector<float> decode_samples(std::span<const std::uint8_t> bytes, SoundCoding coding,
                                  int channels);

}  // namespace animeme::speech

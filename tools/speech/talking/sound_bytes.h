/// @file
/// Sound from a pipe: WAV or bare samples, byte by byte as they come, without looking back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::speech {

/// How bare samples lie: 16 bit, little endian, channels side by side.
struct BareSound {
  int sample_rate = 16000;  ///< 4000..384000 Hz
  int channels = 1;         ///< 1..16
};

/// Reads "16000" or "48000:2" (rate, channels). Errors: invalid_argument.
Result<BareSound> parse_bare_sound(const std::string& text);

/// The bytes of a sound, piece by piece, become samples of one channel (the mean of all).
///
/// WAV: samples of 8, 16, 24, 32 bit and of float 32 and 64. The length that its head promises is
/// not believed if it is 0 or more than 2 GB, as pipes write it; else what follows it is left out.
/// A sound that is cut off ends with its last whole sample.
class SoundBytes {
 public:
  /// Nothing: WAV.
  explicit SoundBytes(std::optional<BareSound> bare = std::nullopt);
  /// Appends the samples to `out`. Errors: syntax (no WAV, no sound chunk within its first MB),
  /// unsupported (another coding; a rate or a number of channels out of range).
  Result<void> push(std::span<const std::uint8_t> bytes, std::vector<float>& out);
  /// Known once the head is read; 0 before.
  int sample_rate() const { return rate_; }

 private:
  Result<bool> read_head();
  Result<void> read_format(std::span<const std::uint8_t> chunk);
  float sample(const std::uint8_t* bytes) const;

  std::vector<std::uint8_t> rest_;  // bytes of a head or of a sample that is not whole
  bool in_sound_ = false, riff_read_ = false;
  std::uint64_t head_bytes_ = 0;
  std::uint64_t left_ = 0;  // bytes of sound
  int rate_ = 0, channels_ = 0, bits_ = 0, format_ = 0;
  bool is_float_ = false;
};

}  // namespace animeme::speech

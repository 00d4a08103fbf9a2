/// @file
/// Sound from a pipe: WAV or raw samples, parsed incrementally.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/talking/sound_coding.h"

namespace animeme::speech {

/// Format of raw samples with interleaved channels.
struct BareSound {
  int sample_rate = 16000;                ///< 4000..384000 Hz
  int channels = 1;                       ///< 1..16
  SoundCoding coding = SoundCoding::s16;  ///< of each sample; not f32
};

/// Reads "16000" or "48000:2" (rate, channels) of 16-bit samples; "mulaw" and "alaw" are those of
/// telephones, 8000 a second, with an optional rate before it: "16000:alaw". Errors:
/// invalid_argument.
Result<BareSound> parse_bare_sound(const std::string& text);

/// Converts bytes incrementally to samples of one channel (the mean of all channels).
///
/// WAV: samples of 8, 16, 24, 32 bit, of float 32 and 64, and G.711. The length in the header is
/// ignored if it is 0 or more than 2 GB, as pipes write it; otherwise data after it is ignored. A
/// truncated sound ends with its last complete sample.
class SoundBytes {
 public:
  /// `bare`: nullopt for WAV.
  explicit SoundBytes(std::optional<BareSound> bare = std::nullopt);
  /// Appends the samples to `out`. Errors: syntax (not WAV, no data chunk within the first MB),
  /// unsupported (another coding; a rate or a number of channels out of range).
  Result<void> push(std::span<const std::uint8_t> bytes, std::vector<float>& out);
  /// Known once the header has been read; 0 before.
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
  std::optional<SoundCoding> telephone_;  // G.711
};

}  // namespace animeme::speech

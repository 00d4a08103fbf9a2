/// @file
/// From samples to what a SoundModel compares, piece by piece, and which phones follow each other.
/// By the library of pocketsphinx. Internal.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/sound_model.h"

namespace animeme::voice {

/// Frames of 10 ms from samples at 16 kHz as they come. Frame i is the middle of its window of
/// 25.6 ms, at i * 0.01 + 0.0128 s.
class CepstraReader {
 public:
  /// Errors: unsupported (built without pocketsphinx), not_found (no feat.params in the folder of
  /// the model).
  static Result<std::unique_ptr<CepstraReader>> open(const std::string& model_path);
  virtual ~CepstraReader() = default;
  /// Appends the frames that are whole.
  virtual void push(std::span<const std::int16_t> samples, std::vector<Cepstrum>& frames) = 0;
  /// Appends the last one, which the samples do not fill; then it begins anew.
  virtual void finish(std::vector<Cepstrum>& frames) = 0;
};

/// Probabilities that a phone is followed by another: row by row, of the phones named, by a
/// language model of phones. Errors: unsupported, not_found (no such file), syntax (it is none).
Result<std::vector<double>> read_phone_pairs(const std::string& path,
                                             const std::vector<std::string>& phones);

}  // namespace animeme::voice

/// @file
/// Phones of sound that comes in pieces without times.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "tools/formats/media/pcm.h"
#include "tools/speech/voice/listen_stream.h"

namespace animeme::speech {

/// Recognises what is said in a part of a sound, from the sound around it. Parts are asked for in
/// ascending order. Not thread safe.
class SoundEar {
 public:
  /// A piece of the sound: its samples, and where it begins in seconds.
  struct Piece {
    double start = 0;                   ///< seconds
    const media::Pcm* sound = nullptr;  ///< its samples

    double end() const { return start + sound->duration(); }  ///< seconds
  };
  /// Seconds of sound behind a part that matter to it.
  static constexpr double kLookAhead = 0.3;

  /// `language`: of the voice, see voice::ListenOptions.
  explicit SoundEar(std::string language) : language_(std::move(language)) {}

  /// The phones from `begin` to `end`, of which 0 is `begin`; `pieces` ascend and have no gaps, and
  /// include that part. nullopt: it cannot listen, see why().
  std::optional<dam::Script> hear(const std::vector<Piece>& pieces, double begin, double end);
  /// Why it cannot listen; empty: it can.
  const std::string& why() const { return why_; }

 private:
  std::string language_;
  std::string why_;
  std::unique_ptr<voice::SoundListener> listener_;
  int rate_ = 0;
  double from_ = 0;       // where its sound begins
  double until_ = 0;      // ... and ends
  double forgotten_ = 0;  // seconds of it whose results are gone
};

}  // namespace animeme::speech

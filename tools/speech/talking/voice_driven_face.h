/// @file
/// A face that follows a live voice by its sound alone.
///
///     auto face = speech::VoiceDrivenFace::open(model, 48000, {});
///     while (read(block)) {
///       (*face)->push(block);
///       auto frames = (*face)->pull();               // those that are due
///     }
///     auto rest = (*face)->finish();
///
/// A frame is made when `delay` more seconds of sound have arrived, since recognition needs the
/// following sound. It is the mean over several hypotheses (dam/speaking/readings.h), so the face
/// moves less while the sound is ambiguous.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "dam/model/model.h"
#include "dam/signal/signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"

namespace animeme::speech {

/// Options for following a voice.
struct VoiceDrivenFaceOptions {
  dam::SynthesisOptions synthesis;  ///< `frames`, `tail`, `rest_at_ends` and `tongue` are not used
  std::string language = "en";      ///< of the voice, see voice::ListenOptions
  double delay = 0.25;              ///< seconds of sound beyond a frame, 0.08..2
};

/// Memory and CPU time per second are constant. Not thread safe.
class VoiceDrivenFace {
 public:
  /// `model` must outlive the face. `sample_rate` 4000 to 384000 Hz. Errors: invalid_argument
  /// (options out of range), those of voice::SoundListener::open().
  static Result<std::unique_ptr<VoiceDrivenFace>> open(const dam::Model& model, int sample_rate,
                                                       const VoiceDrivenFaceOptions& options);
  virtual ~VoiceDrivenFace() = default;

  /// The next samples of the voice, full scale +-1, one channel.
  virtual void push(std::span<const float> samples) = 0;
  /// The frames that became due since the last call, in order; often none. Signal::first_frame is
  /// the number of the first. Errors: those of dam::synthesise_readings().
  virtual Result<dam::Signal> pull() = 0;
  /// Ends the voice and returns the remaining frames.
  virtual Result<dam::Signal> finish() = 0;
};

}  // namespace animeme::speech

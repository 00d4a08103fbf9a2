/// @file
/// A face that follows a voice by its sound alone, while it speaks.
///
///     auto face = speech::HeardFace::open(model, 48000, {});
///     while (read(block)) {
///       (*face)->push(block);
///       auto frames = (*face)->pull();               // those that are due
///     }
///     auto rest = (*face)->finish();
///
/// A frame is made when `delay` seconds more of the sound have come: what is said is heard in what
/// follows. It is the mean over what may have been said (dam/speaking/readings.h), so where the
/// sound does not tell yet the face moves less.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "dam/model/model.h"
#include "dam/signal/signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"

namespace animeme::speech {

/// How a face follows a voice.
struct HeardFaceOptions {
  dam::SynthesisOptions synthesis;  ///< `frames`, `tail` and `rest_at_ends` are not used
  std::string language = "en";      ///< of the voice, see voice::ListenOptions
  double delay = 0.25;              ///< seconds of sound beyond a frame, 0.08..2
};

/// Memory and the cost of a second do not grow with time. Not thread safe.
class HeardFace {
 public:
  /// `model` must outlive the face. `sample_rate` 4000 to 384000 Hz. Errors: invalid_argument
  /// (options out of range), those of voice::SoundListener::open().
  static Result<std::unique_ptr<HeardFace>> open(const dam::Model& model, int sample_rate,
                                                 const HeardFaceOptions& options);
  virtual ~HeardFace() = default;

  /// The next samples of the voice, full scale +-1, one channel.
  virtual void push(std::span<const float> samples) = 0;
  /// The frames that became due since the last call, in order; often none. Signal::first_frame is
  /// the number of the first. Errors: those of dam::synthesise_readings().
  virtual Result<dam::Signal> pull() = 0;
  /// The voice is over: all frames that are left.
  virtual Result<dam::Signal> finish() = 0;
};

}  // namespace animeme::speech

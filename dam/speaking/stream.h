/// @file
/// Streaming synthesis, while the script is still being made: phones go in one by one, frames come
/// out as soon as no later phone can change them.
///
///     SpeechStream stream(model, {});
///     for (const Phone& phone : phones_as_they_come) {
///       if (auto ok = stream.push(phone); !ok) ...
///       auto frames = stream.pull();               // often none, sometimes several
///     }
///     auto rest = stream.finish();
///
/// With the look-ahead of exact_look_ahead() the frames are those of synthesise(), bit for bit, for
/// the methods whose phones have a bounded reach (dam, cohen-massaro). With less, the unknown
/// future counts as silence; when it becomes known, the motion blends to the better one, without a
/// jump, within `cross_fade` seconds. Source: dam/lipsync.md, section 6.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dam/model/model.h"
#include "dam/script/mood.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"

namespace animeme::dam {

/// All settings of SpeechStream.
struct StreamOptions {
  /// `frames` is not used; `tail` and the rest at the end come with finish().
  SynthesisOptions synthesis;
  /// Seconds of script that must be known beyond a frame, 0..60; nullopt: exact_look_ahead().
  std::optional<double> look_ahead;
  double cross_fade = 0.08;  ///< seconds, 0..1
  /// From the first frame to the last, as add_moods() adds it: channels that it moves and the model
  /// lacks follow the others.
  Mood mood;
};

/// Seconds of script beyond a frame that can still change it: the reach of the widest phone of the
/// model, plus what closures and their search need (for sounds up to 0.15 s). In addition, the next
/// two phones must be known.
double exact_look_ahead(const Model& model);

/// A streaming synthesiser. Memory and the cost of a frame do not grow with the length of the
/// stream.
class SpeechStream {
 public:
  /// `model` must pass validate() and outlive the stream.
  SpeechStream(const Model& model, const StreamOptions& options);

  /// The next phone. Gaps are silence. Errors: invalid_argument (options out of range; a phone that
  /// begins before the last one ends, has no duration or an unknown label; after finish()).
  Result<void> push(const Phone& phone);

  /// The frames that became final since the last call, in order; often none. Signal::first_frame is
  /// the number of the first. Errors: those of synthesise() and add_moods().
  Result<Signal> pull();

  /// Ends the script: returns all remaining frames, including `tail`.
  Result<Signal> finish();

 private:
  Result<Signal> make(std::size_t end, double last_frame);
  Result<Signal> piece(std::size_t first, std::size_t end, double last_frame) const;
  void lead_over(Signal& signal) const;
  Result<void> add_mood(Signal& signal) const;
  void forget();

  const Model* model_;
  StreamOptions options_;
  double reach_;
  std::vector<Phone> phones_;  ///< recent ones
  std::size_t next_ = 0;       ///< number of the next frame
  std::vector<double> last_;   ///< the previous frame, as it was returned
  bool finished_ = false;
};

}  // namespace animeme::dam

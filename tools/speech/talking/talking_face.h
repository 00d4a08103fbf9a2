/// @file
/// An endless sequence of frames of a face that speaks lines and idles between them.
///
///     auto face = TalkingFace::open(model, {.idle_motion = true});
///     for (;;) {
///       if (have_line && !face->speaking()) face->say(script);
///       auto frame = face->next();                   // one every 1/rate seconds, for ever
///     }
///
/// Speech begins with the next frame. Transitions between pieces (a line, idling, another line) are
/// smooth: the difference at the joint is faded over 0.25 s. Speech can be cut off: the mouth
/// closes in 0.1 s. Eyes, lids, brows and head go on across pieces (dam/behaviour).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dam/behaviour/behaviour.h"
#include "dam/model/model.h"
#include "dam/performance/over_speech.h"
#include "dam/script/mood.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/synthesise.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::speech {

/// Options for speaking and idling.
struct FaceOptions {
  dam::SynthesisOptions synthesis;  ///< `frames` and `tail` are not used
  /// Gaze, blinks, brows, head (dam/behaviour/behaviour.h), without cheeks and nostrils. Without it
  /// brows rise at the ends of questions, unless `idle.still` has them.
  bool idle_motion = false;
  dam::IdleMotionOptions idle;  ///< of the idle motion; `prosody` is not used
  dam::Mood mood;               ///< at the beginning
  /// A performance under the speech, which repeats (dam/performance); null: none.
  std::shared_ptr<const dam::Performance> over = nullptr;
  dam::KeptShares keep = {};  ///< what is kept of it
};

/// The moods of a line.
struct LineMoods {
  std::optional<dam::Mood> mood;     ///< of the whole line; nullopt: that of the face
  std::vector<dam::MoodSpan> spans;  ///< of its parts, in seconds of its script
};

/// Result of say().
struct Line {
  std::int64_t first = 0;   ///< number of its first frame
  std::int64_t frames = 0;  ///< at least one
  /// The first frame in which a mouth FAP differs from its value before the line; the first frame
  /// if the mouth never moves.
  std::int64_t first_moved = 0;
};

/// Movable, not copyable. The same scripts at the same frames give the same frames.
class TalkingFace {
 public:
  /// The model must outlive the face. Errors: not_found (the model has no FAPs), those of
  /// dam::synthesise() and dam::Behaviour::make().
  static Result<TalkingFace> open(const dam::Model& model, const FaceOptions& options);

  /// The FAPs of every frame so far. A mood that moves others makes them part of all that follow.
  const fap::Mask& mask() const { return mask_; }
  /// Number of the next frame, from 0.
  std::int64_t number() const { return number_; }
  /// Whether a line has remaining frames.
  bool speaking() const { return speaking_ && at_ < clip_.frames.size(); }
  /// Begins a line with the next frame; the rest of the previous line is dropped.
  /// Its moods end with it. Head and brows follow `prosody`, that of its sound, if it is not null.
  /// Errors: those of dam::synthesise().
  Result<Line> say(const dam::Script& script, const LineMoods& moods = {},
                   const dam::Prosody* prosody = nullptr);
  /// Extends the current line: `script` begins `start` seconds after the next frame (0 or more; not
  /// before the end of the current speech) and is coarticulated with the rest of that, which is
  /// recomputed. Without current speech it begins a new line. `goes_on`: the first phone is the
  /// rest of the last one. Errors: as say(); invalid_argument (`start` is negative or NaN).
  Result<Line> join(const dam::Script& script, double start, const LineMoods& moods = {},
                    const dam::Prosody* prosody = nullptr, bool goes_on = false);
  /// The mood from the next frame on, and between lines. Moods of a line that is spoken end.
  void set_mood(const dam::Mood& mood);
  /// Interrupts speech: the mouth begins to close evenly with the next frame and is at rest 0.1 s
  /// after the previous frame, or up to 0.16 s if it would otherwise move faster than in speech.
  /// Errors: as say().
  Result<void> cut();
  /// What is left to say from `ahead` seconds after the next frame on, 0 or more; its times count
  /// from there. Without speech, or at its end: no phones.
  dam::Script rest(double ahead) const;
  /// What the face does while it does not speak; thinking ends with the next line.
  void set_activity(dam::Activity activity);
  /// Whether the other party speaks at the next frame: dam::Behaviour::hear().
  void hear(bool voice);
  /// Where it looks from the next frame on. With gaze that is still, only the head turns.
  void look(const dam::Look& target);
  /// Whether the mouth is still closing, so that a line beginning now would start with an open
  /// mouth.
  bool closing() const { return number_ < closed_; }
  /// The next frame. Errors: as say().
  Result<fap::Frame> next();
  /// In place of next(), for a mouth that others move: `mouth`, with gaze, blinks, head and moods
  /// of this face. `sounds`: what the mouth says, of which moods and behaviour take account; speech
  /// above 0: it speaks.
  fap::Frame accompany(const fap::Frame& mouth, const dam::MoodMouth::Shares& sounds);

 private:
  TalkingFace(const dam::Model& model, const FaceOptions& options)
      : model_(&model), options_(options) {}
  Result<void> begin(const dam::Script& script, bool closing);
  Result<dam::Signal> synthesise(const dam::Script& script) const;
  Result<void> show(dam::Signal signal, std::size_t at);
  void find_moving(const fap::Mask& known, const dam::BehaviourOptions& wanted);
  void behave(fap::Frame& frame);
  Line line_from(std::size_t first, const fap::Frame& before) const;
  double now() const { return signal_.rate.seconds(double(number_)); }
  void plan_moods(const dam::Script& script, double start, const LineMoods& moods);
  void follow_sounds(const dam::MoodMouth::Shares& wanted);
  void behave_as_speaking(bool speaks);
  void show_mood(fap::Frame& frame);

  const dam::Model* model_;
  FaceOptions options_;
  fap::Mask mask_;
  dam::Script script_;          // of the piece that is shown
  dam::Signal signal_;          // of it, faded
  fap::Sequence clip_;          // the same as FAPs
  std::size_t at_ = 0;          // frame of the piece
  std::vector<double> speeds_;  // of each channel, a second, in speech
  std::vector<double> shown_;   // what the last frame shows; empty: there was none
  std::int64_t number_ = 0;
  bool speaking_ = false;
  dam::Mood mood_;                           // between lines
  dam::MoodBlend moods_;                     // in seconds from frame 0
  dam::MoodMouth mouth_;                     // of script_
  dam::MoodMouth::Shares shares_;            // as shown last
  std::optional<dam::Behaviour> behaviour_;  // nothing before open() has ended
  std::vector<int> moving_;                  // FAPs of it
  bool questions_only_ = false;              // idle motion is off
  std::optional<dam::PerformanceLoop> over_;
  bool accompanies_ = false;  // speech that others show
  double phrase_end_ = 0;     // of it, in seconds from frame 0
  std::int64_t closed_ = 0;   // number of the frame after the first one at rest behind cut()
};

}  // namespace animeme::speech

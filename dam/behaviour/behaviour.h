/// @file
/// What a face does besides speaking: gaze, blinks, head and brows, moment by moment, by the
/// statistics of people (README.md of this folder has them with their sources).
///
///     auto behaviour = Behaviour::make({.rate = {25, 1}});
///     behaviour->speak(plan_speech(script));        // as soon as it is known what will be said
///     for (;;) show(behaviour->next());             // one moment a frame, for ever
///
/// It never ends and keeps its state: what is said comes in parts, and nothing jumps between them.
/// The mouth (FAP 3 to 18 and 51 to 60) is not part of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/behaviour/look.h"
#include "dam/behaviour/speech_plan.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::dam {

inline constexpr double kMostLiveliness = 2;  ///< of BehaviourOptions::liveliness

/// Parts that move, or stay still.
struct StillParts {
  bool gaze = false;    ///< FAP 23 to 26: eyes stay as they are in the head
  bool head = false;    ///< FAP 48 to 50
  bool brows = false;   ///< FAP 31 to 38, and 41, 42, 61, 62: brows, cheeks and nostrils
  bool blinks = false;  ///< lids follow the gaze only; without gaze FAP 19 to 22 are left out
  friend bool operator==(const StillParts&, const StillParts&) = default;
};

/// Reads a list of "gaze", "head", "brows" and "blinks", separated by commas; empty: nothing is
/// still. Error: not_found (another word).
Result<StillParts> parse_still(std::string_view text);

/// The text that parse_still() reads.
std::string format_still(const StillParts& still);

/// What a person does while it does not speak.
enum class Activity : std::uint8_t {
  idle,       ///< waits and looks at the viewer most of the time
  listening,  ///< keeps eye contact, nods now and then
  thinking,   ///< looks away, until the next speech begins
};

/// Options of a behaviour.
struct BehaviourOptions {
  fap::Rate rate = {25, 1};  ///< moments per second
  std::uint64_t seed = 1;    ///< another seed, another person at another time
  /// Scales head and brows, and how often eyes wander and lids close: 0..2; 0: nothing moves but
  /// brows that rise at the ends of questions.
  double liveliness = 1;
  StillParts still;  ///< parts that do not move
  Look look;         ///< where the eyes are at first
  /// Seconds after which all is at rest again, as at the beginning: the length of a clip.
  double end = std::numeric_limits<double>::infinity();
};

/// A moment, left side (the person's) first. Angles are radians and turn as FAPs do.
struct FaceMoment {
  std::array<double, 2> eye_yaw = {};      ///< in the head, to the left
  std::array<double, 2> eye_pitch = {};    ///< in the head, down
  double blink = 0;                        ///< 0 open, 1 closed
  std::array<double, 2> upper_lid = {};    ///< IRISD units, down: of the gaze, without the blink
  std::array<double, 2> lower_lid = {};    ///< IRISD units, up: likewise
  std::array<double, 2> inner_brow = {};   ///< ENS units, up
  std::array<double, 2> middle_brow = {};  ///< ENS units, up
  std::array<double, 2> outer_brow = {};   ///< ENS units, up
  std::array<double, 2> squeeze = {};      ///< ES units, brows together
  double cheek = 0;                        ///< ENS units, up, both
  double nostril = 0;                      ///< ENS units, wider, both
  double head_pitch = 0;                   ///< down
  double head_yaw = 0;                     ///< left
  double head_roll = 0;                    ///< towards the right shoulder
};

/// FAPs that move with these options, ascending; of 19..26, 31..38, 41, 42, 48..50, 61, 62;
/// with liveliness 0 of 31..36.
std::vector<int> behaviour_faps(const BehaviourOptions& options);

/// The value of one of those FAPs, in its units. Lids meet exactly at blink 1: 1024 together.
double behaviour_value(const FaceMoment& moment, int fap);

/// Counts since the beginning.
struct BehaviourCounts {
  std::size_t blinks = 0;  ///< lids that closed, half or all the way
  std::size_t nods = 0;    ///< accents at which the head moves, those to come included
  std::size_t raises = 0;  ///< accents at which the brows rise, likewise
};

/// Copies go on independently, with the same values. Not thread safe.
class Behaviour {
 public:
  /// Errors: invalid_argument (liveliness or rate out of range).
  static Result<Behaviour> make(const BehaviourOptions& options);
  Behaviour(const Behaviour& other);             ///< a copy
  Behaviour& operator=(const Behaviour& other);  ///< a copy
  Behaviour(Behaviour&&) noexcept;               ///< movable
  Behaviour& operator=(Behaviour&&) noexcept;    ///< movable
  ~Behaviour();

  /// Tells of speech whose plan begins `delay` seconds after the next moment (below 0: before it;
  /// what has passed is ignored). It may follow other speech that has not ended.
  void speak(const SpeechPlan& plan, double delay = 0);
  /// Speech ends now; what was planned for the rest of it is not done.
  void hush();
  /// What it does when it does not speak.
  void set_activity(Activity activity);
  /// Whether the other one is heard to speak at the next moment. While it speaks, and for a second
  /// after that, the face listens; it nods where the other one pauses, and no longer by itself.
  void hear(bool voice);
  /// Another target of the eyes, from the next moment on.
  void look(const Look& target);
  /// The next moment, 1/rate seconds after the last; the first is at 0.
  FaceMoment next();

  /// Seconds of the next moment.
  double time() const;
  /// What was done so far.
  BehaviourCounts counts() const;

 private:
  struct Impl;
  explicit Behaviour(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::dam

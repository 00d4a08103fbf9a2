/// @file
/// Moods of a face that speaks: what they look like, how they follow each other, and how they are
/// added to speech.
///
///     dam::MoodTrack track(dam::Mood{"joy", 0.7}, spoken.moods);
///     dam::add_moods(signal, script, track);
///
/// Joy, sadness, anger, fear, disgust and surprise are the poses of FAP 2 (fap/expand.h); the other
/// moods are mixed from them or have values of their own (mood_poses.cpp). A mood comes within 0.4
/// s and goes within 0.6 s (P. Ekman, W. V. Friesen, "Felt, false, and miserable smiles", Journal
/// of Nonverbal Behavior 6, 1982: onsets of 0.3 to 0.7 s, slower decay), and one mood turns into
/// the other without a jump.
///
/// Speech comes first; the mouth of a mood gets what the sounds leave to it:
///
/// - lips that are nearly closed (inner gap below kClosedGap) keep their gap: P, B and M close as
///   they do without a mood, for as long;
/// - around F and V lips and jaw keep their height: the lower lip stays at the teeth;
/// - in rounded sounds the corners go apart by a sixth of the mood's share, and by no more than 35
/// %
///   of the way that rounding has brought them together;
/// - in S, Z, SH and the like the jaw hardly opens; in all speech, lips and jaw open a third as far
///   as in silence; for P, B, M, F and V the jaw comes up in time, no faster than people move it
///   (below 200 mm/s).
///
/// Brows, lids, cheeks and nose move fully; lids that blink close.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dam/script/mood.h"
#include "dam/script/script.h"
#include "dam/signal/rounding.h"
#include "dam/signal/signal.h"
#include "fap/frame.h"
#include "fap/tables.h"

namespace animeme::dam {

/// What moods do to a face at one instant.
struct MoodPose {
  std::array<double, fap::kFapCount + 1> fap{};  ///< by number of the FAP, in its units
  /// By number of the expression of FAP 2: weights, 0 and up. Moods that FAP 2 does not have are
  /// shown by the nearest ones.
  std::array<double, 7> expression{};
  double style = 1;  ///< scale of the motion of jaw and lips

  /// Adds `share` of another one.
  void add(const MoodPose& other, double share);
  /// Nothing moves.
  bool neutral() const;
  /// The FAPs that it moves, and the other sides of these: a decoder gives a side that is never
  /// sent the value of the other one, which would make a one-sided pose a pose of both sides.
  fap::Mask faps() const;
};

/// The pose of a mood at its intensity.
MoodPose mood_pose(const Mood& mood);

/// The FAPs that any mood moves.
const fap::Mask& mood_faps();

/// Moods that follow each other in time, without jumps: no FAP moves by more than 1.6 / 0.4 s times
/// the difference of the two poses. Incremental, for heads that live.
class MoodBlend {
 public:
  /// The mood of all times.
  explicit MoodBlend(const Mood& mood = {});

  /// Changes the mood, beginning at `seconds`; changes that were to begin later are dropped.
  void change(double seconds, const Mood& mood);
  /// The pose at a time.
  MoodPose at(double seconds) const;
  /// A mood and how much of it shows.
  struct Share {
    const Mood* mood = nullptr;      ///< of this object, until it changes
    const MoodPose* pose = nullptr;  ///< its pose, likewise
    double share = 0;                ///< above 0; all together are 1
  };
  /// What the pose at a time consists of.
  std::vector<Share> shares(double seconds) const;
  /// Forgets what is over before `seconds`, which at() must then not ask for.
  void forget(double seconds);
  /// The mood that was set last.
  const Mood& mood() const { return steps_.back().mood; }
  /// Nothing is to be shown at any time from the last forget() on.
  bool neutral() const;

 private:
  struct Step {
    double begin = 0, duration = 1;  // seconds
    Mood mood;
    MoodPose pose;
  };
  std::vector<Step> steps_;  // by begin; the first one has always been
};

/// What spans and the mood around them amount to: one mood after the other. Spans of the same mood
/// less than 0.6 s apart are one.
class MoodTrack {
 public:
  /// `around`: where no span says otherwise. Spans in any order, the later ones inside of the
  /// earlier.
  explicit MoodTrack(const Mood& around = {}, std::span<const MoodSpan> spans = {});

  /// One mood from `start` on.
  struct Part {
    double start = 0;  ///< seconds; -infinity for the first one
    Mood mood;         ///< until the next part
  };
  /// In time order, at least one.
  const std::vector<Part>& parts() const { return parts_; }
  /// No mood anywhere.
  bool neutral() const;
  /// The blend of all parts. A mood begins kMoodLead before its time.
  MoodBlend blend() const;

 private:
  std::vector<Part> parts_;
};

/// Seconds by which a mood begins before the words that it is for.
inline constexpr double kMoodLead = 0.2;

/// What the sounds of a script leave to the mouth of a mood.
class MoodMouth {
 public:
  /// An empty script leaves everything.
  explicit MoodMouth(const Script& script = {});

  /// Shares at one instant, 0..1.
  struct Shares {
    double speech = 0;  ///< 1: something is said
    double round = 0;   ///< 1: the lips are rounded
    double teeth = 0;   ///< 1: the teeth are together (S, SH)
    double bite = 0;    ///< 1: the lower lip is at the teeth (F, V)
    double shut = 0;    ///< 1: the lips are shut (P, B, M), by the times of the phones
    double jaw = 0;     ///< 1: the jaw is up for P, B, M, F or V; slower than the lips
  };
  /// Cheap if times ascend.
  Shares at(double seconds) const;

 private:
  struct Window {
    double start, end;  // seconds
  };
  static double inside(const std::vector<Window>& windows, double seconds, double ramp);

  std::vector<Window> speech_, teeth_, bites_, shuts_;  // by start
  LipRounding rounding_;
};

/// Adds moods to rows of a signal of FAPs.
class MoodLayer {
 public:
  /// `names`: the channels of the rows. Only those that are FAPs are changed.
  explicit MoodLayer(std::span<const std::string> names);
  /// Rows have a value for each FAP, by its number.
  MoodLayer();
  /// Adds the pose of one instant to a row, which has as many values as there are names.
  void add(const MoodPose& pose, const MoodMouth::Shares& shares, std::span<double> row) const;

 private:
  void move_mouth(const MoodPose& pose, const MoodMouth::Shares& shares,
                  std::span<double> row) const;

  std::array<std::ptrdiff_t, fap::kFapCount + 1> channel_;  // -1: none
};

/// Adds the pose of one instant to a frame of speech, rounded to whole units and clipped as
/// to_sequence() does. FAPs that it moves become part of the frame.
void add_mood(const MoodPose& pose, const MoodMouth::Shares& shares, fap::Frame& frame);

/// Adds moods to a clip of FAPs, or of ARKit's shapes (by fap::ArkitFitter; without the style),
/// that shows `script`: to channels that it has, and in channels that it lacks. Call it after
/// add_idle_motion(). A track without any mood changes nothing. Errors: unsupported (neither FAPs
/// nor ARKit's shapes).
Result<void> add_moods(Signal& signal, const Script& script, const MoodTrack& track);

/// Where FAP 2 goes.
enum class ExpressionPlace : std::uint8_t {
  instead,  ///< replaces brows, cheeks, nose and (but for blinks) lids
  beside,   ///< these stay; players show one or the other in such frames
};

/// Codes the moods of a track as FAP 2 in every frame of `clip`: the two strongest of the six
/// expressions, with intensities of 0 to 63.
void show_expressions(const MoodTrack& track, fap::Sequence& clip, ExpressionPlace place);

}  // namespace animeme::dam

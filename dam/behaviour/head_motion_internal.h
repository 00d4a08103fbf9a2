// How a head moves: posture, the bands of ordinary and rapid motion, gestures at accents and ends,
// breath, its share of gaze shifts, and what follows the pitch of a voice.
#pragma once

#include <deque>
#include <vector>

#include "dam/behaviour/curves_internal.h"
#include "dam/behaviour/gaze_internal.h"
#include "dam/behaviour/mode_internal.h"
#include "dam/behaviour/speech_plan.h"

namespace animeme::dam::behaviour {

/// Degrees, as FAPs turn: down, left, to the right shoulder.
struct HeadPose {
  double pitch = 0, yaw = 0, roll = 0;
};

class HeadMotion {
 public:
  explicit HeadMotion(std::uint64_t seed);
  /// Speech whose plan begins at `start`; gestures of its accents and phrases begin at `now` or
  /// later.
  void speak(const SpeechPlan& plan, double start, double now);
  /// The phrase that ended last goes on: it has no end there.
  void go_on(double now);
  void hush(double now);
  /// The other one can be heard: no nods but those of pause_of_other().
  void nod_at_pauses_only();
  /// The other one pauses: often a reason to nod. False: nods have been enough, for now.
  bool pause_of_other(double now);
  /// It is turned from the beginning on.
  void start_turned(const Aim& goal) {
    turn_goal_ = goal;
    turn_pitch_.value = goal.pitch;
    turn_yaw_.value = goal.yaw;
  }
  /// The head turns to a share of where the eyes went, some time after.
  void follow_eyes(const Aim& goal, double time);
  /// Without its share of gaze, liveliness 1; times do not decrease, `seconds` since the last.
  HeadPose at(double time, double seconds, Mode mode);
  /// Of the turn to where the eyes went.
  Aim turned() const { return {turn_yaw_.value, turn_pitch_.value, 0}; }
  /// 0..1: air in the lungs above rest.
  double breath() const { return breath_.value; }
  std::size_t nods() const { return nods_; }

 private:
  struct Contour {
    double start = 0, step = 0.01;
    std::vector<float> pitch, level;
    double end() const { return start + step * double(pitch.size()); }
  };
  void nod(const SpeechAccent& accent, double start, double now);
  void end_phrase(const SpeechPhrase& phrase, double start, double now);
  void shift_posture(double time, Mode mode, double share);
  void backchannel(double time);
  void breathe(double time, double seconds, Mode mode);
  void follow_voice(double time, double seconds);

  Draw draw_;
  Mode mode_ = Mode::idle;
  HeadPose goal_;                        // of the posture
  Follower posture_[3], posture_of_[3];  // two in a row: no corner in speed
  double next_shift_ = 0, last_shift_ = -10;
  Gestures<3> gestures_;
  std::deque<double> begins_;   // of phrases
  std::deque<double> inhales_;  // before phrases
  SlowNoise slow_[3];
  BandNoise ordinary_[3], rapid_[3];
  Follower amplitude_;
  double next_nod_ = 0, last_nod_ = -10;
  bool hears_ = false;  // the other one
  double inhale_until_ = -1, next_breath_ = 0, quick_ = 1;
  Follower breath_;
  std::deque<Contour> voices_;
  Follower voice_, voice_trend_, loudness_;
  double lean_[2] = {};  // how far yaw and roll go with the voice
  Aim turn_goal_, turn_next_;
  double turn_at_ = -1, turn_seconds_ = 0.1;
  Follower turn_pitch_, turn_yaw_;
  std::size_t nods_ = 0;
};

}  // namespace animeme::dam::behaviour

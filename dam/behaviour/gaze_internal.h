// Where the eyes are aimed at: eye contact, looks away, saccades, small movements of fixation.
#pragma once

#include <array>
#include <deque>
#include <limits>
#include <optional>

#include "dam/behaviour/curves_internal.h"
#include "dam/behaviour/look.h"
#include "dam/behaviour/mode_internal.h"

namespace animeme::dam::behaviour {

/// A place in the world, seen from between the eyes: degrees to the left and down, and 1 / metres.
struct Aim {
  double yaw = 0, pitch = 0, nearness = 0;
};

/// A saccade that begins.
struct GazeShift {
  double time = 0;
  double size = 0;  ///< degrees
};

class Gaze {
 public:
  Gaze(std::uint64_t seed, double liveliness, double end, const Look& look);
  void look(const Look& target, double now);
  /// An utterance from `start` to `end` will be spoken, or the rest of one: away while it is
  /// planned, back at its end.
  void expect_utterance(double start, double end, double now, bool begins);
  /// A pause inside it.
  void expect_pause(double start, double end, double now);
  void hush(double now);
  /// What begins before `until`. Gives the largest shift.
  std::optional<GazeShift> advance(double now, double until, Mode mode);
  Aim at(double time);
  /// What the head turns to, degrees: its share of where the eyes are going.
  Aim head_goal() const;
  /// Of the last saccade, degrees.
  double size() const { return size_; }
  /// At the target of look(), within some degrees.
  bool at_target() const { return !away_; }

 private:
  struct Forced {
    double time = 0;
    bool away = false;
    double until = 0;
  };
  struct Offset {
    double yaw = 0, pitch = 0;
  };
  void set_base(const Look& target);
  void go_away(double time, double seconds, Mode mode);
  void come_back(double time, Mode mode);
  void scan(double time);
  void saccade(double time, const Offset& to, double nearness);
  void force(const Forced& forced);
  double next_event() const;
  void handle(double time, Mode mode);
  double at_seconds(Mode mode);
  double away_seconds(Mode mode);
  double scan_seconds();
  Offset away_offset(Mode mode);

  Draw draw_;
  double liveliness_, end_;
  Aim base_;
  bool averted_ = false;  // Look::Kind::away
  bool away_ = false;
  Mode mode_ = Mode::idle;
  Offset offset_;  // of the fixation from the base
  Offset micro_;   // of a micro-saccade
  Aim from_, to_;  // of the saccade
  double start_ = -1, duration_ = 0, skew_ = 1;
  double size_ = 0;  // of the last one
  double mode_end_ = 0, next_scan_ = 0, next_micro_ = 0;
  double held_until_ = 0;  // eye contact
  std::deque<Forced> forced_;
  SlowNoise drift_yaw_, drift_pitch_;
};

/// Angles of the eyes in a head that is turned (radians, as FAPs): they turn against it, and
/// towards each other for what is near. Each within its reach.
struct EyeAngles {
  std::array<double, 2> yaw = {}, pitch = {};
};
EyeAngles eyes_in_head(const Aim& aim, double head_pitch, double head_yaw, double head_roll);

}  // namespace animeme::dam::behaviour

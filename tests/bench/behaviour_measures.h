// Measures of gaze, blinks, head and brows as they are shown, by behaviour_table.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dam/behaviour/behaviour.h"

namespace animeme::bench {

/// Moments at a constant rate, and what was said meanwhile.
struct Shown {
  double hertz = 0;
  std::vector<dam::FaceMoment> moments;
  std::vector<dam::SpeechPhrase> phrases;
  std::vector<dam::SpeechAccent> accents;
  std::vector<float> semitones;  // one a moment; NaN outside speech

  double time(std::size_t i) const { return double(i) / hertz; }
};

/// Numbers of one kind.
struct Sample {
  std::vector<double> values;
  double mean() const;
  double deviation() const;
  double median() const;
  /// Share of those below or at `limit`.
  double share_to(double limit) const;
};

/// Found by their speed, 30 degrees/s of the gaze.
struct SaccadesSeen {
  Sample size, seconds;             // degrees
  double intercept = 0, slope = 0;  // ms, and ms a degree, of the seconds over the size
  double peak_10 = 0;               // mean peak velocity of those of 8 to 12 degrees
  std::array<double, 8>
      directions{};  // percent from right counter-clockwise, those from the target
};
SaccadesSeen saccades_of(const Shown& shown);

/// Where the eyes look: within 3 degrees of straight ahead or not.
struct ContactSeen {
  double share = 0;
  Sample at, away;  // seconds
};
ContactSeen contact_of(const Shown& shown);

struct BlinksSeen {
  double a_minute = 0;
  Sample interval, down, up;                                    // seconds
  double half = 0, doubled = 0, at_borders = 0, by_chance = 0;  // shares
};
BlinksSeen blinks_of(const Shown& shown);

struct HeadSeen {
  std::array<double, 3> deviation{};  // degrees: pitch, yaw, roll
  std::array<double, 3> bands{};      // share of the velocity's power: below 1.8, to 3.7, to 7 Hz
  double fastest = 0;                 // degrees a second
  double with_pitch = 0;              // mean over phrases of the correlation with F0, sign left out
};
HeadSeen head_of(const Shown& shown);

struct BrowsSeen {
  double a_minute = 0;
  Sample seconds;
  double at_rise = 0;     // share of raises in speech that go with an accent the pitch rises to
  double of_accents = 0;  // accents with a raise
};
BrowsSeen brows_of(const Shown& shown);

}  // namespace animeme::bench

/// @file
/// Pitch and level of a voice, for motion that follows them. tools/speech/voice/pitch.h measures
/// them in a sound.
#pragma once

#include <vector>

namespace animeme::dam {

/// Values at the times 0, step, 2 step ... Both lists have the same length; empty: not known.
struct Prosody {
  double step = 0.01;        ///< seconds between values, > 0
  std::vector<float> pitch;  ///< fundamental frequency in Hz, 0 where there is no voice
  std::vector<float> level;  ///< RMS of the sound, full scale 1
};

}  // namespace animeme::dam

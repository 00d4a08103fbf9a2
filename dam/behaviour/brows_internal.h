// Brows that rise and frown, and what goes with them in cheeks and lids.
#pragma once

#include <array>
#include <cstddef>

#include "dam/behaviour/curves_internal.h"
#include "dam/behaviour/mode_internal.h"
#include "dam/behaviour/speech_plan.h"

namespace animeme::dam::behaviour {

/// ENS units but `squeeze`, ES units. Left first.
struct BrowPose {
  std::array<double, 2> inner = {}, middle = {}, outer = {}, squeeze = {};
  double cheek = 0;
};

class Brows {
 public:
  /// `questions_only`: they rise at questions, and do nothing else.
  Brows(std::uint64_t seed, bool questions_only);
  /// As HeadMotion has it.
  void speak(const SpeechPlan& plan, double start, double now);
  void go_on(double now);
  void hush(double now);
  BrowPose at(double time, Mode mode);
  std::size_t raises() const { return raises_; }

 private:
  static constexpr std::size_t kChannels = 8;  // inner, middle, outer of both sides, squeeze, cheek
  using One = Gesture<kChannels>;
  void accent(const SpeechAccent& accent, double start, double now);
  void question(const SpeechPhrase& phrase, double start, double now);
  void by_itself(double time, Mode mode);
  void raise(One& gesture, double size);
  void frown(One& gesture, double size);

  Draw draw_;
  bool questions_only_;
  Mode mode_ = Mode::idle;
  Gestures<kChannels> gestures_;
  double last_apex_ = -10;
  double next_ = 0;  // of those without speech
  std::size_t raises_ = 0;
};

}  // namespace animeme::dam::behaviour

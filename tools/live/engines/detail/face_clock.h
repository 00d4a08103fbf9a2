// When faces were, by the clock of their sender as far as it can be believed.
#pragma once

#include <optional>

namespace animeme::engines {

/// Seconds that ascend, from 0. The sender's step counts if it is no longer than a quarter of a
/// second, or about as long as time has passed, and while all steps together are no more than five
/// seconds ahead of time; else the arrival does. Source: tools/formats/media/live/receiving.md,
/// section 2.
class FaceClock {
 public:
  /// The time of the next face; nothing: it is older than the one before, by less than a second,
  /// and comes too late.
  std::optional<double> time(std::optional<double> sender, double arrival);

 private:
  std::optional<double> sender_, arrival_;  // of the face before
  double begin_ = 0;                        // arrival of the first
  double time_ = 0;
  int late_ = 0;  // faces in a row
};

}  // namespace animeme::engines

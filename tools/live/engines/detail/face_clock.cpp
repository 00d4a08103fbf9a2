#include "tools/live/engines/detail/face_clock.h"

#include <algorithm>
#include <cmath>

namespace animeme::engines {
namespace {

constexpr double kFreeStep = 0.25;  // seconds that the sender is believed, whatever time it is
constexpr double kNear = 0.5;       // seconds between its step and ours
constexpr double kLate = 1;         // seconds back that are a late packet, not a clock set anew
constexpr double kAhead = 5;        // seconds that all steps may be ahead of time
constexpr int kMostLate = 4;        // late ones in a row; more are a clock that stands still

}  // namespace

std::optional<double> FaceClock::time(std::optional<double> sender, double arrival) {
  if (!arrival_) {
    sender_ = sender;
    begin_ = arrival;
    arrival_ = arrival;
    return time_;
  }
  const double passed = std::max(0.0, arrival - *arrival_);
  double step = passed;
  if (sender && sender_) {
    const double own = *sender - *sender_;
    if (own <= 0 && own > -kLate) {
      if (late_ < kMostLate) {
        ++late_;
        return std::nullopt;
      }
    } else {
      late_ = 0;
    }
    if (own > 0 && (own <= kFreeStep || std::abs(own - passed) <= kNear)) step = own;
  }
  if (time_ + step > arrival - begin_ + kAhead) step = passed;
  sender_ = sender;
  arrival_ = arrival;
  time_ += step;
  return time_;
}

}  // namespace animeme::engines

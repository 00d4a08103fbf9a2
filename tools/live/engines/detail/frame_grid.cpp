#include "tools/live/engines/detail/frame_grid.h"

#include <algorithm>
#include <cmath>

namespace animeme::engines {
namespace {

constexpr double kMostHold = 10;  // seconds that a plane is sent again at most
constexpr double kLittle = 1e-6;  // seconds: what rounding may do

}  // namespace

std::vector<TimedFace> FrameGrid::push(double seconds, double duration, double period,
                                       const Face& face) {
  period_ = period;
  std::vector<TimedFace> out;
  const double held = std::min(duration, kMostHold);
  if (!rate_) {
    for (double at = 0; at == 0 || at < held - period / 2; at += period) {
      out.push_back({seconds + at, face});
    }
    return out;
  }
  const bool first = !last_ || seconds < last_->seconds;
  if (first) next_ = std::ceil((seconds - kLittle) * *rate_);
  const double begin = first ? seconds : std::max(last_->seconds, seconds - period);
  // A pause that was longer than is sent again leaves its places out.
  next_ = std::max(next_, std::ceil((begin - kLittle) * *rate_));
  for (; next_ / *rate_ < seconds + held - period + kLittle || next_ / *rate_ <= seconds + kLittle;
       ++next_) {
    const double at = next_ / *rate_;
    const bool on_the_way = !first && at < seconds - kLittle && seconds > begin;
    out.push_back({at, on_the_way ? between(last_->face, face,
                                            std::clamp((at - begin) / (seconds - begin), 0.0, 1.0))
                                  : face});
  }
  last_ = TimedFace{seconds, face};
  end_ = seconds + held;
  return out;
}

std::vector<TimedFace> FrameGrid::finish() {
  std::vector<TimedFace> out;
  if (!last_) return out;
  for (; next_ / *rate_ < end_ - kLittle; ++next_) out.push_back({next_ / *rate_, last_->face});
  last_.reset();
  return out;
}

}  // namespace animeme::engines

// When frames go out: with their planes, or on a grid of their own between them.
#pragma once

#include <optional>
#include <vector>

#include "tools/live/engines/detail/face.h"

namespace animeme::engines {

struct TimedFace {
  double seconds = 0;  ///< presentation time
  Face face;
};

class FrameGrid {
 public:
  /// `rate`: frames a second; nothing: as many as there are planes.
  explicit FrameGrid(std::optional<double> rate) : rate_(rate) {}

  /// The frames that are known once a plane is there, ascending: with a rate those up to it, on
  /// the way from the plane before, and those while it holds. That way is one frame of the
  /// stream long, `period` seconds: a plane that is shown for longer stays as it is until then.
  std::vector<TimedFace> push(double seconds, double duration, double period, const Face& face);
  /// Those that are left when the last plane is over.
  std::vector<TimedFace> finish();
  /// How much later than their time frames can go out, all of them: seconds, after a plane.
  double delay() const { return rate_ ? period_ : 0; }

 private:
  std::optional<double> rate_;
  double period_ = 0;
  double end_ = 0;                 // of the last plane
  std::optional<TimedFace> last_;  // plane
  double next_ = 0;                // place on the grid
};

}  // namespace animeme::engines

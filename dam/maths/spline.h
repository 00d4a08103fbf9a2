// Natural cubic splines through equally spaced samples (section V-A of the paper).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace animeme::dam {

/// A natural cubic spline through (0, y0), (1, y1) ... Constant beyond both ends.
class Spline {
 public:
  /// `samples` must not be empty.
  explicit Spline(std::vector<double> samples);
  double operator()(double x) const;

 private:
  std::vector<double> samples_;
  std::vector<double> curvature_;  ///< second derivative at the samples
};

}  // namespace animeme::dam

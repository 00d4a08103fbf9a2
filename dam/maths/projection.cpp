#include "dam/maths/projection.h"

#include <algorithm>
#include <cmath>

#include "dam/maths/linear_algebra.h"

namespace animeme::dam {

std::vector<double> damped_step(std::span<const double> gradient, std::span<const double> hessian,
                                double damping) {
  constexpr double kMostLogStep = 0.7;
  const std::size_t n = gradient.size();
  std::vector<double> h(hessian.begin(), hessian.end());
  for (std::size_t i = 0; i < n; ++i) h[i * n + i] += damping * std::abs(h[i * n + i]) + 1e-9;
  std::vector<double> delta = solve_symmetric(h, gradient);
  for (double& d : delta) d = std::isfinite(d) ? std::clamp(d, -kMostLogStep, kMostLogStep) : 0.0;
  return delta;
}

void project_out(std::span<const double> factor, std::size_t unknowns,
                 std::span<const double> cross, std::size_t controls, std::span<double> hessian,
                 std::size_t parameters) {
  std::vector<double> b(unknowns * parameters);
  for (std::size_t c = 0; c < controls; ++c) {
    for (std::size_t u = 0; u < unknowns; ++u)
      for (std::size_t g = 0; g < parameters; ++g)
        b[g * unknowns + u] = cross[(u * parameters + g) * controls + c];
    solve_lower(factor, unknowns, b, parameters);
    subtract_gram(b, unknowns, parameters, 1, hessian);
  }
}

}  // namespace animeme::dam

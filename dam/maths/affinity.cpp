#include "dam/maths/affinity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace animeme::dam {
namespace {

constexpr double kTie = 1e-6;

struct Messages {
  std::size_t n;
  std::vector<double> s, r, a;  // similarity, responsibility, availability
  std::vector<double> column_sum;
  double damping;

  void update_responsibilities() {
    for (std::size_t i = 0; i < n; ++i) {
      const double *si = &s[i * n], *ai = &a[i * n];
      double best = -std::numeric_limits<double>::infinity(), second = best;
      std::size_t best_at = 0;
      for (std::size_t k = 0; k < n; ++k) {
        const double v = si[k] + ai[k];
        if (v > best) {
          second = best;
          best = v;
          best_at = k;
        } else if (v > second) {
          second = v;
        }
      }
      double* ri = &r[i * n];
      const double old = ri[best_at];
      for (std::size_t k = 0; k < n; ++k) ri[k] = damping * ri[k] + (1 - damping) * (si[k] - best);
      ri[best_at] = damping * old + (1 - damping) * (si[best_at] - second);
    }
  }

  void update_availabilities() {
    std::fill(column_sum.begin(), column_sum.end(), 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) column_sum[k] += std::max(0.0, r[i * n + k]);
    // The sum counts a point's own responsibility in full, not only its positive part.
    for (std::size_t k = 0; k < n; ++k) column_sum[k] += r[k * n + k] - std::max(0.0, r[k * n + k]);
    for (std::size_t i = 0; i < n; ++i) {
      double* ai = &a[i * n];
      const double* ri = &r[i * n];
      const double own = ai[i];
      for (std::size_t k = 0; k < n; ++k) {
        const double v = std::min(0.0, column_sum[k] - std::max(0.0, ri[k]));
        ai[k] = damping * ai[k] + (1 - damping) * v;
      }
      ai[i] = damping * own + (1 - damping) * (column_sum[i] - ri[i]);
    }
  }

  std::vector<std::size_t> exemplars() const {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < n; ++k)
      if (r[k * n + k] + a[k * n + k] > 0) found.push_back(k);
    return found;
  }

  /// True if every point would choose an exemplar. Early on, damping can hold a set of exemplars
  /// still that most points do not accept yet.
  bool accepted(const std::vector<std::size_t>& found) const {
    std::vector<char> is_exemplar(n, 0);
    for (const std::size_t k : found) is_exemplar[k] = 1;
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t best = 0;
      for (std::size_t k = 1; k < n; ++k)
        if (a[i * n + k] + r[i * n + k] > a[i * n + best] + r[i * n + best]) best = k;
      if (is_exemplar[best] == 0) return false;
    }
    return !found.empty();
  }
};

std::vector<std::size_t> labels_of(std::span<const double> similarity, std::size_t n,
                                   const std::vector<std::size_t>& exemplars) {
  std::vector<std::size_t> label(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < exemplars.size(); ++c) {
      const double v = exemplars[c] == i ? std::numeric_limits<double>::infinity()
                                         : similarity[i * n + exemplars[c]];
      if (v > best) {
        best = v;
        label[i] = c;
      }
    }
  }
  return label;
}

/// Two points that are equally good exemplars for each other would never agree: makes the later one
/// less attractive by a trifle (others add noise, but results must not depend on chance).
void break_ties(std::vector<double>& s, std::size_t n) {
  double scale = 0;
  for (const double v : s) scale = std::max(scale, std::abs(v));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) s[i * n + k] -= kTie * scale * double(k) / double(n);
}

/// The point most alike to all others: the exemplar if everything is one cluster.
std::size_t centre(std::span<const double> similarity, std::size_t n) {
  std::size_t best_at = 0;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (i != k) sum += similarity[i * n + k];
    if (sum > best) {
      best = sum;
      best_at = k;
    }
  }
  return best_at;
}

}  // namespace

Clusters affinity_propagation(std::span<const double> similarity, double preference,
                              const AffinityOptions& options) {
  const auto n = std::size_t(std::llround(std::sqrt(double(similarity.size()))));
  Messages m{n,
             {similarity.begin(), similarity.end()},
             std::vector<double>(n * n, 0.0),
             std::vector<double>(n * n, 0.0),
             std::vector<double>(n, 0.0),
             options.damping};
  for (std::size_t k = 0; k < n; ++k) m.s[k * n + k] = preference;
  break_ties(m.s, n);
  Clusters result;
  std::vector<std::size_t> last;
  int unchanged = 0;
  while (n > 1 && result.iterations < options.max_iterations && !result.converged) {
    ++result.iterations;
    m.update_responsibilities();
    m.update_availabilities();
    std::vector<std::size_t> now = m.exemplars();
    unchanged = now == last ? unchanged + 1 : 0;
    last = std::move(now);
    result.converged = unchanged >= options.stable && m.accepted(last);
  }
  result.exemplars = last.empty() ? std::vector<std::size_t>{centre(similarity, n)} : last;
  result.label = labels_of(similarity, n, result.exemplars);
  return result;
}

}  // namespace animeme::dam

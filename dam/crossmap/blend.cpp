#include "dam/crossmap/blend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "dam/crossmap/bounded_least_squares.h"

namespace animeme::dam {

namespace {

// Each of `columns` columns of a table, row by row, averaged over time by a bell of this standard
// deviation in rows, cut off at three of them; at the ends over what is there. 0: as it is.
void smooth_columns(std::vector<double>& table, std::size_t columns, double deviation) {
  if (!(deviation > 0) || columns == 0) return;
  const std::size_t rows = table.size() / columns;
  const auto reach = std::size_t(std::ceil(3 * deviation));
  std::vector<double> bell;
  for (std::size_t k = 0; k <= reach; ++k) {
    bell.push_back(std::exp(-0.5 * double(k * k) / (deviation * deviation)));
  }
  const std::vector<double> before = table;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t first = i > reach ? i - reach : 0, last = std::min(rows - 1, i + reach);
    double sum = 0;
    for (std::size_t j = first; j <= last; ++j) sum += bell[j > i ? j - i : i - j];
    for (std::size_t c = 0; c < columns; ++c) {
      double mean = 0;
      for (std::size_t j = first; j <= last; ++j) {
        mean += bell[j > i ? j - i : i - j] * before[j * columns + c];
      }
      table[i * columns + c] = mean / sum;
    }
  }
}

// What holds the sum of coefficients at 1, as a multiple of the largest shape.
constexpr double kHolds = 1e3;

Error bad_blend(const std::string& text) { return make_error(Code::invalid_argument, text); }

Result<void> check_blend(const PointTrack& track, const KeyShapes& keys,
                         std::span<const Region> regions, const BlendOptions& options) {
  if (auto ok = check_tracks({&track, 1}); !ok) return ok;
  if (keys.names.empty()) return bad_blend("there is no key shape to fit frames to");
  if (keys.values.size() != keys.names.size() * track.size()) {
    return bad_blend("the key shapes have other points than the recording");
  }
  for (std::size_t k = 0; k < keys.values.size(); ++k) {
    if (std::isfinite(keys.values[k])) continue;
    return bad_blend("the key shape " + keys.names[k / track.size()] + " lacks the point " +
                     track.names[k % track.size() / track.dimensions]);
  }
  const std::size_t points = track.names.size();
  if (!options.weights.empty() && options.weights.size() != points) {
    return bad_blend("each point has one weight");
  }
  for (const double weight : options.weights) {
    if (!(weight >= 0 && weight <= 1e6)) return bad_blend("weights of points are 0 to a million");
  }
  if (!(options.contact_weight >= 0 && options.contact_weight <= 1e6)) {
    return bad_blend("the weight of contacts is 0 to a million");
  }
  if (!(options.ridge >= 0 && options.ridge <= 1)) return bad_blend("the ridge is 0 to 1");
  if (!(options.smooth >= 0 && options.smooth <= 1))
    return bad_blend("smoothing must be 0 to 1 second");
  for (const Contact& contact : options.contacts) {
    if (contact.first >= points || contact.second >= points)
      return bad_blend("no such point meets");
  }
  for (const Region& region : regions) {
    for (const std::size_t point : region.points) {
      if (point >= points) return bad_blend("the region " + region.name + " has an invalid point");
    }
  }
  return {};
}

// The system of the frames in which the same points are seen.
class BlendSystem {
 public:
  BlendSystem(const PointTrack& track, const KeyShapes& keys, const BlendOptions& options)
      : dimensions_(track.dimensions), size_(track.size()), keys_(keys), options_(options) {
    for (const double value : keys.values) largest_ = std::max(largest_, std::abs(value));
    if (largest_ == 0) largest_ = 1;
  }

  /// Coefficients of a frame; `seen`: one per point, one of them true.
  std::span<const double> fit(std::span<const double> shape, const std::vector<bool>& seen) {
    if (!solver_ || seen != seen_) make(seen);
    target_.clear();
    for (const Term& term : terms_) {
      target_.push_back(term.weight * (term.other < 0
                                           ? shape[term.place]
                                           : shape[term.place] - shape[std::size_t(term.other)]));
    }
    if (options_.convex) target_.push_back(kHolds * largest_);
    return solver_->fit(target_).first(keys_.names.size());
  }

 private:
  // A row: a coordinate, or the difference of two.
  struct Term {
    std::size_t place = 0;
    std::ptrdiff_t other = -1;
    double weight = 1;
  };

  double weight_of(std::size_t point) const {
    return options_.weights.empty() ? 1 : options_.weights[point];
  }

  void make(const std::vector<bool>& seen) {
    seen_ = seen;
    terms_.clear();
    for (std::size_t k = 0; k < size_; ++k) {
      const double weight = weight_of(k / dimensions_);
      if (seen[k / dimensions_] && weight > 0) terms_.push_back({k, -1, weight});
    }
    for (const Contact& contact : options_.contacts) {
      if (!seen[contact.first] || !seen[contact.second] || options_.contact_weight <= 0) continue;
      for (std::size_t d = 0; d < dimensions_; ++d) {
        terms_.push_back({contact.first * dimensions_ + d,
                          std::ptrdiff_t(contact.second * dimensions_ + d),
                          options_.contact_weight});
      }
    }
    // One more unknown for the neutral shape, which adds nothing but to the sum.
    const std::size_t shapes = keys_.names.size(), columns = shapes + (options_.convex ? 1 : 0);
    std::vector<double> matrix;
    for (const Term& term : terms_) {
      for (std::size_t s = 0; s < shapes; ++s) {
        const double* shape = &keys_.values[s * size_];
        matrix.push_back(term.weight * (term.other < 0
                                            ? shape[term.place]
                                            : shape[term.place] - shape[std::size_t(term.other)]));
      }
      if (options_.convex) matrix.push_back(0);
    }
    if (options_.convex) matrix.insert(matrix.end(), columns, kHolds * largest_);
    solver_.emplace(matrix, terms_.size() + (options_.convex ? 1 : 0), columns,
                    LeastSquaresLimits{.ridge = options_.convex ? 0 : options_.ridge});
  }

  std::size_t dimensions_, size_;
  const KeyShapes& keys_;
  const BlendOptions& options_;
  double largest_ = 0;
  std::vector<bool> seen_;
  std::vector<Term> terms_;
  std::vector<double> target_;
  std::optional<BoundedLeastSquares> solver_;
};

// Coefficients of frames without points, between those beside them.
void bridge(std::vector<double>& weights, std::size_t shapes, const std::vector<bool>& measured) {
  const std::size_t frames = measured.size();
  std::size_t last = frames;  // measured, so far
  for (std::size_t i = 0; i <= frames; ++i) {
    if (i < frames && !measured[i]) continue;
    const std::size_t begin = last == frames ? 0 : last + 1;
    for (std::size_t gap = begin; gap < i && gap < frames; ++gap) {
      const bool before = last < frames, after = i < frames;
      const double share = !before ? 1 : !after ? 0 : double(gap - last) / double(i - last);
      for (std::size_t s = 0; s < shapes; ++s) {
        const double a = before ? weights[last * shapes + s] : 0;
        const double b = after ? weights[i * shapes + s] : 0;
        weights[gap * shapes + s] = (1 - share) * a + share * b;
      }
    }
    last = i;
  }
}

void add_residuals(Blend& blend, const PointTrack& track, const KeyShapes& keys,
                   std::span<const Region> regions, const BlendOptions& options) {
  const std::size_t dimensions = track.dimensions;
  std::vector<double> squares(track.names.size());
  double all = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < track.frames(); ++i) {
    const std::vector<double> made = blended(blend, keys, i);
    const auto shape = track.frame(i);
    for (std::size_t p = 0; p < squares.size(); ++p) {
      squares[p] = std::numeric_limits<double>::quiet_NaN();
      if (!track.seen(i, p)) continue;
      squares[p] = 0;
      for (std::size_t k = p * dimensions; k < (p + 1) * dimensions; ++k) {
        squares[p] += (shape[k] - made[k]) * (shape[k] - made[k]);
      }
      if (!options.weights.empty() && options.weights[p] <= 0) continue;
      all += squares[p];
      ++count;
    }
    for (const Region& region : regions) {
      double sum = 0;
      std::size_t seen = 0;
      for (const std::size_t point : region.points) {
        if (std::isnan(squares[point])) continue;
        sum += squares[point];
        ++seen;
      }
      blend.residuals.push_back(seen > 0 ? std::sqrt(sum / double(seen))
                                         : std::numeric_limits<double>::quiet_NaN());
    }
  }
  blend.residual = count > 0 ? std::sqrt(all / double(count)) : 0;
}

}  // namespace

std::vector<double> blended(const Blend& blend, const KeyShapes& keys, std::size_t frame) {
  const std::size_t shapes = keys.names.size(), size = keys.values.size() / shapes;
  std::vector<double> out(size, 0.0);
  for (std::size_t s = 0; s < shapes; ++s) {
    const double weight = blend.weights[frame * shapes + s];
    if (weight == 0) continue;
    for (std::size_t k = 0; k < size; ++k) out[k] += weight * keys.values[s * size + k];
  }
  return out;
}

Result<Blend> fit_blend(const PointTrack& track, const KeyShapes& keys,
                        std::span<const Region> regions, const BlendOptions& options) {
  if (auto ok = check_blend(track, keys, regions, options); !ok) return ok.error();
  const std::size_t shapes = keys.names.size(), points = track.names.size();
  Blend blend;
  blend.weights.assign(track.frames() * shapes, 0.0);
  blend.measured.assign(track.frames(), false);
  BlendSystem system(track, keys, options);
  std::vector<bool> seen(points);
  for (std::size_t i = 0; i < track.frames(); ++i) {
    std::size_t count = 0, wanted = 0;
    for (std::size_t p = 0; p < points; ++p) {
      const bool counts = options.weights.empty() || options.weights[p] > 0;
      seen[p] = counts && track.seen(i, p);
      wanted += counts ? 1 : 0;
      count += seen[p] ? 1 : 0;
    }
    if (wanted == 0) return bad_blend("at least one point needs a weight above 0");
    if (count == 0) {
      ++blend.unseen;
      continue;
    }
    if (count < wanted) ++blend.partly;
    const auto alpha = system.fit(track.frame(i), seen);
    std::copy(alpha.begin(), alpha.end(), blend.weights.begin() + std::ptrdiff_t(i * shapes));
    blend.measured[i] = true;
  }
  if (blend.unseen == track.frames()) {
    return make_error(Code::not_found, (track.name.empty() ? "the recording" : track.name) +
                                           " has no frame in which a point is seen");
  }
  bridge(blend.weights, shapes, blend.measured);
  smooth_columns(blend.weights, shapes, options.smooth * track.rate.frames_per_second());
  add_residuals(blend, track, keys, regions, options);
  return blend;
}

}  // namespace animeme::dam

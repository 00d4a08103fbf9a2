#include "dam/training/alignment_map_internal.h"

#include <algorithm>
#include <cmath>

#include "dam/maths/linear_algebra.h"

namespace animeme::dam {
namespace {

constexpr double kShapeRidge = 0.02;  // of the variance of each shape

using ShapeSquare = std::array<double, kShapes * kShapes>;

/// The shapes that the script asks for while the motion was recorded, about their mean.
std::vector<Shapes> shapes_for(const Match& match, double lag) {
  std::vector<Shapes> shapes;
  Shapes mean{};
  for (const double time : match.motion->times) {
    shapes.push_back(match.script->at(time - lag));
    for (std::size_t a = 0; a < kShapes; ++a) mean[a] += shapes.back()[a];
  }
  for (Shapes& shape : shapes)
    for (std::size_t a = 0; a < kShapes; ++a) shape[a] -= mean[a] / double(shapes.size());
  return shapes;
}

double product(const Shapes& a, const Shapes& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kShapes; ++i) sum += a[i] * b[i];
  return sum;
}

/// A sentence's motion as seen through a map.
struct Seen {
  std::vector<Shapes> motion;  ///< per frame
  std::vector<double> energy;  ///< per frame
};

Seen see(const SentenceTrack& track, const ShapeMap& map) {
  const std::size_t k = map.explained.size();
  Seen seen{std::vector<Shapes>(track.frames(), Shapes{}), std::vector<double>(track.frames())};
  for (std::size_t i = 0; i < track.frames(); ++i) {
    for (std::size_t c = 0; c < k; ++c) {
      const double y = track.motion[i * k + c], weighted = map.explained[c] * y;
      seen.energy[i] += weighted * y;
      for (std::size_t a = 0; a < kShapes; ++a) seen.motion[i][a] += weighted * map.gain[a * k + c];
    }
  }
  return seen;
}

/// What the squares of shapes weigh, seen through a map.
ShapeSquare square_of(const ShapeMap& map) {
  const std::size_t k = map.explained.size();
  ShapeSquare square{};
  for (std::size_t a = 0; a < kShapes; ++a)
    for (std::size_t b = 0; b < kShapes; ++b)
      for (std::size_t c = 0; c < k; ++c)
        square[a * kShapes + b] += map.explained[c] * map.gain[a * k + c] * map.gain[b * k + c];
  return square;
}

double squared(const Shapes& x, const ShapeSquare& square) {
  double sum = 0;
  for (std::size_t a = 0; a < kShapes; ++a)
    for (std::size_t b = 0; b < kShapes; ++b) sum += x[a] * x[b] * square[a * kShapes + b];
  return sum;
}

double correlation_of(double both, double asked, double motion) {
  return asked * motion > 0 ? both / std::sqrt(asked * motion) : 0;
}

}  // namespace

ShapeMap fit_map(std::span<const Match> matches, double lag) {
  const std::size_t k = matches[0].motion->controls();
  std::vector<double> xx(kShapes * kShapes, 0.0), xy(kShapes * k, 0.0), yy(k, 0.0);
  for (const Match& match : matches) {
    const auto shapes = shapes_for(match, lag);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const double* y = &match.motion->motion[i * k];
      for (std::size_t a = 0; a < kShapes; ++a) {
        for (std::size_t b = 0; b < kShapes; ++b)
          xx[a * kShapes + b] += shapes[i][a] * shapes[i][b];
        for (std::size_t c = 0; c < k; ++c) xy[a * k + c] += shapes[i][a] * y[c];
      }
      for (std::size_t c = 0; c < k; ++c) yy[c] += y[c] * y[c];
    }
  }
  ShapeMap map{xy, std::vector<double>(k, 0.0), 0};
  std::vector<double> matrix = xx;
  for (std::size_t a = 0; a < kShapes; ++a)
    matrix[a * kShapes + a] += kShapeRidge * matrix[a * kShapes + a] + 1e-9;
  if (!cholesky_in_place(matrix, kShapes, 1)) return map;
  cholesky_solve(matrix, kShapes, map.gain, k, 1);
  double told = 0, all = 0;
  for (std::size_t c = 0; c < k; ++c) {
    double part = 0;
    for (std::size_t a = 0; a < kShapes; ++a) {
      part += 2 * map.gain[a * k + c] * xy[a * k + c];
      for (std::size_t b = 0; b < kShapes; ++b)
        part -= map.gain[a * k + c] * map.gain[b * k + c] * xx[a * kShapes + b];
    }
    if (yy[c] > 0) map.explained[c] = std::max(0.0, part / yy[c]);
    told += part;
    all += yy[c];
  }
  map.fit = all > 0 ? told / all : 0;
  return map;
}

std::vector<LagSums> match_at_lags(const Match& match, const ShapeMap& map, std::size_t pieces) {
  const Seen seen = see(*match.motion, map);
  const ShapeSquare square = square_of(map);
  std::vector<LagSums> all(pieces, {std::vector<double>(kLags), std::vector<double>(kLags), 0});
  for (std::size_t l = 0; l < kLags; ++l) {
    const auto shapes = shapes_for(match, lag_of(l));
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      LagSums& piece = all[i * pieces / shapes.size()];
      piece.both[l] += product(shapes[i], seen.motion[i]);
      piece.asked[l] += squared(shapes[i], square);
      if (l == 0) piece.motion += seen.energy[i];
    }
  }
  return all;
}

double match_at(const Match& match, const ShapeMap& map, double lag) {
  const Seen seen = see(*match.motion, map);
  const ShapeSquare square = square_of(map);
  const auto shapes = shapes_for(match, lag);
  double both = 0, asked = 0, motion = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    both += product(shapes[i], seen.motion[i]);
    asked += squared(shapes[i], square);
    motion += seen.energy[i];
  }
  return correlation_of(both, asked, motion);
}

std::vector<double> correlations(std::span<const LagSums* const> pieces) {
  std::vector<double> all(kLags, 0.0);
  for (std::size_t l = 0; l < kLags; ++l) {
    double both = 0, asked = 0, motion = 0;
    for (const LagSums* piece : pieces) {
      both += piece->both[l];
      asked += piece->asked[l];
      motion += piece->motion;
    }
    all[l] = correlation_of(both, asked, motion);
  }
  return all;
}

LagPeak peak_of(const std::vector<double>& r) {
  const auto at = std::size_t(std::max_element(r.begin(), r.end()) - r.begin());
  LagPeak peak{lag_of(at), r[at]};
  if (at == 0 || at + 1 == r.size()) return peak;
  const double bend = r[at - 1] + r[at + 1] - 2 * r[at];
  if (bend < 0) peak.lag += kLagStep * 0.5 * (r[at - 1] - r[at + 1]) / bend;
  return peak;
}

}  // namespace animeme::dam

#include "dam/maths/ridge_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dam/maths/parallel.h"
#include "dam/maths/tile_product.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kSide = 192;  // of a tile: a multiple of kTileRows and kTileColumns
constexpr std::size_t kTileSize = kSide * kSide;
constexpr std::size_t kPart = 48;  // right sides that one task solves
constexpr int kMostSteps = 300;
static_assert(kSide % kTileRows == 0 && kSide % kTileColumns == 0 && kPart % kTileRows == 0);

std::size_t padded_width(std::size_t columns) {
  return (columns + kTileRows - 1) / kTileRows * kTileRows;
}

/// Copies a block of the symmetric matrix on or below the diagonal, column by column; what lies
/// outside is zero.
void copy_block(const LowerTriangle& a, std::size_t i, std::size_t j, std::span<double> block) {
  const std::size_t n = a.rows(), rows = std::min(kSide, n - i * kSide);
  const std::size_t columns = std::min(kSide, n - j * kSide);
  if (rows < kSide || columns < kSide) std::fill(block.begin(), block.end(), 0.0);
  for (std::size_t c = 0; c < columns; ++c) {
    const auto from = a.below(j * kSide + c);
    const std::size_t first = i == j ? c : 0;  // on the diagonal the upper half comes below
    const auto begin = from.begin() + std::ptrdiff_t(i == j ? 0 : (i - j) * kSide - c);
    std::copy_n(begin, rows - first, block.begin() + std::ptrdiff_t(c * kSide + first));
  }
  for (std::size_t c = 0; i == j && c < columns; ++c)
    for (std::size_t r = c + 1; r < rows; ++r) block[r * kSide + c] = block[c * kSide + r];
}

}  // namespace

RidgeSolver::RidgeSolver(const LowerTriangle& a, std::span<const double> usual, int threads)
    : a_(a), threads_(threads), tiles_((a.rows() + kSide - 1) / kSide) {
  // Single precision may not do for sums that are nearly singular; a firmer factor still
  // preconditions, with more steps.
  double lift = 0;
  for (int attempt = 0; attempt < 6 && !ok_; ++attempt) {
    ok_ = factorise(usual, lift);
    lift = lift == 0 ? 1e-6 : lift * 10;
  }
}

float* RidgeSolver::tile(std::size_t i, std::size_t j) {
  return &factor_[(i * (i + 1) / 2 + j) * kTileSize];
}
const float* RidgeSolver::tile(std::size_t i, std::size_t j) const {
  return &factor_[(i * (i + 1) / 2 + j) * kTileSize];
}

bool RidgeSolver::factorise(std::span<const double> usual, double lift) {
  const std::size_t n = a_.rows();
  scale_.assign(tiles_ * kSide, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double square = a_.at(i, i) + usual[i];
    if (!(square > 0) || !std::isfinite(square)) return false;
    scale_[i] = 1 / std::sqrt(square);
  }
  factor_.resize(tiles_ * (tiles_ + 1) / 2 * kTileSize);
  inverse_.resize(tiles_ * kTileSize);
  parallel_for(tiles_, threads_, [&](std::size_t i) {
    std::vector<double> block(kTileSize);
    for (std::size_t j = 0; j <= i; ++j) {
      copy_block(a_, i, j, block);
      float* out = tile(i, j);
      for (std::size_t c = 0; c < kSide; ++c)
        for (std::size_t r = 0; r < kSide; ++r)
          out[c * kSide + r] =
              float(block[c * kSide + r] * scale_[i * kSide + r] * scale_[j * kSide + c]);
    }
    for (std::size_t r = 0; r < kSide; ++r) tile(i, i)[r * kSide + r] = float(1 + lift);
  });
  for (std::size_t k = 0; k < tiles_; ++k) {
    if (!factorise_corner(k)) return false;
    const Operand<float> inverse{&inverse_[k * kTileSize], 1, kSide};
    parallel_for(tiles_ - k - 1, threads_, [&](std::size_t t) {
      float* panel = tile(k + 1 + t, k);
      const std::vector<float> from(panel, panel + kTileSize);
      std::fill(panel, panel + kTileSize, 0.0F);
      subtract_tile_product(panel, kSide, from.data(), kSide, inverse, kSide, kSide, kSide);
    });
    std::vector<std::pair<std::size_t, std::size_t>> trailing;
    for (std::size_t i = k + 1; i < tiles_; ++i)
      for (std::size_t j = k + 1; j <= i; ++j) trailing.emplace_back(i, j);
    parallel_for(trailing.size(), threads_, [&](std::size_t t) {
      const auto [i, j] = trailing[t];
      subtract_tile_product(tile(i, j), kSide, tile(i, k), kSide, {tile(j, k), 1, kSide}, kSide,
                            kSide, kSide);
    });
  }
  return true;
}

/// The factor of a tile on the diagonal, and its inverse.
bool RidgeSolver::factorise_corner(std::size_t k) {
  float* __restrict l = tile(k, k);
  for (std::size_t c = 0; c < kSide; ++c) {
    for (std::size_t b = 0; b < c; ++b) {
      const float f = l[b * kSide + c];
      for (std::size_t r = c; r < kSide; ++r) l[c * kSide + r] -= f * l[b * kSide + r];
    }
    const float square = l[c * kSide + c];
    if (!(square > 0)) return false;
    const float root = 1 / std::sqrt(square);
    for (std::size_t r = c; r < kSide; ++r) l[c * kSide + r] *= root;
    for (std::size_t r = 0; r < c; ++r) l[c * kSide + r] = 0;
  }
  float* __restrict inverse = &inverse_[k * kTileSize];
  std::fill(inverse, inverse + kTileSize, 0.0F);
  for (std::size_t c = 0; c < kSide; ++c) {  // L times the column is a unit vector, times -1
    float* __restrict x = inverse + c * kSide;
    x[c] = -1;
    for (std::size_t b = c; b < kSide; ++b) {
      x[b] /= l[b * kSide + b];
      const float f = x[b];
      for (std::size_t r = b + 1; r < kSide; ++r) x[r] -= f * l[b * kSide + r];
    }
  }
  return true;
}

void RidgeSolver::precondition_part(float* x, std::size_t width, std::size_t first,
                                    std::size_t count) const {
  std::vector<float> old(kSide * width);
  const auto turn = [&](std::size_t k, std::size_t step, std::size_t stride) {
    float* here = x + k * kSide * width;
    for (std::size_t r = 0; r < kSide; ++r)
      for (std::size_t c = first; c < first + count; ++c) {
        old[r * width + c] = here[r * width + c];
        here[r * width + c] = 0;
      }
    subtract_tile_product(here + first, width, old.data() + first, width,
                          {&inverse_[k * kTileSize], step, stride}, count, kSide, kSide);
  };
  for (std::size_t k = 0; k < tiles_; ++k) {
    turn(k, 1, kSide);
    for (std::size_t i = k + 1; i < tiles_; ++i)
      subtract_tile_product(x + i * kSide * width + first, width, x + k * kSide * width + first,
                            width, {tile(i, k), 1, kSide}, count, kSide, kSide);
  }
  for (std::size_t k = tiles_; k-- > 0;) {
    for (std::size_t i = k + 1; i < tiles_; ++i)
      subtract_tile_product(x + k * kSide * width + first, width, x + i * kSide * width + first,
                            width, {tile(i, k), kSide, 1}, count, kSide, kSide);
    turn(k, kSide, 1);
  }
}

/// z = the usual matrix's inverse times r, in single precision.
void RidgeSolver::precondition(const std::vector<double>& r, std::size_t width,
                               std::vector<double>& z) const {
  // Columns of small residuals would leave the range of single precision.
  std::vector<double> most(width, 0.0);
  for (std::size_t i = 0; i < r.size(); ++i)
    most[i % width] = std::max(most[i % width], std::abs(r[i] * scale_[i / width]));
  std::vector<float> x(r.size());
  for (std::size_t i = 0; i < scale_.size(); ++i)
    for (std::size_t c = 0; c < width; ++c)
      x[i * width + c] = most[c] > 0 ? float(r[i * width + c] * scale_[i] / most[c]) : 0;
  parallel_for((width + kPart - 1) / kPart, threads_, [&](std::size_t p) {
    precondition_part(x.data(), width, p * kPart, std::min(kPart, width - p * kPart));
  });
  for (std::size_t i = 0; i < scale_.size(); ++i)
    for (std::size_t c = 0; c < width; ++c)
      z[i * width + c] = double(x[i * width + c]) * scale_[i] * most[c];
}

void RidgeSolver::multiply(std::span<const double> ridge, const std::vector<double>& x,
                           std::size_t width, std::vector<double>& product) const {
  parallel_for(tiles_, threads_, [&](std::size_t i) {
    std::vector<double> block(kTileSize);
    double* out = &product[i * kSide * width];
    std::fill(out, out + kSide * width, 0.0);
    for (std::size_t j = 0; j < tiles_; ++j) {
      copy_block(a_, std::max(i, j), std::min(i, j), block);
      const std::size_t step = j <= i ? 1 : kSide, stride = j <= i ? kSide : 1;
      subtract_tile_product(out, width, &x[j * kSide * width], width, {block.data(), step, stride},
                            width, kSide, kSide);
    }
    for (std::size_t r = 0; r < kSide; ++r) {
      const std::size_t row = i * kSide + r;
      const double more = row < ridge.size() ? ridge[row] : 0;
      for (std::size_t c = 0; c < width; ++c)
        out[r * width + c] = more * x[row * width + c] - out[r * width + c];
    }
  });
}

bool RidgeSolver::solve(std::span<const double> ridge, std::span<const double> right,
                        std::size_t columns, double tolerance, std::span<double> x) const {
  if (!ok_) return false;
  const std::size_t n = a_.rows(), width = padded_width(columns), size = scale_.size() * width;
  const auto along = [&](const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> sums(width, 0.0);
    for (std::size_t i = 0; i < size; i += width)
      for (std::size_t c = 0; c < width; ++c) sums[c] += a[i + c] * b[i + c];
    return sums;
  };
  const auto padded = [&](std::span<const double> rows) {
    std::vector<double> out(size, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      std::copy_n(rows.begin() + std::ptrdiff_t(i * columns), columns,
                  out.begin() + std::ptrdiff_t(i * width));
    return out;
  };
  std::vector<double> residual = padded(right), z(size), q(size);
  precondition(residual, width, z);
  std::vector<double> limit = along(residual, z);
  for (double& l : limit) l *= tolerance * tolerance;
  std::vector<double> best = padded(x);
  if (std::any_of(x.begin(), x.end(), [](double v) { return v != 0; })) {
    multiply(ridge, best, width, q);
    for (std::size_t i = 0; i < size; ++i) residual[i] -= q[i];
    precondition(residual, width, z);
  }
  std::vector<double> direction = z, rest = along(residual, z);
  bool done = false;
  for (int step = 0; step < kMostSteps && !done; ++step) {
    done = true;
    for (std::size_t c = 0; c < width; ++c) done = done && rest[c] <= limit[c];
    if (done) break;
    multiply(ridge, direction, width, q);
    const std::vector<double> bend = along(direction, q);
    std::vector<double> pace(width, 0.0);
    bool moves = false;
    for (std::size_t c = 0; c < width; ++c) {
      if (!(rest[c] > limit[c] && bend[c] > 0)) continue;
      pace[c] = rest[c] / bend[c];
      moves = true;
    }
    if (!moves) return false;
    for (std::size_t i = 0; i < size; i += width)
      for (std::size_t c = 0; c < width; ++c) {
        best[i + c] += pace[c] * direction[i + c];
        residual[i + c] -= pace[c] * q[i + c];
      }
    precondition(residual, width, z);
    const std::vector<double> next = along(residual, z);
    for (std::size_t i = 0; i < size; i += width)
      for (std::size_t c = 0; c < width; ++c)
        direction[i + c] =
            z[i + c] + (rest[c] > limit[c] ? next[c] / rest[c] : 0) * direction[i + c];
    rest = next;
  }
  for (std::size_t i = 0; i < n; ++i)
    std::copy_n(best.begin() + std::ptrdiff_t(i * width), columns,
                x.begin() + std::ptrdiff_t(i * columns));
  return done;
}

}  // namespace animeme::dam

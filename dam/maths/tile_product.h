// Products of small dense blocks, which is where training spends its time. Each number of the
// result is a sum in the order of `depth`, whatever vectors the machine has, so that all machines
// make the same bits.
#pragma once

#include <cstddef>

namespace animeme::dam {

/// A matrix operand of a block product: element (i, p) is at [i * step + p * stride].
template <class Number>
struct Operand {
  const Number* values;
  std::size_t step, stride;
};

/// Rows of blocks are multiples of this, columns of kTileColumns.
inline constexpr std::size_t kTileRows = 16, kTileColumns = 12;

/// c[r + i * c_stride] -= sum over p < depth of x[r + p * x_stride] * b(i, p), for r < rows and
/// i < columns.
void subtract_tile_product(float* c, std::size_t c_stride, const float* x, std::size_t x_stride,
                           Operand<float> b, std::size_t rows, std::size_t columns,
                           std::size_t depth);
void subtract_tile_product(double* c, std::size_t c_stride, const double* x, std::size_t x_stride,
                           Operand<double> b, std::size_t rows, std::size_t columns,
                           std::size_t depth);

}  // namespace animeme::dam

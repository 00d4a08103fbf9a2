#include "dam/maths/tile_product.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define ANIMEME_WIDE_VECTORS 1
#else
#define ANIMEME_WIDE_VECTORS 0
#endif

namespace animeme::dam {
namespace {

// One vector of rows times COLUMNS columns stays in registers. A macro, since a template or a
// lambda would not be compiled for the instructions of the function that uses it. Nothing is fused
// (-ffp-contract=off), so all widths give the same bits.
#define ANIMEME_TILE_PRODUCT(NAME, TARGET, NUMBER, BYTES, COLUMNS)                                 \
  TARGET void NAME(NUMBER* c, std::size_t c_stride, const NUMBER* x, std::size_t x_stride,         \
                   Operand<NUMBER> b, std::size_t rows, std::size_t columns, std::size_t depth) {  \
    typedef NUMBER Lanes __attribute__((vector_size(BYTES), aligned(alignof(NUMBER)), may_alias)); \
    constexpr std::size_t kLanes = (BYTES) / sizeof(NUMBER);                                       \
    for (std::size_t i = 0; i < columns; i += (COLUMNS))                                           \
      for (std::size_t r = 0; r < rows; r += kLanes) {                                             \
        Lanes sum[COLUMNS] = {};                                                                   \
        for (std::size_t p = 0; p < depth; ++p) {                                                  \
          const Lanes left = *reinterpret_cast<const Lanes*>(x + r + p * x_stride);                \
          const NUMBER* right = b.values + i * b.step + p * b.stride;                              \
          for (std::size_t j = 0; j < (COLUMNS); ++j) sum[j] += left * right[j * b.step];          \
        }                                                                                          \
        for (std::size_t j = 0; j < (COLUMNS); ++j)                                                \
          *reinterpret_cast<Lanes*>(c + r + (i + j) * c_stride) -= sum[j];                         \
      }                                                                                            \
  }

ANIMEME_TILE_PRODUCT(tile_product_16, , float, 16, 12)
ANIMEME_TILE_PRODUCT(tile_product_16, , double, 16, 12)
#if ANIMEME_WIDE_VECTORS
ANIMEME_TILE_PRODUCT(tile_product_32, __attribute__((target("avx2"))), float, 32, 12)
ANIMEME_TILE_PRODUCT(tile_product_32, __attribute__((target("avx2"))), double, 32, 12)
ANIMEME_TILE_PRODUCT(tile_product_64, __attribute__((target("avx512f"))), float, 64, 12)
ANIMEME_TILE_PRODUCT(tile_product_64, __attribute__((target("avx512f"))), double, 64, 12)
#endif

template <class Number>
using TileProduct = void (*)(Number*, std::size_t, const Number*, std::size_t, Operand<Number>,
                             std::size_t, std::size_t, std::size_t);

template <class Number>
TileProduct<Number> widest_product() {
#if ANIMEME_WIDE_VECTORS
  if (__builtin_cpu_supports("avx512f")) return tile_product_64;
  if (__builtin_cpu_supports("avx2")) return tile_product_32;
#endif
  return tile_product_16;
}

}  // namespace

void subtract_tile_product(float* c, std::size_t c_stride, const float* x, std::size_t x_stride,
                           Operand<float> b, std::size_t rows, std::size_t columns,
                           std::size_t depth) {
  static const TileProduct<float> product = widest_product<float>();
  product(c, c_stride, x, x_stride, b, rows, columns, depth);
}

void subtract_tile_product(double* c, std::size_t c_stride, const double* x, std::size_t x_stride,
                           Operand<double> b, std::size_t rows, std::size_t columns,
                           std::size_t depth) {
  static const TileProduct<double> product = widest_product<double>();
  product(c, c_stride, x, x_stride, b, rows, columns, depth);
}

}  // namespace animeme::dam

// Square matrices of zeros that are too large to be filled for nothing.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace animeme::dam {

/// n x n numbers, column by column, zero at first. Throws std::bad_alloc.
class SquareMatrix {
 public:
  SquareMatrix() = default;
  explicit SquareMatrix(std::size_t n) : n_(n), values_(zeros(n * n)) {}

  std::size_t rows() const { return n_; }
  double& operator[](std::size_t i) { return values_.get()[i]; }
  double operator[](std::size_t i) const { return values_.get()[i]; }
  double* data() { return values_.get(); }
  const double* data() const { return values_.get(); }
  std::span<double> values() { return {values_.get(), n_ * n_}; }
  /// The numbers of a column from the diagonal down.
  std::span<double> below(std::size_t column) {
    return {values_.get() + column * n_ + column, n_ - column};
  }
  std::span<const double> below(std::size_t column) const {
    return {values_.get() + column * n_ + column, n_ - column};
  }

 private:
  struct Free {
    void operator()(double* values) const;
  };
  static double* zeros(std::size_t count);

  std::size_t n_ = 0;
  std::unique_ptr<double, Free> values_;
};

}  // namespace animeme::dam

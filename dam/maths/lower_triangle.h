// Symmetric matrices that are too large to be filled for nothing: half of the numbers.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace animeme::dam {

/// The lower triangle of a symmetric n x n matrix, column by column from the diagonal down, zero at
/// first. Throws std::bad_alloc.
class LowerTriangle {
 public:
  LowerTriangle() = default;
  explicit LowerTriangle(std::size_t n) : n_(n), values_(zeros(size())) {}

  std::size_t rows() const { return n_; }
  /// The numbers of a column from the diagonal down.
  std::span<double> below(std::size_t column) {
    return {values_.get() + start(column), n_ - column};
  }
  std::span<const double> below(std::size_t column) const {
    return {values_.get() + start(column), n_ - column};
  }
  /// A number on or below the diagonal.
  double& at(std::size_t row, std::size_t column) {
    return values_.get()[start(column) + row - column];
  }
  double at(std::size_t row, std::size_t column) const {
    return values_.get()[start(column) + row - column];
  }
  /// All of them.
  std::span<double> values() { return {values_.get(), size()}; }
  std::span<const double> values() const { return {values_.get(), size()}; }

 private:
  struct Free {
    void operator()(double* values) const;
  };
  static double* zeros(std::size_t count);
  std::size_t size() const { return n_ * (n_ + 1) / 2; }
  std::size_t start(std::size_t column) const {
    return column * n_ - column * (column + 1) / 2 + column;
  }

  std::size_t n_ = 0;
  std::unique_ptr<double, Free> values_;
};

}  // namespace animeme::dam

#include <algorithm>
#include <cmath>

#include "dam/crossmap/smooth_internal.h"

namespace animeme::dam {

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

}  // namespace animeme::dam

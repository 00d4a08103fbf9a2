// The choice of levels for one parameter: fewest bits and smallest error together. Not installed
// API.
//
// A row of levels k(t) reconstructs to k(t) * step. Among the rows that stay near the values, the
// one with the smallest  error + lambda * bits  is found by a search through time (Viterbi) over
// the few levels next to each value. The bits of a difference are those of the adaptive model at
// the end of the row, which is what one more or one less of it really costs (see
// code_length_internal.h); as they depend on the row itself, search and counting alternate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/encode/code_length_internal.h"

namespace animeme::fba::internal {

/// Rows that share their levels: one, or the two sides of a pair.
struct TrellisProblem {
  std::span<const std::int32_t> a;
  std::span<const std::int32_t> b;  // empty: only one row
  std::int32_t step = 1;
  int scale = 1;                           // divisor of the ranges
  double unit = 1;                         // error that counts as 1
  std::span<const std::size_t> run_begin;  // planes that are intra; the first is 0
};

struct TrellisResult {
  std::vector<std::int32_t> levels;
  Bits bits = 0;
  double error = 0;  // sum of squares, in units
  bool fits = true;  // all ranges can be coded
};

/// Levels of the plain quantiser (of the mean of both rows).
TrellisResult plain_row(const TrellisProblem& problem);
/// Levels for lambda (squared units per bit), starting at `start`. Never worse than it. `warm`:
/// levels that were found for a lambda near this one, from where the search takes fewer steps; or
/// empty.
TrellisResult search_row(const TrellisProblem& problem, double lambda, const TrellisResult& start,
                         std::span<const std::int32_t> warm = {});
/// The row that stays where it is nearest to all values.
TrellisResult still_row(const TrellisProblem& problem);
/// The better one of search_row() from plain_row() and still_row() for each run by itself: what is
/// between two intra planes does not depend on the rest.
TrellisResult search_runs(const TrellisProblem& problem, double lambda,
                          std::span<const std::int32_t> warm = {});

/// error + lambda * bits.
inline double cost_of(const TrellisResult& row, double lambda) {
  return row.error + lambda * double(row.bits) / double(kOneBit);
}

}  // namespace animeme::fba::internal

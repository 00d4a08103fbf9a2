// The search for the fewest bits at an error, or the smallest error at a number of bits. Not
// installed API.
#pragma once

#include <vector>

#include "codec/encode/decide_internal.h"
#include "codec/encode/trellis_internal.h"

namespace animeme::fba::internal {

/// Solves a clip for given quantisers and lambdas; keeps what does not depend on lambda.
class RateDistortion {
 public:
  RateDistortion(const ClipData& clip, const EncodeOptions& options);

  /// Fills the rows and quantisers that take fewest bits with an error of at most `max_rms`, of
  /// distances and of the rest. Returns the bits.
  double limit_error(double max_rms, Decision& decision) const;
  /// Fills the rows and quantisers with the smallest error within `bits`, or with the fewest bits
  /// if that cannot be reached.
  void limit_bits(double bits, Decision& decision) const;

 private:
  // One channel, or a pair of sides that may be merged.
  struct Unit {
    std::size_t left = 0;
    std::size_t right = SIZE_MAX;  // none
  };
  struct UnitResult {
    TrellisResult left;
    TrellisResult right;  // separate sides only
    bool merged = false;
  };
  struct Solution {
    std::vector<UnitResult> units;
    double bits = 0;
    double error = 0;
    bool fits = true;
  };

  TrellisProblem problem(std::size_t channel, int quant) const;
  UnitResult solve_unit(const Unit& unit, int quant, double lambda) const;
  Solution solve(const std::vector<Unit>& units, int quant, double lambda) const;
  Solution solve_error(const std::vector<Unit>& units, int quant, double max_error) const;
  int best_quant(const std::vector<Unit>& units, double lambda) const;
  double fill_lambda(double lambda, Decision& decision) const;
  double fill_lambda_at_best_quant(double lambda, Decision& decision) const;
  enum class Kind : std::uint8_t { distances, others, all };
  std::vector<Unit> units_of(bool body, Kind kind) const;
  double moving_values(const std::vector<Unit>& units) const;
  void store(const std::vector<Unit>& units, const Solution& solution, int quant,
             Decision& decision) const;
  double limit_error_of(bool body, double max_rms, Decision& decision) const;

  void tell_progress() const;

  const ClipData& clip_;
  const EncodeOptions& options_;
  mutable int solved_ = 0;  // solutions so far, for progress
  std::vector<std::size_t> run_begin_;
};

}  // namespace animeme::fba::internal

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
  /// if that cannot be reached. Begins at the hint, if there is one, and leaves one for another
  /// number of bits.
  void limit_bits(double bits, Decision& decision, SearchHint& hint) const;

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
    bool given_up = false;  // `bits` is what it would have come to
  };

  TrellisProblem problem(std::size_t channel, int quant) const;
  // A solution with the same quantiser and another lambda, from where the search begins.
  struct Start {
    const Solution* solution = nullptr;  // may be null
    double lambda = 0;
  };
  static Start warm_start(const Solution& solution, double lambda, double next);
  UnitResult solve_unit(const Unit& unit, int quant, double lambda, const Start& start,
                        const UnitResult* before) const;
  Solution solve(const std::vector<Unit>& units, int quant, double lambda,
                 const Start& start) const;
  // Gives up where that would take more than `most_bits`.
  Solution solve_error(const std::vector<Unit>& units, int quant, double max_error,
                       double most_bits, double& lambda) const;
  int best_quant(const std::vector<Unit>& units, double lambda, int quant,
                 const Solution& solution) const;
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

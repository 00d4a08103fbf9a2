// Weights of the shapes that made a face. Internal.
#pragma once

#include <vector>

#include "fap/detail/bounded_fit.h"
#include "fap/detail/bounded_solver.h"

namespace animeme::fap::internal {

/// What moves apart from the mouth, and may move much more.
inline bool is_lid_or_brow(int fap) { return (fap >= 19 && fap <= 22) || (fap >= 31 && fap <= 38); }

/// Faces that these very shapes made, as those of a capture are, and whose FAPs were only rounded
/// or quantised since: the most likely weights. All FAPs count alike, as they are rounded alike,
/// and small weights are a little more likely than large ones. Frames are independent.
class ExactFit {
 public:
  /// `opposites`: pairs of which one alone is used, where that explains the face as well. `never`:
  /// pairs of which one alone is used in any case.
  ExactFit(const std::vector<std::vector<ShapeWeight>>& shapes, std::vector<Opponents> opposites,
           std::vector<Opponents> never);

  /// By shape; valid until the next call.
  const std::vector<double>& fit(const Mask& mask, const FapValues& target);

  /// How surely the shapes made the last face, 0 to 1: 1 if no FAP is off by more than two units,
  /// or all together by less than 3 %; 0 from 6 % on.
  double certainty() const { return certainty_; }

 private:
  /// What the weights leave of a face.
  struct Left {
    double worst = 0;    // of all FAPs, units
    double squares = 0;  // their sum
    double below = 0;    // likewise without lids and brows
  };

  void set_mask(const Mask& mask);
  void solve(double rest);
  Left left_of(const FapValues& target) const;
  Left use_one_of_lids(const FapValues& target, double rest, Left left);
  Left use_one_of_opposites(const FapValues& target, double rest, Left left);

  std::vector<FapValues> columns_;
  std::vector<Opponents> opposites_, never_;
  Mask mask_;
  bool has_gram_ = false;
  std::vector<double> gram_;    // shapes x shapes, for mask_
  std::vector<double> matrix_;  // gram_ with the cost of weights
  std::vector<double> wanted_, highs_, weights_, kept_;
  BoundedSolver solver_;
  double certainty_ = 0;
};

}  // namespace animeme::fap::internal

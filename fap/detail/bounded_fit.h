// Weights of shapes whose FAPs come nearest to a face: least squares with bounds. Internal.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "fap/detail/bounded_solver.h"
#include "fap/detail/lips.h"
#include "fap/frame.h"

namespace animeme::fap::internal {

/// What a shape at weight 1 does to one FAP, in FAP units.
struct ShapeWeight {
  int fap;
  std::int32_t value;
};

/// By pair of kLips.
using LipValues = std::array<double, kLipPairs>;

/// What the distance of the lips counts.
struct Lips {
  double weight = 0;               ///< how much more than a FAP
  LipValues at_rest = {};          ///< distances of the neutral face, FAP units of MNS
  std::vector<LipValues> closing;  ///< by how much each shape really makes them less; may be empty
  /// False: only where they would stay further apart than their FAPs say. True: always, and lips
  /// that nearly meet are to meet.
  bool always = true;
};

/// Two shapes that undo each other, by index.
using Opponents = std::pair<std::size_t, std::size_t>;

/// How few shapes are used.
struct Sparsity {
  /// By shape: it is used where it brings the face nearer by more than this, a length in the units
  /// of the fit (about 1.07 cm), all FAPs together, but at most a quarter of what it does at weight
  /// 1, or that share of it if that is more. 0, or empty for all: wherever it brings the face
  /// nearer at all.
  std::vector<double> least;
  /// Of these the one that does more is used alone.
  std::vector<Opponents> opponents;
  /// Of opponents[i] the first one keeps what it has beside the second one, where that is left out.
  std::vector<bool> keeps;
};

/// Low-level FAPs by number.
using FapValues = std::array<double, kFapCount + 1>;

/// The values of a frame, 0 for FAPs that it does not have.
FapValues target_of(const Frame& frame);

/// Frame by frame: weights from 0 to 1 that make the sum of squares smallest, over the FAPs of a
/// mask, in lengths on a face of usual proportions (lids count three times, so that closed eyes are
/// closed, the width of the mouth one and a half times). The same input gives the same weights
/// everywhere.
class BoundedFit {
 public:
  /// `ridge`: what it costs to use a shape, as a share of what it does to the face. `steadiness`:
  /// what it costs to change a weight, likewise. Both are clamped to 0..1. `most` > 0: what all
  /// weights together may be; the nearest face within that limit is found then. `radian`: length
  /// that stands for one, in units of ICT-FaceKit's head; at 0 FAPs that are angles do not count.
  /// `lips`: a shut mouth should be shut. What their FAPs say of it always counts; what was
  /// measured does where the lips would stay apart that should meet.
  BoundedFit(std::vector<std::vector<ShapeWeight>> shapes, double ridge, double steadiness,
             double most = std::numeric_limits<double>::infinity(), double radian = 0,
             Lips lips = {});

  /// By shape; good until the next call. Shapes without any FAP of `mask` keep their weight.
  const std::vector<double>& fit(const Mask& mask, const FapValues& target);

  /// From the next frame on.
  void set_sparsity(Sparsity sparsity) { sparsity_ = std::move(sparsity); }

  /// Forgets the frame before.
  void restart();

 private:
  void set_mask(const Mask& wanted);
  FapValues weighed(const FapValues& values) const;
  void project(const FapValues& target, std::vector<double>& sums) const;
  void descend(const std::vector<double>& wanted, double steadiness, double toll);
  void descend(double steadiness);
  double residual(const FapValues& target) const;
  double choose_few(const std::vector<double>& wanted, double steadiness, double residual);
  void part_keepers(std::vector<double>& wanted, double steadiness, double free);
  void close_lips(const std::vector<double>& wanted, const FapValues& target, double steadiness);
  void keep_within_limit(const std::vector<double>& wanted, double steadiness);

  std::vector<std::vector<ShapeWeight>> shapes_;
  double ridge_;
  double steadiness_;
  double most_;
  Lips lips_;  // in lengths
  Sparsity sparsity_;
  FapValues lengths_;               // of one unit of each FAP
  std::vector<FapValues> columns_;  // what each shape does, weighed, for mask_
  std::vector<double> gram_;        // shapes x shapes, for mask_
  std::vector<double> fap_gram_;    // of close_lips(): what gram_ is without measured lips
  std::vector<double> costs_;       // of shapes: what they do, lips not counted
  std::vector<double> left_;        // what descend() is to explain
  std::vector<double> matrix_;      // gram_ with what weights cost
  std::vector<double> highs_;       // what the weights may be
  std::vector<double> wanted_;      // of fit(), here so that no frame needs memory
  std::vector<double> scratch_;     // of choose_few() and close_lips(), likewise

  BoundedSolver solver_;

  Mask mask_;
  bool has_gram_ = false;
  std::vector<double> weights_;  // of the frame before
  bool is_first_ = true;
};

}  // namespace animeme::fap::internal

// A face as weights of a set of shapes: what ArkitFitter and ShapeFitter share. Internal.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fap/detail/bounded_fit.h"
#include "fap/detail/exact_fit.h"
#include "fap/frame.h"

namespace animeme::fap::internal {

/// How shapes are fitted; see ArkitFitOptions and ShapeFitter.
struct FaceFitOptions {
  double ridge = 0.001;
  double steadiness = 0;
  double sparsity = 1;
};

/// In this order:
///
/// 1. Shapes that turn the eyeballs, by FAP 23 to 26 alone. What they do to the lids is taken off.
/// 2. All others together, if they made this face: ExactFit.
/// 3. Otherwise shapes of lids and brows by their FAPs alone, so that no mouth helps to blink, and
///    no blink makes room for a wide eye; the rest by BoundedFit, few of them. Between both for
///    faces that are nearly made of them.
///    Without sparsity BoundedFit has all of them.
/// 4. Lids that meet: the blink is (nearly) whole, since where lids stop at each other FAPs do not
///    say how far it would go on. No lid is opened and closed at once.
class FaceFit {
 public:
  /// `channels`: of ARKit, kWholeFace for moods, nullopt for others; may be empty.
  FaceFit(std::vector<std::vector<ShapeWeight>> shapes,
          std::span<const std::optional<int>> channels, const FaceFitOptions& options, Lips lips);

  /// By shape; valid until the next call. `target`: values of the frame, less what other shapes do.
  /// `looks_down`: weight of shapes fitted elsewhere that lower the left and the right gaze.
  const std::vector<double>& fit(const Frame& frame, FapValues target,
                                 std::array<double, 2> looks_down = {});

  /// Forgets the frame before.
  void restart() { few_.restart(); }

 private:
  /// Some of the shapes, by index.
  using Group = std::vector<std::size_t>;

  void turn_eyes(const Mask& mask, FapValues& target, std::array<double, 2>& looks_down);
  void fit_few(const Mask& mask, const FapValues& target);
  void part_opponents(double certainty);
  void close_lids(const Mask& mask, const FapValues& target,
                  const std::array<double, 2>& looks_down);
  void part_lids();
  void take_off(std::size_t shape, double weight, FapValues& target) const;

  std::vector<std::vector<ShapeWeight>> shapes_;
  Group gaze_, lids_, others_, made_;  // made_: all but gaze_ and moods
  Group few_of_;  // others_, with lids_ if there are moods, which lids and brows tell from speech
  struct OppositeLids {
    std::size_t closes, opens;
    double ratio;  // of the latter's effect to the former's
  };
  std::vector<OppositeLids> opposite_lids_;
  std::array<Group, 2> blinks_;    // that close the left and the right eye
  Mask moved_;                     // what made_ moves
  ExactFit eyes_, upper_, whole_;  // of gaze_, lids_ and made_
  BoundedFit few_;                 // of few_of_
  std::vector<Opponents> opponents_;
  bool sparse_ = false;
  std::vector<double> weights_, made_weights_;
};

}  // namespace animeme::fap::internal

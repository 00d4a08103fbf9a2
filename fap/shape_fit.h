// A face as weights of shapes, whatever shapes a head has: ARKit's, visemes, an artist's own.
//
//     animeme::fap::ShapeFitter fitter({jaw_open, smile_left, blink_left});  // their FAPs
//     std::vector<double> weights = fitter.fit(frame);
//
// fap::ArkitFitter and fap::VisemeFitter do the same for complete, well-known sets.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "fap/frame.h"

namespace animeme::fap {

/// Movable, not copyable.
class ShapeFitter {
 public:
  /// The low-level FAPs of each shape at weight 1; FAPs outside the mask are 0. `ridge`: what it
  /// costs to use a shape, as a share of what it does to the face, 0..1; it keeps shapes from
  /// working against each other.
  explicit ShapeFitter(std::span<const Frame> shapes, double ridge = 0.001);
  ShapeFitter(ShapeFitter&&) noexcept;
  ShapeFitter& operator=(ShapeFitter&&) noexcept;
  ~ShapeFitter();

  /// Weights from 0 to 1 whose FAPs come nearest to those of `frame`: least squares over the FAPs
  /// of its mask, in lengths on a face of usual proportions; lids count three times, so
  /// does the distance of the lips; angles are lengths on the eyeball. Frames do not depend on each
  /// other. Good until the next call.
  const std::vector<double>& fit(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap

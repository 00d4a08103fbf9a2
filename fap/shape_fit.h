/// @file
/// A face as weights of any set of shapes: ARKit's, visemes, an artist's own.
///
///     animeme::fap::ShapeFitter fitter({jaw_open, smile_left, blink_left});  // their FAPs
///     std::vector<double> weights = fitter.fit(frame);
///
/// fap::ArkitFitter and fap::VisemeFitter do the same for these two complete sets.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fap/frame.h"

namespace animeme::fap {

/// Distances between the lips in the middle (2.2 to 2.3), on the left (2.6 to 2.8) and on the right
/// (2.7 to 2.9), in units of FAP 4 (MNS/1024).
using LipDistances = std::array<float, 3>;

/// In place of an ARKit channel: the shape is a whole face, such as joy.
inline constexpr int kWholeFace = -1;

/// Lip distances measured on a head.
struct LipMeasures {
  LipDistances at_rest = {};          ///< of the neutral face, if its lips do not quite meet
  std::vector<LipDistances> closing;  ///< by which each shape reduces them at weight 1
};

/// Movable, not copyable.
class ShapeFitter {
 public:
  /// `shapes`: the low-level FAPs of each shape at weight 1; FAPs outside the mask are 0. `lips`:
  /// with distances for all shapes, or for none (shapes behind the last distance count as 0); FAPs
  /// approximate lip distances only roughly, which shows in a mouth that should be closed (open
  /// lips are left to the FAPs). `ridge`: penalty on the use of a shape, relative to its effect on
  /// the face, 0..1; it keeps shapes from cancelling each other. `arkit`: the channel
  /// (find_arkit()) of each ARKit shape, kWholeFace for moods, nullopt for others; if given, few
  /// shapes are used, and none against each other (see ArkitFitOptions::sparsity).
  explicit ShapeFitter(std::span<const Frame> shapes, const LipMeasures& lips = {},
                       double ridge = 0.001, std::span<const std::optional<int>> arkit = {});
  ShapeFitter(ShapeFitter&&) noexcept;  ///< movable
  ShapeFitter& operator=(ShapeFitter&&) noexcept;
  ~ShapeFitter();

  /// Weights from 0 to 1 whose FAPs best approximate those of `frame`. Shapes that turn the
  /// eyeballs by FAP 23 to 26 alone. With `arkit`, a face that the shapes made gets their weights
  /// back, and of other faces lids and brows are fitted apart from the mouth. The rest: least
  /// squares over the FAPs of its mask, in lengths on a face of usual proportions; the distance of
  /// the lips counts three times, the width of the mouth one and a half times. A blink is whole
  /// where lids meet. Frames are independent. Valid until the next call.
  const std::vector<double>& fit(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap

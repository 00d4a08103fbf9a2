/// @file
/// A face as weights of shapes, whatever shapes a head has: ARKit's, visemes, an artist's own.
///
///     animeme::fap::ShapeFitter fitter({jaw_open, smile_left, blink_left});  // their FAPs
///     std::vector<double> weights = fitter.fit(frame);
///
/// fap::ArkitFitter and fap::VisemeFitter do the same for complete, well-known sets.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fap/frame.h"

namespace animeme::fap {

/// Distances between the lips at their middle (2.2 to 2.3), left (2.6 to 2.8) and right of it (2.7
/// to 2.9), in units of FAP 4 (MNS/1024).
using LipDistances = std::array<float, 3>;

/// Stands for a channel of ARKit's: the shape is a whole face, such as joy.
inline constexpr int kWholeFace = -1;

/// How a face closes its lips, as measured on it.
struct LipMeasures {
  LipDistances at_rest = {};          ///< of lips that do not quite meet in the neutral face
  std::vector<LipDistances> closing;  ///< by how much less each shape makes them at weight 1
};

/// Movable, not copyable.
class ShapeFitter {
 public:
  /// The low-level FAPs of each shape at weight 1; FAPs outside the mask are 0. `lips`: with
  /// distances for all shapes, or for none. What FAPs say of them is rough, and a mouth that should
  /// be shut shows it; lips that should be apart are left to the FAPs. `ridge`: what it costs to
  /// use a shape, as a share of what it does to the face, 0..1; it keeps shapes from working
  /// against each other.
  /// `arkit`: the channel (find_arkit()) of each shape that is one of ARKit's, kWholeFace for
  /// moods, nothing for others. If given, few shapes are used, none against each other, as
  /// ArkitFitOptions::thrift says.
  explicit ShapeFitter(std::span<const Frame> shapes, const LipMeasures& lips = {},
                       double ridge = 0.001, std::span<const std::optional<int>> arkit = {});
  ShapeFitter(ShapeFitter&&) noexcept;  ///< movable
  ShapeFitter& operator=(ShapeFitter&&) noexcept;
  ~ShapeFitter();

  /// Weights from 0 to 1 whose FAPs come nearest to those of `frame`: least squares over the FAPs
  /// of its mask, in lengths on a face of usual proportions; lids count three times, so
  /// does the distance of the lips, the width of the mouth one and a half times; angles are lengths
  /// on the eyeball. Frames do not depend on each other. Good until the next call.
  const std::vector<double>& fit(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap

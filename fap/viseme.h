/// @file
/// Weights of the 15 visemes of Oculus lip-sync and Ready Player Me avatars.
///
///     animeme::fap::VisemeFitter fitter;
///     for (const Frame& frame : filled.frames) rows.push_back(fitter.fit(frame));
///
/// The 15 shapes of that set are the visemes of FAP 1, one for one (fap/semantics.md, section 4):
/// the order is that of kVisemes in tables.h, whose `morph` is the name of the morph target.
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "fap/frame.h"

namespace animeme::fap {

inline constexpr int kVisemeCount = 15;  ///< shapes of FAP 1, silence included

/// One instant, by viseme number: each 0 to 1, with the sum 1. Number 0 is silence: the rest.
using VisemeWeights = std::array<double, kVisemeCount>;

/// The weights of FAP 1: blend/63 for select1, the rest for select2. Numbers beyond 14 count
/// as silence, blend is clipped to 0..63.
VisemeWeights coded_viseme(const Viseme& viseme);

/// A viseme at weight 1 as FAPs of the jaw and the lips (3 to 6 and 8, 10, 12, 51 to 53, 55, 57, 59
/// with their right partners), numbers 0..14; any other gives silence: all 0.
///
/// Measured: the pose of each phone for which linear interpolation between the poses best
/// approximates the recorded motion (least squares), relative to the pose of silence, as found by
/// the method `viseme` of dam in the 693 training sentences of the corpus grid_s1; mean over the
/// phones of the viseme by their number, without diphthongs and HH; mean of both sides. So weight 1
/// is the motion of a calm speaker. FAP 14, 16 and 17 are omitted, which are estimates in that
/// corpus, and 15 and 18.
const Frame& viseme_shape(int viseme);

/// Weights of the terms of VisemeFitter's objective.
struct VisemeFitOptions {
  double ridge = 0.03;       ///< see ArkitFitOptions; visemes are more similar than face shapes
  double steadiness = 0.03;  ///< likewise
};

/// Faces to visemes, frame by frame. Movable, not copyable.
class VisemeFitter {
 public:
  explicit VisemeFitter(const VisemeFitOptions& options = {});  ///< options are not checked
  VisemeFitter(VisemeFitter&&) noexcept;                        ///< movable
  VisemeFitter& operator=(VisemeFitter&&) noexcept;
  ~VisemeFitter();

  /// FAP 1 if the frame has it. Else the weights, with a sum of at most 1, whose shapes best
  /// approximate its jaw and lips (least squares in lengths on the face); silence is the rest.
  /// Several visemes look nearly alike (t, k, s, n): the weights are then shared. Motion beyond
  /// that of viseme_shape() saturates at the most extreme visemes. Without any of these FAPs:
  /// silence. The same frames give the same weights everywhere.
  VisemeWeights fit(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap

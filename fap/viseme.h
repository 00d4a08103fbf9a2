/// @file
/// Weights of the 15 visemes, as Oculus lip-sync and Ready Player Me avatars have them.
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

/// One instant, by viseme number: 0 to 1 each, and 1 together. Number 0 is silence: what the others
/// leave.
using VisemeWeights = std::array<double, kVisemeCount>;

/// The weights that FAP 1 says: blend/63 of select1, the rest of select2. Numbers beyond 14 count
/// as silence, blend is clipped to 0..63.
VisemeWeights coded_viseme(const Viseme& viseme);

/// A viseme at weight 1 as FAPs of the jaw and the lips (3 to 6 and 8, 10, 12, 51 to 53, 55, 57, 59
/// with their right partners), numbers 0..14; any other gives silence: all 0.
///
/// Measured: the pose of each phone for which straight lines between the poses come nearest to the
/// recorded motion (least squares), from the pose of silence, as the method `viseme` of dam finds
/// them in the 693 training sentences of the corpus grid_s1; mean over the phones of the viseme by
/// their number, diphthongs and HH left out; mean of both sides. So weight 1 is how far a calm
/// speaker goes. FAP 14, 16 and 17 are left out, which are guesses in that corpus, and 15 and 18.
const Frame& viseme_shape(int viseme);

/// How VisemeFitter weighs.
struct VisemeFitOptions {
  double ridge = 0.03;       ///< see ArkitFitOptions; visemes are more alike than shapes of a face
  double steadiness = 0.03;  ///< likewise
};

/// Faces to visemes, frame by frame. Movable, not copyable.
class VisemeFitter {
 public:
  explicit VisemeFitter(const VisemeFitOptions& options = {});  ///< options as they are, unchecked
  VisemeFitter(VisemeFitter&&) noexcept;                        ///< movable
  VisemeFitter& operator=(VisemeFitter&&) noexcept;
  ~VisemeFitter();

  /// FAP 1 if the frame has it. Else the weights, 1 together at most, whose shapes come nearest to
  /// its jaw and lips (least squares in lengths on the face); silence is the rest. Several visemes
  /// look nearly alike (t, k, s, n): the weights then share what is seen. Larger motion than that
  /// of viseme_shape() ends at the visemes that go farthest that way. Without any of these FAPs:
  /// silence. The same frames give the same weights everywhere.
  VisemeWeights fit(const Frame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fap

// Sentence pairs as series: the controls of the scale and the measures of the mouth, both sides,
// and what is spoken in each frame. All analyses of evaluate() start from this.
#pragma once

#include <cstddef>
#include <vector>

#include "dam/evaluation/evaluate.h"

namespace animeme::dam {

/// A measure that is a weighted sum of controls.
struct Measure {
  const char* name;
  std::vector<std::pair<std::size_t, double>> parts;  ///< control, weight
};

/// Which series there are: the controls, then the measures. -1: not there.
struct Layout {
  std::vector<Control> controls;
  std::vector<bool> scored;  ///< per control
  std::vector<Measure> measures;
  std::ptrdiff_t gap = -1, width = -1;  ///< series of that measure
  std::ptrdiff_t lower_lip = -1;        ///< series of FAP 5

  std::size_t series() const { return controls.size() + measures.size(); }
  std::size_t scored_count() const;
  bool is_scored(std::size_t series) const { return series < scored.size() && scored[series]; }
  std::string name(std::size_t series) const;
};
Layout make_layout(std::vector<Control> controls);

struct PairSeries {
  const SentencePair* pair = nullptr;
  std::vector<std::vector<double>> recorded, synthesised;  ///< [series][frame]
  std::vector<bool> speech, silence;                       ///< measured frames of either kind
  std::vector<std::ptrdiff_t> phone;  ///< index in the script, -1: before or after it, or a gap

  const Script& script() const { return pair->recorded.script; }
  const Signal& signal() const { return pair->recorded.signal; }
  std::size_t frames() const { return speech.size(); }
  double seconds(double frames) const { return signal().rate.seconds(frames); }
};
/// Errors: those of score() about one pair.
Result<PairSeries> make_series(const SentencePair& pair, const Layout& layout);

/// [begin, end) of frames for which `mask` is set without a gap.
struct FrameRun {
  std::size_t begin = 0, end = 0;
};
std::vector<FrameRun> frame_runs(const std::vector<bool>& mask);

/// The analyses. Each adds its part to the result.
using AllSeries = std::vector<PairSeries>;
void score_regions(const Layout& layout, const AllSeries& all, Evaluation& result);
void score_closures(const Layout& layout, const AllSeries& all, const ScoreOptions& options,
                    Evaluation& result);
void score_lips(const Layout& layout, const AllSeries& all, const ScoreOptions& options,
                Evaluation& result);
void score_timing(const Layout& layout, const AllSeries& all, Evaluation& result);
void score_misalignment(const Layout& layout, const AllSeries& all, Evaluation& result);
void score_dynamics(const Layout& layout, const AllSeries& all, Evaluation& result);
void score_breakdown(const Layout& layout, const AllSeries& all, const SeenContexts& seen,
                     Evaluation& result);

/// The sums of one frame.
void add_frame(const Layout& layout, const PairSeries& pair, std::size_t frame, ErrorSums& sums);

}  // namespace animeme::dam

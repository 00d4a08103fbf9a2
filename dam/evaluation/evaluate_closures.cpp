// Closures of P, B and M, and false closures.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/evaluation/evaluate_sums_internal.h"
#include "dam/signal/closure.h"

namespace animeme::dam {
namespace {

constexpr double kFalseMargin = 0.060;     // seconds
constexpr double kEdgeReach = 0.200;       // seconds from the least gap to the edge of the closure
constexpr double kLengthTolerance = 1e-9;  // seconds: 0.1 less 0.04 is 60 ms
constexpr double kLengths[] = {0, 0.060, 0.100, std::numeric_limits<double>::infinity()};

struct Gap {
  const std::vector<double>& values;
  double threshold;

  bool closed(std::size_t i) const { return values[i] < threshold; }
};

/// When the gap passes the threshold going from `from` by `step` frames; in frames.
std::optional<double> edge(const Gap& gap, std::size_t from, std::ptrdiff_t step, double reach) {
  const auto last = std::ptrdiff_t(gap.values.size()) - 1;
  for (std::ptrdiff_t i = std::ptrdiff_t(from); i + step >= 0 && i + step <= last; i += step) {
    const double a = gap.values[std::size_t(i)], b = gap.values[std::size_t(i + step)];
    if (b < gap.threshold) continue;
    const double at = double(i) + double(step) * (gap.threshold - a) / (b - a);
    return std::abs(at - double(from)) <= reach ? std::optional(at) : std::nullopt;
  }
  return std::nullopt;
}

struct ClosureSums {
  ClosureScore counts;
  std::vector<double> onset, release;  // ms, made - recorded
};

/// The frame of the least gap if that is closed.
std::optional<std::size_t> closed_at(const Gap& gap, const FrameSpan& span) {
  if (span.first >= span.last) return std::nullopt;
  const auto begin = gap.values.begin();
  const auto least =
      std::min_element(begin + std::ptrdiff_t(span.first), begin + std::ptrdiff_t(span.last));
  const auto at = std::size_t(least - begin);
  return gap.closed(at) ? std::optional(at) : std::nullopt;
}

/// For how many frames the gap is below the threshold around `at`; 0: not closed.
double shut_frames(const Gap& gap, std::optional<std::size_t> at, double reach) {
  if (!at) return 0;
  double frames = 0;
  for (const std::ptrdiff_t step : {-1, 1}) {
    const auto passed = edge(gap, *at, step, reach);
    const double end = double(step < 0 ? *at : gap.values.size() - 1 - *at);
    frames += passed ? std::abs(*passed - double(*at)) : std::min(reach, end);
  }
  return frames;
}

void add_phone(const PairSeries& pair, const Phone& phone, const Gap& made, const Gap& recorded,
               bool behind_silence, ClosureSums& sums) {
  const FrameSpan span = frames_near(pair.signal(), phone, kClosureSearch);
  const auto by_made = closed_at(made, span), by_recorded = closed_at(recorded, span);
  ++sums.counts.phones;
  sums.counts.predicted += by_made ? 1 : 0;
  sums.counts.measured += by_recorded ? 1 : 0;
  const double rate = pair.signal().rate.frames_per_second();
  if (!behind_silence) {
    const auto length = std::find_if(sums.counts.durations.begin(), sums.counts.durations.end(),
                                     [&](const ClosureDurationScore& one) {
                                       return phone.duration() < one.to - kLengthTolerance;
                                     });
    ClosureDurationScore& shut =
        length == sums.counts.durations.end() ? sums.counts.durations.back() : *length;
    const double reach = kEdgeReach * rate;
    ++shut.phones;
    shut.measured += pair.seconds(shut_frames(recorded, by_recorded, reach)) * 1000;
    shut.predicted += pair.seconds(shut_frames(made, by_made, reach)) * 1000;
  }
  if (!by_made || !by_recorded) return;
  for (const std::ptrdiff_t step : {-1, 1}) {
    const auto a = edge(made, *by_made, step, kEdgeReach * rate);
    const auto b = edge(recorded, *by_recorded, step, kEdgeReach * rate);
    if (a && b) (step < 0 ? sums.onset : sums.release).push_back(pair.seconds(*a - *b) * 1000);
  }
}

/// Speech away from P, B, M and silence: where lips are expected to be open.
std::vector<bool> frames_elsewhere(const PairSeries& pair) {
  std::vector<bool> elsewhere(pair.frames(), false);
  const auto mark = [&](const Phone& phone, double margin, bool value) {
    const FrameSpan span = frames_near(pair.signal(), phone, margin);
    for (std::size_t i = span.first; i < span.last; ++i) elsewhere[i] = value;
  };
  for (const Phone& phone : pair.script().phones)
    if (phone.label != kSilence) mark(phone, 0, true);
  for (const Phone& phone : pair.script().phones)
    if (phone.label == kSilence || is_bilabial(phone.label)) mark(phone, kFalseMargin, false);
  return elsewhere;
}

/// Runs of frames that `a` has closed; those in which `b` never is are counted apart.
struct StrayCount {
  std::size_t all = 0, alone = 0;
};
StrayCount count_stray(const std::vector<bool>& elsewhere, const Gap& a, const Gap& b) {
  std::vector<bool> closed(elsewhere);
  for (std::size_t i = 0; i < closed.size(); ++i) closed[i] = closed[i] && a.closed(i);
  StrayCount count;
  for (const FrameRun& run : frame_runs(closed)) {
    bool both = false;
    for (std::size_t i = run.begin; i < run.end; ++i) both = both || b.closed(i);
    ++count.all;
    count.alone += both ? 0 : 1;
  }
  return count;
}

bool is_behind_silence(const std::vector<Phone>& phones, std::size_t at) {
  return at == 0 || phones[at - 1].label == kSilence ||
         phones[at].start - phones[at - 1].end > kTimeTolerance;
}

TimeSpread spread(const std::vector<double>& times) {
  Comparison sums;
  for (const double t : times) sums.add(t, 0);
  return {times.size(), sums.mean_difference(), sums.deviation_a()};
}

}  // namespace

void score_closures(const Layout& layout, const AllSeries& all, const ScoreOptions& options,
                    Evaluation& result) {
  if (layout.gap < 0) return;
  const auto gap = std::size_t(layout.gap);
  ClosureSums sums;
  ClosureScore& counts = sums.counts;
  for (std::size_t i = 0; i + 1 < std::size(kLengths); ++i)
    counts.durations.push_back({kLengths[i], kLengths[i + 1], 0, 0, 0});
  for (const PairSeries& pair : all) {
    const Gap made{pair.synthesised[gap], options.closed_gap};
    const Gap recorded{pair.recorded[gap], options.closed_gap};
    const auto& phones = pair.script().phones;
    for (std::size_t i = 0; i < phones.size(); ++i)
      if (is_bilabial(phones[i].label))
        add_phone(pair, phones[i], made, recorded, is_behind_silence(phones, i), sums);
    const auto elsewhere = frames_elsewhere(pair);
    const StrayCount predicted = count_stray(elsewhere, made, recorded);
    counts.false_closures += predicted.alone;
    counts.stray_predicted += predicted.all;
    counts.stray_measured += count_stray(elsewhere, recorded, made).all;
  }
  const double phones = std::max(1.0, double(counts.phones));
  counts.measured /= phones;
  counts.predicted /= phones;
  const double minutes = result.seconds / 60;
  counts.false_per_minute = double(counts.false_closures) / minutes;
  counts.stray_measured_per_minute = double(counts.stray_measured) / minutes;
  counts.stray_predicted_per_minute = double(counts.stray_predicted) / minutes;
  for (ClosureDurationScore& shut : counts.durations) {
    shut.measured /= std::max(1.0, double(shut.phones));
    shut.predicted /= std::max(1.0, double(shut.phones));
  }
  counts.onset = spread(sums.onset);
  counts.release = spread(sums.release);
  result.closure = counts;
}

}  // namespace animeme::dam

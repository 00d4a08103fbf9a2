// Mean curves, coarse to fine: each level has the mean residual of the coarser ones.
#include <algorithm>
#include <cmath>
#include <map>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/table/contexts.h"
#include "dam/kinds/table/table.h"
#include "dam/maths/parallel.h"
#include "dam/maths/spline.h"

namespace animeme::dam {
namespace {

struct Sample {
  std::array<CurveKey, kCurveLevels> keys;
  std::vector<double> left_over;  ///< points x controls
};

/// True if the recording has the middle of the phone.
bool is_seen(const SpeechData& data, const FitSentence& sentence, const FitOccurrence& o) {
  const double frame = std::round((o.start + o.duration / 2) * data.rate);
  return frame >= 0 && frame < double(sentence.frames) &&
         data.use[sentence.first_frame + std::size_t(frame)] != 0;
}

/// The recording over the phones of one sentence.
void add_samples(const SpeechData& data, const FitSentence& sentence, const Model& model,
                 const TableOptions& own, std::vector<Sample>& out) {
  const std::size_t controls = data.controls, points = std::size_t(own.points);
  const std::size_t before = out.size();
  for (std::size_t j = 0; j < sentence.occurrences; ++j) {
    const FitOccurrence& o = data.occurrences[sentence.first_occurrence + j];
    if (is_seen(data, sentence, o))
      out.push_back(
          {curve_keys(model, o.phone, o.left, o.right), std::vector<double>(points * controls)});
  }
  std::vector<double> track(sentence.frames);
  for (std::size_t c = 0; c < controls; ++c) {
    for (std::size_t i = 0; i < sentence.frames; ++i)
      track[i] = data.target[(sentence.first_frame + i) * controls + c];
    const Spline spline(track);
    std::size_t next = before;
    for (std::size_t j = 0; j < sentence.occurrences; ++j) {
      const FitOccurrence& o = data.occurrences[sentence.first_occurrence + j];
      if (!is_seen(data, sentence, o)) continue;
      for (std::size_t i = 0; i < points; ++i) {
        const double u = curve_time(i, points, own.reach);
        out[next].left_over[i * controls + c] = spline((o.start + u * o.duration) * data.rate);
      }
      ++next;
    }
  }
}

using Curves = std::map<CurveKey, std::pair<std::uint32_t, std::vector<double>>>;

/// Means of what is left over, shrunk, taken from the samples.
void add_level(std::vector<Sample>& samples, std::size_t level, const TableOptions& own,
               Curves& curves) {
  Curves sums;
  for (const Sample& sample : samples) {
    auto& [count, sum] = sums[sample.keys[level]];
    if (count++ == 0) sum.assign(sample.left_over.size(), 0.0);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += sample.left_over[i];
  }
  // The plain mean of a phone needs no support from a coarser level: the rest pose is no guess.
  const double trust = level == 0 ? 0.0 : own.trust;
  const std::uint32_t minimum = level == 0 ? 1 : std::uint32_t(own.minimum);
  for (auto& [key, entry] : sums) {
    if (entry.first < minimum) continue;
    for (double& v : entry.second) v /= double(entry.first) + trust;
    curves.insert({key, std::move(entry)});
  }
  for (Sample& sample : samples) {
    const auto at = curves.find(sample.keys[level]);
    if (at == curves.end()) continue;
    for (std::size_t i = 0; i < sample.left_over.size(); ++i)
      sample.left_over[i] -= at->second.second[i];
  }
}

}  // namespace

Result<Parameters> fit_triphones(const TrainingSet& set, const Model& model,
                                 const TrainOptions& options, TrainRun& run) {
  const TableOptions& own = options.table;
  const std::vector<FitSentence>& sentences = set.data.sentences;
  std::vector<std::vector<Sample>> parts(sentences.size());
  parallel_for(sentences.size(), options.threads,
               [&](std::size_t s) { add_samples(set.data, sentences[s], model, own, parts[s]); });
  std::vector<Sample> samples;
  for (auto& part : parts) std::move(part.begin(), part.end(), std::back_inserter(samples));
  Curves curves;
  for (std::size_t level = 0; level < kCurveLevels; ++level) {
    if (!run.report("fit", double(level) / kCurveLevels)) return TrainRun::cancelled();
    add_level(samples, level, own, curves);
  }
  double energy = 0;
  for (const Sample& sample : samples)
    for (const double v : sample.left_over) energy += v * v;
  run.summary.objective.push_back(energy);
  run.summary.converged = true;
  TriphoneParameters p;
  p.points = std::uint32_t(own.points);
  p.reach = own.reach;
  for (const auto& [key, entry] : curves)
    p.curves.push_back({key.phone,
                        key.level,
                        key.left,
                        key.right,
                        entry.first,
                        {entry.second.begin(), entry.second.end()}});
  return Parameters(std::move(p));
}

}  // namespace animeme::dam

#include <algorithm>
#include <cmath>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/trajectory/fit_control.h"
#include "dam/kinds/trajectory/trajectory.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

constexpr double kStartSmoothness = 0.06;  // seconds
constexpr double kTrustInPhone = 4;        // frames of the mean of all speech beside a state's own

/// The grid of all sentences and the frames that count.
TrajectoryData make_data(const SpeechData& speech, std::size_t phones, std::size_t states,
                         std::size_t order) {
  TrajectoryData data;
  data.order = order;
  data.frames.assign(phones * states, 0.0);
  for (const FitSentence& sentence : speech.sentences) {
    std::vector<Piece> pieces;
    for (std::size_t j = 0; j < sentence.occurrences; ++j) {
      const FitOccurrence& o = speech.occurrences[sentence.first_occurrence + j];
      pieces.push_back({o.start, o.duration, o.phone});
    }
    const double seconds = double(sentence.frames) / speech.rate;
    std::size_t begin = 0, frame = 0;
    for (const std::size_t end : run_ends(pieces)) {
      const std::size_t before = data.grid.runs.size();
      add_run(std::span(pieces).subspan(begin, end - begin), states, {-1, seconds + 1}, data.grid);
      begin = end;
      if (data.grid.runs.size() == before) continue;
      const Run& run = data.grid.runs.back();
      for (; frame < sentence.frames && double(frame) / speech.rate <= run.end; ++frame) {
        const double time = double(frame) / speech.rate;
        if (time < run.start || speech.use[sentence.first_frame + frame] == 0) continue;
        data.observed.push_back({read_at(run, time), sentence.first_frame + frame});
      }
    }
  }
  return data;
}

/// Frames and their states: the states around the nearest point.
template <class Use>
void for_states(const TrajectoryData& data, const Use& use) {
  for (std::size_t f = 0; f < data.observed.size(); ++f) {
    const Reading& r = data.observed[f].reading;
    for (std::size_t m = 1; m < 3; ++m)
      for (const Cover& cover : data.grid.at(r.point + m))
        use(f, cover.state, cover.share * std::abs(r.weight[m]));
  }
}

/// Mean and variance of each state in the recording, drawn towards those of all speech where
/// there are few frames.
Gaussians data_gaussians(const TrajectoryData& data, const std::vector<double>& target) {
  const std::size_t states = data.frames.size();
  Gaussians g{std::vector<double>(states, 0.0), std::vector<double>(states, 0.0),
              std::log(kStartSmoothness)};
  double mean = 0, square = 0;
  for (const double v : target) {
    mean += v;
    square += v * v;
  }
  mean /= std::max(1.0, double(target.size()));
  const double variance =
      std::max(0.05, square / std::max(1.0, double(target.size())) - mean * mean);
  std::vector<double> spread(states, kTrustInPhone * variance);
  for_states(data,
             [&](std::size_t f, std::uint32_t s, double share) { g.mean[s] += share * target[f]; });
  for (std::size_t s = 0; s < states; ++s)
    g.mean[s] = (g.mean[s] + kTrustInPhone * mean) / (data.frames[s] + kTrustInPhone);
  for_states(data, [&](std::size_t f, std::uint32_t s, double share) {
    spread[s] += share * (target[f] - g.mean[s]) * (target[f] - g.mean[s]);
  });
  for (std::size_t s = 0; s < states; ++s)
    g.log_precision[s] = -std::log(
        std::clamp(spread[s] / (data.frames[s] + kTrustInPhone), kLeastVariance, kLargestVariance));
  return g;
}

std::vector<ControlFit> start_fits(const TrajectoryData& data, const SpeechData& speech,
                                   const TrajectoryOptions& own) {
  const TrajectoryPrior prior{own.mean_prior, own.variance_prior, own.variance_prior};
  std::vector<ControlFit> fits;
  for (std::size_t c = 0; c < speech.controls; ++c) {
    std::vector<double> target;
    for (const Observed& o : data.observed)
      target.push_back(speech.target[o.frame * speech.controls + c]);
    Gaussians start = data_gaussians(data, target);
    fits.emplace_back(data, std::move(target), std::move(start), prior);
  }
  return fits;
}

double total(const std::vector<ControlFit>& fits) {
  double sum = 0;
  for (const ControlFit& fit : fits) sum += fit.objective();
  return sum;
}

/// Every control a step at a time. False: cancelled.
bool fit_all(std::vector<ControlFit>& fits, const TrainOptions& options, TrainRun& run) {
  TrainSummary& summary = run.summary;
  summary.objective.push_back(total(fits));
  for (int k = 0; k < options.max_iterations && !summary.converged; ++k) {
    const double before = summary.objective.back();
    if (!run.report("fit", double(k) / options.max_iterations, before)) return false;
    parallel_for(fits.size(), options.threads, [&](std::size_t c) { fits[c].step(); });
    const double now = total(fits);
    if (now < before) summary.objective.push_back(now);
    summary.converged = now >= before * (1 - options.trajectory.tolerance);
  }
  return true;
}

TrajectoryParameters store(const std::vector<ControlFit>& fits, const TrajectoryOptions& own) {
  const std::size_t controls = fits.size(), states = fits[0].gaussians().states();
  TrajectoryParameters p;
  p.states = std::uint32_t(own.states);
  p.order = std::uint32_t(own.order);
  p.mean.resize(states * controls);
  p.variance.resize(states * controls);
  for (std::size_t c = 0; c < controls; ++c) {
    const Gaussians& g = fits[c].gaussians();
    p.smoothness.push_back(
        std::clamp(std::exp(g.log_smoothness), kLeastSmoothness, kLargestSmoothness));
    for (std::size_t s = 0; s < states; ++s) {
      p.mean[s * controls + c] = g.mean[s];
      p.variance[s * controls + c] =
          std::clamp(std::exp(-g.log_precision[s]), kLeastVariance, kLargestVariance);
    }
  }
  return p;
}

}  // namespace

Result<Parameters> fit_trajectory(const TrainingSet& set, const Model& model,
                                  const TrainOptions& options, TrainRun& run) {
  const TrajectoryOptions& own = options.trajectory;
  TrajectoryData data =
      make_data(set.data, model.phones.size(), std::size_t(own.states), std::size_t(own.order));
  for_states(data, [&](std::size_t, std::uint32_t s, double share) { data.frames[s] += share; });
  std::vector<ControlFit> fits = start_fits(data, set.data, own);
  if (!fit_all(fits, options, run)) return TrainRun::cancelled();
  return Parameters(store(fits, own));
}

}  // namespace animeme::dam

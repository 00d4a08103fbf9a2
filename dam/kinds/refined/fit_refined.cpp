// Training of the refined model: dominance, then all curves. Source: dam/kinds/refined/README.md.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/refined/curves_fit.h"
#include "dam/kinds/refined/fit.h"
#include "dam/kinds/refined/refined.h"
#include "dam/kinds/refined/solve.h"
#include "dam/maths/linear_algebra.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kMostComponents = 16;
constexpr double kVariance = 0.99;

/// Directions (a row of `controls` numbers each) in which the controls move together, the strongest
/// first. The dominance is sought for these: all controls share it, so nothing but noise is lost.
std::vector<double> principal_components(const RefinedData& data) {
  const std::size_t k = data.controls;
  std::vector<double> covariance(k * k);
  for (std::size_t i = 0; i < data.speech->use.size(); ++i) {
    if (data.speech->use[i] == 0) continue;
    const double* y = &data.target[i * k];
    for (std::size_t a = 0; a < k; ++a)
      for (std::size_t b = a; b < k; ++b) covariance[a * k + b] += y[a] * y[b];
  }
  const Eigenvectors found = symmetric_eigenvectors(covariance, k);
  const double total = std::max(dot(found.values, std::vector<double>(k, 1.0)), 1e-300);
  std::size_t count = 0;
  double sum = 0;
  while (count < std::min(k, kMostComponents) && (count == 0 || sum < kVariance * total))
    sum += found.values[k - 1 - count++];
  std::vector<double> directions;
  for (std::size_t c = 0; c < count; ++c) {
    const auto first = found.vectors.begin() + std::ptrdiff_t((k - 1 - c) * k);
    directions.insert(directions.end(), first, first + std::ptrdiff_t(k));
  }
  return directions;
}

/// Rows of `k` numbers as multiples of the directions.
std::vector<double> rotated(const std::vector<double>& rows, std::size_t k,
                            const std::vector<double>& directions) {
  std::vector<double> result;
  result.reserve(rows.size() / k * (directions.size() / k));
  for (std::size_t i = 0; i < rows.size(); i += k)
    for (std::size_t d = 0; d < directions.size(); d += k)
      result.push_back(dot(&rows[i], &directions[d], k));
  return result;
}

/// How much a frame counts: 1 / (frames of its word) ^ exponent, 1 in the mean of the frames whose
/// word is known, and 1 for the others. A word that comes often says hardly more about other words
/// than a rare one.
std::vector<float> frame_weights(const SpeechData& speech, double exponent) {
  std::vector<float> weights(speech.use.begin(), speech.use.end());
  if (exponent == 0) return weights;
  const auto known = [&](std::size_t i) { return speech.use[i] != 0 && speech.word[i] != 0; };
  std::map<std::uint32_t, double> by_word;
  double frames = 0, sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (known(i)) by_word[speech.word[i]] += 1;
  for (auto& [word, weight] : by_word) {
    frames += weight;
    sum += std::pow(weight, 1 - exponent);
    weight = std::pow(weight, -exponent);
  }
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (known(i)) weights[i] = float(by_word[speech.word[i]] * frames / sum);
  return weights;
}

class RefinedTrainer {
 public:
  RefinedTrainer(const TrainingSet& set, const Model& model, const TrainOptions& options,
                 TrainRun& run)
      : options_(options),
        own_(options.refined),
        run_(run),
        controls_(model.controls),
        mean_(means_from_rest(model.controls)) {
    data_.speech = &set.data;
    data_.phones = model.phones;
    data_.controls = data_.prior_controls = set.data.controls;
    data_.target = set.data.target;
    for (std::size_t i = 0; i < data_.target.size(); ++i)
      data_.target[i] -= mean_[i % data_.controls];
    data_.around = neighbourhoods(set.data, model.phones);
    data_.time_margin = own_.time_margin;
    data_.duration_exponent = own_.duration_exponent;
    data_.offset_frames = own_.offset_frames;
    data_.terms = own_.terms;
    data_.threads = options.threads;
    search_.prior = own_.width_prior;
    search_.max_steps = options.max_iterations;
    search_.tolerance = options.tolerance;
  }

  Result<Parameters> fit() {
    if (!run_.report("dominance", 0)) return TrainRun::cancelled();
    const std::vector<double> directions = principal_components(data_);
    RefinedData main = data_;
    main.controls = directions.size() / data_.controls;
    main.target = rotated(data_.target, data_.controls, directions);
    const TermSpace space = term_space(data_);
    DominanceFit fit = start_dominance(main, search_);
    run_.summary.objective.push_back(fit.objective);
    if (!improve(main, fit)) return TrainRun::cancelled();
    if (!run_.report("curves", 0, fit.objective)) return TrainRun::cancelled();
    return finish(space, fit.dominance, main, directions);
  }

 private:
  bool improve(const RefinedData& main, DominanceFit& fit) {
    bool go_on = true;
    int taken = 0;
    run_.summary.converged = fit_dominance(main, search_, fit, [&](const DominanceFit& now) {
      run_.summary.objective.push_back(now.objective);
      go_on = run_.report("dominance", double(++taken) / (search_.max_steps + 1), now.objective);
      return go_on;
    });
    return go_on;
  }

  Result<Parameters> finish(const TermSpace& space, std::vector<PhoneDominance> dominance,
                            const RefinedData& main, const std::vector<double>& directions) {
    const auto& sentences = data_.speech->sentences;
    const bool choose = sentences.size() >= kLeastToChoose;
    std::vector<float> kept = frame_weights(*data_.speech, own_.rare_words);
    std::vector<float> held(kept.size(), 0.0F);
    for (std::size_t s = kHeldOut / 2; choose && s < sentences.size(); s += kHeldOut) {
      const auto first = std::ptrdiff_t(sentences[s].first_frame);
      std::swap_ranges(kept.begin() + first,
                       kept.begin() + first + std::ptrdiff_t(sentences[s].frames),
                       held.begin() + first);
    }
    const TermColumns columns = shared_columns(data_, space);
    const std::size_t k = data_.controls;
    CurveSums sums(columns.size, k);
    add_curves(data_, space, columns, dominance, kept, sums);
    double factor = own_.ridge > 0 ? own_.ridge : kUsualRidge;
    if (choose) {
      const RidgeChooser chooser(sums.gram, space, columns, own_.ridge, options_.threads);
      const auto trial = [&](const RefinedData& data, std::span<const double> right) {
        return RidgeTrial{sums.gram, right, data.controls, [&](const auto& solution) {
                            return errors_on(data, space, columns, dominance, held, solution);
                          }};
      };
      // The main components have all but a hundredth of what there is to compare.
      const std::vector<double> right = rotated(sums.right, k, directions);
      factor = chooser.choose(trial(main, right), [&](double share) {
        return run_.report("curves", 0.1 + 0.6 * share);
      });
      if (factor == 0) return TrainRun::cancelled();
      if (run_.explain)
        note_explained(controls_, chooser.explained(trial(data_, sums.right), factor), true,
                       run_.summary);
      add_curves(data_, space, columns, dominance, held, sums);
    }
    if (!run_.report("curves", 0.7)) return TrainRun::cancelled();
    run_.summary.ridge = factor;
    const auto solution =
        solve_curves(sums.gram, sums.right, space, columns, k, factor, options_.threads);
    return Parameters(refined_parameters(space, curves_of(space, columns, solution, k), mean_, own_,
                                         std::move(dominance)));
  }

  const TrainOptions& options_;
  const RefinedOptions& own_;
  TrainRun& run_;
  std::span<const Control> controls_;
  std::vector<double> mean_;
  RefinedData data_;
  DominanceOptions search_;
};

}  // namespace

Result<Parameters> fit_refined(const TrainingSet& set, const Model& model,
                               const TrainOptions& options, TrainRun& run) {
  return RefinedTrainer(set, model, options, run).fit();
}

}  // namespace animeme::dam

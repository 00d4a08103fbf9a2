// One pose per phone: those that, interpolated, are nearest to the recording.
#include <algorithm>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/table/table.h"
#include "dam/kinds/table/viseme_weights.h"
#include "dam/maths/linear_algebra.h"

namespace animeme::dam {
namespace {

/// Calls use(frame, phone, weight, phone, weight) for the frames that count, in order.
template <class Use>
void for_frames(const SpeechData& data, double place, double plateau, const Use& use) {
  for (const FitSentence& sentence : data.sentences) {
    if (sentence.occurrences == 0) continue;
    const FitOccurrence* list = &data.occurrences[sentence.first_occurrence];
    const auto hold = [&](std::size_t j) {
      return hold_of(list[j].start, list[j].duration, place, plateau);
    };
    std::size_t near = 0;
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      const std::size_t frame = sentence.first_frame + i;
      if (data.use[frame] == 0) continue;
      const Between at = between_poses(sentence.occurrences, double(i) / data.rate, hold, near);
      use(frame, list[at.from].phone, 1 - at.share, list[at.to].phone, at.share);
    }
  }
}

using Poses = std::vector<double>;  // phones x controls, row by row

/// Adds a share of a frame to the row of a phone.
void add_frame(const SpeechData& data, std::size_t frame, double share, std::int32_t phone,
               Poses& sums) {
  const std::size_t k = data.controls;
  for (std::size_t c = 0; c < k; ++c)
    sums[std::size_t(phone) * k + c] += share * data.target[frame * k + c];
}

/// Mean of the frames nearest to each phone, drawn to the mean of all by one frame.
Poses mean_poses(const SpeechData& data, std::size_t phones) {
  const std::size_t k = data.controls;
  Poses sum(phones * k);
  std::vector<double> count(phones);
  double frames = 0;
  // A hold of the whole phone gives every frame to the phone it lies in.
  for_frames(data, 0.5, 1,
             [&](std::size_t frame, std::int32_t a, double wa, std::int32_t b, double wb) {
               const std::int32_t phone = wa >= wb ? a : b;
               add_frame(data, frame, 1, phone, sum);
               count[std::size_t(phone)] += 1;
               frames += 1;
             });
  std::vector<double> all = column_sums(sum, k);
  for (double& x : all) x /= std::max(1.0, frames);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = (sum[i] + all[i % k]) / (count[i / k] + 1);
  return sum;
}

struct Fit {
  Poses poses;
  double objective = 0;  ///< squared error and prior
};

Fit fit_poses(const SpeechData& data, const Poses& centre, double prior, double place,
              double plateau) {
  const std::size_t k = data.controls, phones = centre.size() / k;
  std::vector<double> gram(phones * phones);
  const auto at = [&](std::int32_t a, std::int32_t b) -> double& {
    return gram[std::size_t(b) * phones + std::size_t(a)];
  };
  Poses right = centre;
  for (double& x : right) x *= prior;
  double energy = prior * dot(centre, centre);
  for (std::size_t p = 0; p < phones; ++p) gram[p * phones + p] = prior;
  for_frames(data, place, plateau,
             [&](std::size_t frame, std::int32_t a, double wa, std::int32_t b, double wb) {
               const double* y = &data.target[frame * k];
               energy += dot(y, y, k);
               at(a, a) += wa * wa;
               at(b, b) += wb * wb;
               at(a, b) += wa * wb;
               at(b, a) += wa * wb;
               add_frame(data, frame, wa, a, right);
               add_frame(data, frame, wb, b, right);
             });
  Fit fit;
  fit.poses = solve_symmetric(gram, phones, right, k);
  fit.objective = energy - dot(fit.poses, right);
  return fit;
}

}  // namespace

Result<Parameters> fit_visemes(const TrainingSet& set, const Model& model,
                               const TrainOptions& options, TrainRun& run) {
  const double prior = options.table.pose_prior;
  const Poses centre = mean_poses(set.data, model.phones.size());
  VisemeParameters best;
  Fit fit;
  constexpr int kSteps = 10;
  bool first = true;
  for (int place = 2; place <= 8; ++place) {
    if (!run.report("fit", double(place) / kSteps, fit.objective)) return TrainRun::cancelled();
    for (int plateau = 0; plateau <= 8; plateau += 2) {
      Fit now =
          fit_poses(set.data, centre, prior, place / double(kSteps), plateau / double(kSteps));
      if (!first && !(now.objective < fit.objective)) continue;
      fit = std::move(now);
      first = false;
      best.place = place / double(kSteps);
      best.plateau = plateau / double(kSteps);
    }
  }
  run.summary.objective.push_back(fit.objective);
  run.summary.converged = true;
  best.poses = std::move(fit.poses);
  return Parameters(std::move(best));
}

}  // namespace animeme::dam

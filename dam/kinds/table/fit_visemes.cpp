// One pose a phone: those that, interpolated, are nearest to the recording.
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/table/table.h"
#include "dam/kinds/table/viseme_weights.h"

namespace animeme::dam {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

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

Eigen::Map<const Eigen::RowVectorXd> target(const SpeechData& data, std::size_t frame) {
  return {&data.target[frame * data.controls], Eigen::Index(data.controls)};
}

/// Mean of the frames nearest to each phone, drawn to the mean of all by one frame.
RowMatrix mean_poses(const SpeechData& data, std::size_t phones) {
  RowMatrix sum = RowMatrix::Zero(Eigen::Index(phones), Eigen::Index(data.controls));
  Eigen::VectorXd count = Eigen::VectorXd::Zero(Eigen::Index(phones));
  // A hold of the whole phone gives every frame to the phone it lies in.
  for_frames(data, 0.5, 1,
             [&](std::size_t frame, std::int32_t a, double wa, std::int32_t b, double wb) {
               const std::int32_t phone = wa >= wb ? a : b;
               sum.row(phone) += target(data, frame);
               count[phone] += 1;
             });
  const Eigen::RowVectorXd all = sum.colwise().sum() / std::max(1.0, count.sum());
  for (Eigen::Index p = 0; p < sum.rows(); ++p) sum.row(p) = (sum.row(p) + all) / (count[p] + 1);
  return sum;
}

struct Fit {
  RowMatrix poses;
  double objective = 0;  ///< squared error and prior
};

Fit fit_poses(const SpeechData& data, const RowMatrix& centre, double prior, double place,
              double plateau) {
  const Eigen::Index phones = centre.rows();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(phones, phones);
  RowMatrix right = prior * centre;
  double energy = prior * centre.squaredNorm();
  gram.diagonal().setConstant(prior);
  for_frames(data, place, plateau,
             [&](std::size_t frame, std::int32_t a, double wa, std::int32_t b, double wb) {
               const auto y = target(data, frame);
               energy += y.squaredNorm();
               gram(a, a) += wa * wa;
               gram(b, b) += wb * wb;
               gram(a, b) += wa * wb;
               gram(b, a) += wa * wb;
               right.row(a) += wa * y;
               right.row(b) += wb * y;
             });
  Fit fit;
  fit.poses = gram.ldlt().solve(right);
  fit.objective = energy - fit.poses.cwiseProduct(right).sum();
  return fit;
}

}  // namespace

Result<Parameters> fit_visemes(const TrainingSet& set, const Model& model,
                               const TrainOptions& options, TrainRun& run) {
  const double prior = options.table.pose_prior;
  const RowMatrix centre = mean_poses(set.data, model.phones.size());
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
  best.poses.assign(fit.poses.data(), fit.poses.data() + fit.poses.size());
  return Parameters(std::move(best));
}

}  // namespace animeme::dam

// The sums of an adaptation, and the model that is made of them.
#include <algorithm>
#include <memory>
#include <optional>

#include "dam/training/adapt_internal.h"
#include "dam/training/training_sums_internal.h"

namespace animeme::dam {

/// The sentences of each fold summed once: own controls, and behind them those of the base as it
/// speaks them, under names that mean nothing. Curves are linear in what they are fitted to, so one
/// solution serves every mixture of the two.
Result<std::vector<TrainingSums>> sums_of_folds(const Model& base, const Material& material,
                                                std::size_t folds, const TrainOptions& options) {
  std::vector<TrainingSums> all;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    auto sums = TrainingSums::start(options, &base);
    if (!sums) return sums.error();
    auto state = std::move(*sums).release();
    for (std::size_t s = fold; s < material.sentences.size(); s += folds) {
      const Utterance& u = material.sentences[s];
      const Signal& made = material.made[s];
      const std::size_t ny = u.signal.names.size(), nx = made.names.size();
      Utterance both{u.id, "", u.script, {}, {}};
      both.signal.rate = u.signal.rate;
      both.signal.measured = u.signal.measured;
      for (std::size_t c = 0; c < ny + nx; ++c)
        both.signal.names.push_back("column" + std::to_string(c));
      for (std::size_t i = 0; i < u.signal.frames(); ++i) {
        for (std::size_t c = 0; c < ny; ++c) both.signal.values.push_back(u.signal.at(i, c));
        for (std::size_t c = 0; c < nx; ++c) both.signal.values.push_back(made.at(i, c));
      }
      if (auto added = add_to_sums(*state, both, sentence_digest(both)); !added)
        return added.error();
    }
    all.emplace_back(std::move(state));
  }
  return all;
}

/// All folds but one; `without` = number of folds: all.
Result<TrainingSums> sums_without(const std::vector<TrainingSums>& folds, std::size_t without) {
  std::unique_ptr<SumsState> state;
  std::optional<TrainingSums> sum;
  for (std::size_t fold = 0; fold < folds.size(); ++fold) {
    if (fold == without) continue;
    if (!sum) {
      sum.emplace(std::make_unique<SumsState>(folds[fold].state()));
    } else if (auto ok = sum->merge(folds[fold]); !ok) {
      return ok.error();
    }
  }
  // The ridge is given, so nothing is held out to choose it.
  state = std::move(*sum).release();
  add_fit(state->held, *state, *state, state->kept);
  state->held = {};
  widen(*state, state->space);
  return TrainingSums(std::move(state));
}

/// Own controls and those of the base, as curves of all phones of the base: those that were not
/// said have the mean, and the terms of their class.
Result<Model> solved(const Model& base, const TrainingSums& sums, TrainOptions options,
                     double ridge) {
  options.method = Method::dam;
  options.refined.ridge = ridge;
  auto model = train_from_sums(TrainingSums(std::make_unique<SumsState>(sums.state())), options);
  if (!model) return model;
  return with_phones_of(base, *model);
}

/// The model that a recipe makes of all sentences.
Result<Model> mixed_model(const Ingredients& from, const Recipe& recipe, const Telling& telling,
                          const TrainOptions& options) {
  const std::size_t ny = from.controls.size(), nx = from.base.controls.size();
  const auto sums = sums_without(from.folds, from.folds.size());
  if (!sums) return sums.error();
  std::vector<Model> learned;
  std::vector<ModelShare> shares;
  std::vector<double> offset(ny);
  learned.reserve(2);
  const auto learn = [&](double ridge) -> Result<void> {
    auto model = solved(from.base, *sums, options, ridge);
    if (!model) return model.error();
    learned.push_back(std::move(*model));
    shares.push_back({&learned.back(), std::vector<double>(ny * (ny + nx))});
    return {};
  };
  if (auto ok = learn(recipe.own_ridge); !ok) return ok.error();
  for (std::size_t c = 0; c < ny; ++c) shares[0].gain[c * (ny + nx) + c] = 1 - recipe.share[c];
  std::size_t curves = 0;
  if (recipe.bent_ridge > 0 && recipe.bent_ridge != recipe.own_ridge) {
    if (auto ok = learn(recipe.bent_ridge); !ok) return ok.error();
    curves = 1;
  }
  ModelShare bent{&from.base, telling.gain};
  for (std::size_t c = 0; c < ny; ++c) {
    const double share = recipe.share[c];
    for (std::size_t b = 0; b < nx; ++b) {
      bent.gain[c * nx + b] *= share;
      if (recipe.bent_ridge > 0)
        shares[curves].gain[c * (ny + nx) + ny + b] -= bent.gain[c * nx + b];
    }
    if (recipe.bent_ridge > 0)
      shares[curves].gain[c * (ny + nx) + c] += share;
    else
      offset[c] = share * telling.offset[c];
  }
  shares.push_back(std::move(bent));
  Model model = add_up(from.base, shares, offset, {from.controls.begin(), from.controls.end()});
  for (std::size_t p = 0; p < model.phones.size(); ++p) {
    model.phones[p].examples += learned[0].phones[p].examples;
    model.phones[p].longest = std::max(model.phones[p].longest, learned[0].phones[p].longest);
  }
  return model;
}

}  // namespace animeme::dam

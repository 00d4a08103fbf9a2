#include "tools/formats/inspect/cross_validation.h"

#include <algorithm>
#include <optional>

#include "dam/training/adapt.h"
#include "dam/training/train.h"

namespace animeme::inspect {
namespace {

Error stopped() { return make_error(Code::invalid_argument, "cross validation was stopped"); }

Result<dam::Model> learn(std::span<const dam::Utterance> sentences, const CrossValidation& options,
                         const dam::ProgressFunction& progress) {
  if (options.base != nullptr)
    return dam::adapt(*options.base, sentences, options.train, nullptr, progress);
  return dam::train(sentences, options.train, nullptr, progress);
}

}  // namespace

Result<std::vector<dam::SentencePair>> cross_validate(std::span<const dam::Utterance> sentences,
                                                      const CrossValidation& options) {
  if (sentences.size() < 2 || options.folds < 2)
    return make_error(Code::invalid_argument,
                      "cross validation needs two sentences and two folds at least");
  std::vector<dam::Utterance> sorted(sentences.begin(), sentences.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  const std::size_t folds = std::min(options.folds, sorted.size());
  std::vector<std::optional<dam::SentencePair>> made(sorted.size());
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<dam::Utterance> in, out;
    for (std::size_t s = 0; s < sorted.size(); ++s)
      (s % folds == fold ? out : in).push_back(sorted[s]);
    const auto progress = [&](const dam::Progress& now) {
      return !options.progress || options.progress((double(fold) + now.done) / double(folds));
    };
    if (!progress({})) return stopped();
    const Result<dam::Model> model = learn(in, options, progress);
    if (!model) return model.error();
    auto pairs = dam::synthesise_pairs(*model, out, options.evaluate);
    if (!pairs) return pairs.error();
    for (std::size_t i = 0; i < pairs->size(); ++i) made[fold + i * folds] = std::move((*pairs)[i]);
  }
  std::vector<dam::SentencePair> all;
  for (auto& pair : made) all.push_back(std::move(*pair));
  return all;
}

}  // namespace animeme::inspect

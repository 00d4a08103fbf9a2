#include "tools/formats/inspect/evaluation.h"

namespace animeme::inspect {
namespace {

double nrmse_of(const std::vector<dam::SeriesScore>& series, std::string_view name) {
  for (const dam::SeriesScore& one : series)
    if (one.name == name) return one.nrmse;
  return 0;
}

}  // namespace

Result<std::vector<RuleCost>> rule_costs(const dam::Model& model,
                                         std::span<const dam::Utterance> recorded,
                                         const dam::ScoreOptions& scoring) {
  const auto score = [&](bool closure, double sharpness, double articulation) {
    dam::EvaluateOptions options;
    options.score = scoring;
    options.synthesis.closure = closure;
    options.synthesis.sharpness = sharpness;
    options.synthesis.articulation = articulation;
    return dam::evaluate(model, recorded, options);
  };
  const auto plain = score(false, 0, 0);
  if (!plain) return plain.error();
  std::vector<RuleCost> costs;
  const auto add = [&](const char* name, const Result<dam::Evaluation>& with) {
    costs.push_back({name, with->nrmse - plain->nrmse, with->fitted_nrmse - plain->fitted_nrmse,
                     with->gap_correlation - plain->gap_correlation,
                     nrmse_of(with->measures, "inner_gap") - nrmse_of(plain->measures, "inner_gap"),
                     nrmse_of(with->measures, "jaw") - nrmse_of(plain->measures, "jaw")});
  };
  const auto closure = score(true, 0, 0), sharpness = score(false, 1, 0),
             articulation = score(false, 0, 1);
  for (const auto* one : {&closure, &sharpness, &articulation})
    if (!*one) return one->error();
  add("closure", closure);
  add("sharpness", sharpness);
  add("articulation", articulation);
  return costs;
}

}  // namespace animeme::inspect

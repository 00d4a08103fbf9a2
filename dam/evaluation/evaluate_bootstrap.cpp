#include "dam/evaluation/evaluate_bootstrap.h"

#include <string>
#include <vector>

#include "dam/evaluation/evaluate_sums_internal.h"
#include "dam/maths/random.h"

namespace animeme::dam {
namespace {

/// The errors of one system over a set of sentences.
struct Errors {
  double nrmse, l2, gap_rmse;
};
Errors errors_of(const Evaluation& e, const std::vector<std::size_t>& sentences) {
  ErrorSums sums;
  for (const std::size_t i : sentences) sums.add(e.per_utterance[i].sums);
  return {sums.nrmse(), sums.mean_l2(), sums.gap_rmse()};
}

ErrorDifference summarise(double a, double b, std::vector<double> draws, double coverage) {
  ErrorDifference out{a, b, a - b, 0, 0, 0};
  for (const double d : draws) out.below += d < 0 ? 1 : 0;
  out.below /= double(draws.size());
  out.low = percentile(draws, (1 - coverage) / 2);
  out.high = percentile(draws, (1 + coverage) / 2);
  return out;
}

Result<void> check(const Evaluation& a, const Evaluation& b, const BootstrapOptions& options) {
  if (options.draws < 1 || options.draws > 1'000'000)
    return make_error(Code::invalid_argument, "draws must lie between 1 and 1000000");
  if (!(options.coverage >= 0.5 && options.coverage <= 0.999))
    return make_error(Code::invalid_argument, "coverage must lie between 0.5 and 0.999");
  if (a.per_utterance.empty() || a.per_utterance.size() != b.per_utterance.size())
    return make_error(Code::invalid_argument, "both systems must be scored on the same sentences");
  for (std::size_t i = 0; i < a.per_utterance.size(); ++i) {
    const UtteranceScore& x = a.per_utterance[i];
    const UtteranceScore& y = b.per_utterance[i];
    if (x.id != y.id || x.frames != y.frames || x.sums.squared.size() != y.sums.squared.size())
      return make_error(Code::invalid_argument,
                        "sentence '" + x.id +
                            "' was scored otherwise for the second system: other frames or other "
                            "controls; give both the same scale");
  }
  return {};
}

}  // namespace

Result<PairedDifference> paired_difference(const Evaluation& a, const Evaluation& b,
                                           const BootstrapOptions& options) {
  if (auto ok = check(a, b, options); !ok) return ok.error();
  const std::size_t count = a.per_utterance.size();
  std::vector<std::size_t> sentences(count);
  for (std::size_t i = 0; i < count; ++i) sentences[i] = i;
  const Errors whole_a = errors_of(a, sentences), whole_b = errors_of(b, sentences);
  std::vector<double> nrmse, l2, gap;
  Random random(options.seed);
  for (int draw = 0; draw < options.draws; ++draw) {
    for (std::size_t& s : sentences) s = random.below(count);
    const Errors x = errors_of(a, sentences), y = errors_of(b, sentences);
    nrmse.push_back(x.nrmse - y.nrmse);
    l2.push_back(x.l2 - y.l2);
    gap.push_back(x.gap_rmse - y.gap_rmse);
  }
  PairedDifference out{count, options.draws, {}, {}, {}};
  out.nrmse = summarise(whole_a.nrmse, whole_b.nrmse, std::move(nrmse), options.coverage);
  out.l2 = summarise(whole_a.l2, whole_b.l2, std::move(l2), options.coverage);
  out.gap_rmse = summarise(whole_a.gap_rmse, whole_b.gap_rmse, std::move(gap), options.coverage);
  return out;
}

}  // namespace animeme::dam

#include <algorithm>
#include <cmath>

#include "dam/kinds/animeme/animemes.h"
#include "dam/kinds/animeme/choose_modes.h"
#include "dam/model/animeme.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

/// Eq. 2: adds D A of one occurrence to the frames in its reach, and D to `sums`.
void add_occurrence(const Speech& speech, const AnimemeParameters& model, const Mode& mode,
                    const Occurrence& o, std::span<double> rows, std::vector<double>& sums) {
  const std::size_t terms = model.order + 1, controls = speech.model.controls.size();
  const double reach = dominance_reach(mode.sigma) * o.paced();
  const auto [first, last] = speech.frames_between(o.start - reach, o.end() + reach);
  for (std::size_t i = first; i < last; ++i) {
    const double u = o.local(speech.time(i));
    const double v = clamp_local_time(u, model.time_margin);
    double* out = &rows[i * controls];
    double weight = dominance(u, mode.sigma);
    sums[i] += weight;
    for (std::size_t m = 0; m < terms; ++m, weight *= v) {
      const double* a = &mode.coefficients[m * controls];
      for (std::size_t c = 0; c < controls; ++c) out[c] += weight * a[c];
    }
  }
}

void normalise(const std::vector<double>& sums, std::size_t controls, std::span<double> rows) {
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t c = 0; c < controls; ++c)
      rows[i * controls + c] /= std::max(sums[i], kLeastDominanceSum);
}

}  // namespace

double reach_of_animemes(const Model& model) {
  const auto& parameters = std::get<AnimemeParameters>(model.parameters);
  double reach = 0;
  for (std::size_t p = 0; p < model.phones.size(); ++p)
    for (const Mode& mode : parameters.phones[p].modes)
      reach = std::max(reach, dominance_reach(mode.sigma) * model.phones[p].longest);
  return reach;
}

void speak_animemes(const Speech& speech, std::span<double> rows, SynthesisReport& report) {
  const auto& parameters = std::get<AnimemeParameters>(speech.model.parameters);
  report.modes = choose_modes(speech);
  std::vector<double> sums(speech.frames, 0.0);
  for (std::size_t j = 0; j < speech.timeline.size(); ++j) {
    const AnimemePhone& phone = parameters.phones[std::size_t(speech.phone[j])];
    add_occurrence(speech, parameters, phone.modes[report.modes[j]], speech.timeline[j], rows,
                   sums);
  }
  if (parameters.normalised) normalise(sums, speech.model.controls.size(), rows);
}

}  // namespace animeme::dam

#include <algorithm>
#include <cmath>

#include "dam/kinds/animeme/fit.h"
#include "dam/model/animeme.h"

namespace animeme::dam {

void legendre(double u, double margin, int order, double* out) {
  const double v = 2 * clamp_local_time(u, margin) - 1;
  out[0] = 1;
  if (order >= 1) out[1] = v;
  for (int m = 1; m < order; ++m)
    out[m + 1] = (double(2 * m + 1) * v * out[m] - double(m) * out[m - 1]) / double(m + 1);
}

std::vector<double> power_coefficients(std::span<const double> c) {
  const std::size_t n = c.size();
  std::vector<double> before(n, 0.0), now(n, 0.0), sum(n, 0.0);
  now[0] = 1;
  for (std::size_t m = 0; m < n; ++m) {
    for (std::size_t i = 0; i < n; ++i) sum[i] += c[m] * now[i];
    // (m+1) P[m+1] = (2m+1) (2u-1) P[m] - m P[m-1]
    std::vector<double> next(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double shifted = i > 0 ? now[i - 1] : 0.0;
      next[i] =
          (double(2 * m + 1) * (2 * shifted - now[i]) - double(m) * before[i]) / double(m + 1);
    }
    before = std::move(now);
    now = std::move(next);
  }
  return sum;
}

FrameRange reach_of(const FitData& data, const FitSentence& sentence, const FitOccurrence& o,
                    double sigma) {
  const double reach = dominance_reach(sigma) * o.duration;
  const double last = double(sentence.frames);
  const double from = std::ceil((o.start - reach) * data.rate);
  const double to = std::floor((o.start + o.duration + reach) * data.rate) + 1;
  return {std::size_t(std::clamp(from, 0.0, last)), std::size_t(std::clamp(to, 0.0, last))};
}

Design make_design(const FitData& data, const FitSentence& sentence,
                   std::span<const double> sigma) {
  Design design = make_raw_design(data, sentence, sigma);
  if (!data.normalised) return design;
  for (std::size_t i = 0; i < sentence.frames; ++i) {
    const std::span<Part> parts(design.parts.data() + design.begin[i],
                                design.begin[i + 1] - design.begin[i]);
    double sum = 0;
    for (const Part& part : parts) sum += part.dominance;
    for (Part& part : parts) {
      part.dominance /= std::max(sum, kLeastDominanceSum);
      part.slope /= std::max(sum, kLeastDominanceSum);
    }
  }
  return design;
}

Design make_raw_design(const FitData& data, const FitSentence& sentence,
                       std::span<const double> sigma) {
  std::vector<FrameRange> ranges(sentence.occurrences);
  Design design;
  design.begin.assign(sentence.frames + 1, 0);
  for (std::size_t j = 0; j < sentence.occurrences; ++j) {
    const FitOccurrence& o = data.occurrences[sentence.first_occurrence + j];
    ranges[j] = reach_of(data, sentence, o, sigma[o.mode]);
    for (std::size_t i = ranges[j].begin; i < ranges[j].end; ++i) ++design.begin[i + 1];
  }
  for (std::size_t i = 0; i < sentence.frames; ++i) design.begin[i + 1] += design.begin[i];
  design.parts.resize(design.begin.back());
  std::vector<std::size_t> next(design.begin.begin(), design.begin.end() - 1);
  for (std::size_t j = 0; j < sentence.occurrences; ++j) {
    const FitOccurrence& o = data.occurrences[sentence.first_occurrence + j];
    for (std::size_t i = ranges[j].begin; i < ranges[j].end; ++i) {
      const double u = (double(i) / data.rate - o.start) / o.duration;
      Part& part = design.parts[next[i]++];
      part.occurrence = std::uint32_t(sentence.first_occurrence + j);
      part.mode = o.mode;
      part.dominance = dominance(u, sigma[o.mode]);
      part.slope = dominance_slope(u, sigma[o.mode]);
      legendre(u, data.time_margin, data.order, part.basis);
    }
  }
  return design;
}

std::vector<double> predict(const FitData& data, const FitState& state, const FitSentence& sentence,
                            const Design& design) {
  const std::size_t k = data.controls, terms = data.terms();
  std::vector<double> out(sentence.frames * k, 0.0);
  for (std::size_t i = 0; i < sentence.frames; ++i)
    for (const Part& part : design.frame(i))
      for (std::size_t m = 0; m < terms; ++m) {
        const double w = part.dominance * part.basis[m];
        const double* a = &state.coefficients[(part.mode * terms + m) * k];
        for (std::size_t c = 0; c < k; ++c) out[i * k + c] += w * a[c];
      }
  return out;
}

}  // namespace animeme::dam

#include "dam/kinds/refined/curves_fit.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "dam/kinds/refined/curve_products.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kAtOnce = 64;  // sentences whose products are kept until they are added
constexpr std::size_t kStripes = 8;  // sets of columns, each of which one task adds to

/// A term of an occurrence with its columns.
struct PlacedTerm {
  std::size_t first = 0, orders = 0;
  double scale = 1;

  std::size_t stripe() const { return first % kStripes; }
};

/// The terms of an occurrence, by stripe.
struct PlacedTerms {
  std::vector<PlacedTerm> all;
  std::array<std::size_t, kStripes + 1> begin{};

  std::span<const PlacedTerm> of_stripe(std::size_t s) const {
    return {all.data() + begin[s], begin[s + 1] - begin[s]};
  }
};

PlacedTerms place(const RefinedData& data, const TermSpace& space, const TermColumns& columns,
                  std::size_t occurrence) {
  const auto uses = terms_of(data.phones, data.around[occurrence]);
  PlacedTerms placed;
  for (std::size_t t = 0; t < kTermCount; ++t) {
    if (!space.holds(t, uses[t])) continue;
    const std::uint32_t first = columns.first[t][space.row_of(t, uses[t].key)];
    if (first != TermColumns::kNone)
      placed.all.push_back({first, kTermInfo[t].orders, uses[t].scale});
  }
  std::stable_sort(placed.all.begin(), placed.all.end(),
                   [](const auto& a, const auto& b) { return a.stripe() < b.stripe(); });
  for (const PlacedTerm& term : placed.all) ++placed.begin[term.stripe() + 1];
  for (std::size_t s = 0; s < kStripes; ++s) placed.begin[s + 1] += placed.begin[s];
  return placed;
}

/// Sum of the columns of a term over a sentence.
struct ColumnSum {
  PlacedTerm term;
  std::array<double, kRefinedOrders> sum{};
};

/// A sentence with all that its sums need.
struct SummedSentence {
  CurveProducts products;
  std::vector<PlacedTerms> terms;
  std::vector<ColumnSum> columns;  // times the root of the share that is taken off
  std::vector<double> targets;     // likewise
};

SummedSentence summed_sentence(const RefinedData& data, const TermSpace& space,
                               const TermColumns& columns,
                               std::span<const PhoneDominance> dominance,
                               std::span<const float> weight, const FitSentence& sentence) {
  SummedSentence out{curve_products(data, sentence, dominance, weight), {}, {}, {}};
  const CurveProducts& products = out.products;
  if (products.frames == 0) return out;
  std::map<std::size_t, ColumnSum> sums;
  const double root = std::sqrt(1 / (products.weight + data.offset_frames));
  for (std::size_t j = 0; j < sentence.occurrences; ++j) {
    out.terms.push_back(place(data, space, columns, sentence.first_occurrence + j));
    for (const PlacedTerm& term : out.terms.back().all) {
      ColumnSum& sum = sums[term.first];
      sum.term = term;
      for (std::size_t m = 0; m < term.orders; ++m)
        sum.sum[m] += root * term.scale * products.own_sum[j * kRefinedOrders + m];
    }
  }
  for (const auto& [first, sum] : sums) out.columns.push_back(sum);
  for (const double sum : products.target_sum) out.targets.push_back(root * sum);
  return out;
}

/// Adds the columns of one stripe.
class StripeAdder {
 public:
  StripeAdder(std::size_t stripe, std::size_t controls, CurveSums& sums)
      : stripe_(stripe), controls_(controls), sums_(sums) {}

  void add(const SummedSentence& sentence) {
    const CurveProducts& products = sentence.products;
    for (std::size_t j = 0; j < sentence.terms.size(); ++j)
      for (const PlacedTerm& t : sentence.terms[j].of_stripe(stripe_))
        for (std::size_t m = 0; m < t.orders; ++m)
          add_right(t.first + m, t.scale,
                    &products.own_target[(j * kRefinedOrders + m) * controls_]);
    for (std::size_t p = 0; p < products.pairs.size(); ++p) {
      const auto [a, b] = products.pairs[p];
      add_pair(sentence.terms[a], sentence.terms[b], products.squares[p], 1, kRefinedOrders);
      if (a != b)
        add_pair(sentence.terms[b], sentence.terms[a], products.squares[p], kRefinedOrders, 1);
    }
    take_off(sentence);
  }

 private:
  void add_right(std::size_t row, double scale, const double* __restrict from) {
    double* __restrict to = &sums_.right[row * controls_];
    for (std::size_t c = 0; c < controls_; ++c) to[c] += scale * from[c];
  }

  /// Numbers of column `column` from row `row` on.
  double* place_of(std::size_t row, std::size_t column) { return &sums_.gram.at(row, column); }

  /// Rows by the terms of one occurrence, columns by those of the other; the product of row order
  /// m and column order n is at m * row_step + n * column_step.
  void add_pair(const PlacedTerms& rows, const PlacedTerms& columns, const CurveSquare& square,
                std::size_t row_step, std::size_t column_step) {
    for (const PlacedTerm& column : columns.of_stripe(stripe_))
      for (const PlacedTerm& row : rows.all) {
        if (row.first < column.first) continue;
        const double scale = row.scale * column.scale;
        const bool corner = row.first == column.first;
        for (std::size_t n = 0; n < column.orders; ++n) {
          const std::size_t begin = corner ? n : 0;
          if (begin >= row.orders) break;
          double* out = place_of(row.first + begin, column.first + n);
          for (std::size_t m = begin; m < row.orders; ++m)
            out[m - begin] += scale * square[m * row_step + n * column_step];
        }
      }
  }

  /// What the offset of the sentence explains.
  void take_off(const SummedSentence& sentence) {
    const std::vector<ColumnSum>& sums = sentence.columns;
    for (std::size_t j = 0; j < sums.size(); ++j) {
      const ColumnSum& column = sums[j];
      if (column.term.stripe() != stripe_) continue;
      for (std::size_t n = 0; n < column.term.orders; ++n) {
        const std::size_t at = column.term.first + n;
        add_right(at, -column.sum[n], sentence.targets.data());
        for (std::size_t i = j; i < sums.size(); ++i) {
          const ColumnSum& row = sums[i];
          const std::size_t begin = i == j ? n : 0;
          double* out = place_of(row.term.first + begin, at);
          for (std::size_t m = begin; m < row.term.orders; ++m)
            out[m - begin] -= row.sum[m] * column.sum[n];
        }
      }
    }
  }

  std::size_t stripe_, controls_;
  CurveSums& sums_;
};

}  // namespace

void CurveSums::add(const CurveSums& other) {
  const auto to = gram.values();
  const auto from = other.gram.values();
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  for (std::size_t i = 0; i < right.size(); ++i) right[i] += other.right[i];
  for (std::size_t i = 0; i < energy.size(); ++i) energy[i] += other.energy[i];
  frames += other.frames;
}

void add_curves(const RefinedData& data, const TermSpace& space, const TermColumns& columns,
                std::span<const PhoneDominance> dominance, std::span<const float> weight,
                CurveSums& sums) {
  const auto& sentences = data.speech->sentences;
  for (std::size_t begin = 0; begin < sentences.size(); begin += kAtOnce) {
    std::vector<SummedSentence> some(std::min(kAtOnce, sentences.size() - begin));
    parallel_for(some.size(), data.threads, [&](std::size_t s) {
      some[s] = summed_sentence(data, space, columns, dominance, weight, sentences[begin + s]);
    });
    for (const SummedSentence& one : some) {
      if (one.products.frames == 0) continue;
      for (std::size_t c = 0; c < data.controls; ++c)
        sums.energy[c] += one.products.energy[c] - one.targets[c] * one.targets[c];
      sums.frames += one.products.frames;
    }
    parallel_for(kStripes, data.threads, [&](std::size_t stripe) {
      StripeAdder adder(stripe, data.controls, sums);
      for (const SummedSentence& one : some)
        if (one.products.frames > 0) adder.add(one);
    });
  }
}

CurveSums sum_curves(const RefinedData& data, const TermSpace& space,
                     std::span<const PhoneDominance> dominance, std::span<const float> weight) {
  CurveSums sums(space.size, data.controls);
  add_curves(data, space, own_columns(space), dominance, weight, sums);
  return sums;
}

CurveErrors errors_on(const RefinedData& data, const TermSpace& space, const TermColumns& columns,
                      std::span<const PhoneDominance> dominance, std::span<const float> weight,
                      const std::vector<double>& solution) {
  const std::size_t k = data.controls;
  const auto& sentences = data.speech->sentences;
  std::vector<CurveErrors> parts(sentences.size());
  parallel_for(sentences.size(), data.threads, [&](std::size_t s) {
    const SummedSentence one =
        summed_sentence(data, space, columns, dominance, weight, sentences[s]);
    const CurveProducts& products = one.products;
    if (products.frames == 0) return;
    std::vector<double> curves(one.terms.size() * kRefinedOrders * k);
    const auto curve = [&](std::size_t j, std::size_t m) {
      return &curves[(j * kRefinedOrders + m) * k];
    };
    for (std::size_t j = 0; j < one.terms.size(); ++j)
      for (const PlacedTerm& t : one.terms[j].all)
        for (std::size_t i = 0; i < t.orders * k; ++i)
          curve(j, 0)[i] += t.scale * solution[t.first * k + i];
    CurveErrors& out = parts[s];
    out.error = products.energy;
    std::vector<double> rest = products.target_sum;  // what is left over in the mean
    for (std::size_t j = 0; j < one.terms.size() * kRefinedOrders; ++j)
      for (std::size_t c = 0; c < k; ++c) {
        out.error[c] -= 2 * curves[j * k + c] * products.own_target[j * k + c];
        rest[c] -= products.own_sum[j] * curves[j * k + c];
      }
    for (std::size_t p = 0; p < products.pairs.size(); ++p) {
      const auto [a, b] = products.pairs[p];
      for (std::size_t n = 0; n < kRefinedOrders; ++n)
        for (std::size_t m = 0; m < kRefinedOrders; ++m) {
          const double w = (a == b ? 1 : 2) * products.squares[p][n * kRefinedOrders + m];
          const double *from = curve(a, m), *with = curve(b, n);
          for (std::size_t c = 0; c < k; ++c) out.error[c] += w * from[c] * with[c];
        }
    }
    const double share = 1 / (products.weight + data.offset_frames);
    for (std::size_t c = 0; c < k; ++c) {
      out.error[c] -= share * rest[c] * rest[c];
      out.energy.push_back(products.energy[c] - one.targets[c] * one.targets[c]);
    }
  });
  CurveErrors all{std::vector<double>(k), std::vector<double>(k)};
  for (const CurveErrors& part : parts)
    for (std::size_t c = 0; c < part.error.size(); ++c) {
      all.error[c] += part.error[c];
      all.energy[c] += part.energy[c];
    }
  return all;
}

}  // namespace animeme::dam

#include "dam/kinds/refined/curves_fit.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "dam/maths/linear_algebra.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kCurveParts = 2;  // each needs a matrix of all unknowns
constexpr std::size_t kSentences = 64;  // whose sums are taken off together

/// A term of an occurrence with its place among the unknowns.
struct PlacedTerm {
  std::size_t first = 0;
  std::size_t orders = 0;
  double scale = 1;
};
using PlacedTerms = std::array<PlacedTerm, kTermCount>;

PlacedTerms place(const RefinedData& data, const TermSpace& space, std::size_t occurrence) {
  const auto uses = terms_of(data.phones, data.around[occurrence]);
  PlacedTerms placed;
  for (std::size_t t = 0; t < kTermCount; ++t)
    if (space.holds(t, uses[t]))
      placed[t] = {space.at(t, uses[t].key), kTermInfo[t].orders, uses[t].scale};
  return placed;
}

class Summer {
 public:
  Summer(const RefinedData& data, const TermSpace& space, std::span<const PhoneDominance> dominance,
         std::span<const float> weight)
      : data_(data),
        space_(space),
        dominance_(dominance),
        weight_(weight),
        n_(space.size),
        k_(data.controls),
        column_sums_(kSentences * n_),
        target_sums_(kSentences * k_) {
    sums.gram = SquareMatrix(space.size);
    sums.right.assign(space.size * data.controls, 0.0);
    sums.energy.assign(data.controls, 0.0);
  }

  void add(const FitSentence& sentence) {
    const auto weights = weight_.subspan(sentence.first_frame, sentence.frames);
    if (std::all_of(weights.begin(), weights.end(), [](float w) { return w == 0; })) return;
    const RefinedDesign design = make_refined_design(data_, sentence, dominance_);
    collect(sentence, design);
    expand(sentence);
    const double share = 1 / (frames_ + data_.offset_frames);
    const std::span<double> targets = row_of(target_sums_, waiting_, k_);
    for (std::size_t c = 0; c < k_; ++c) sums.energy[c] -= share * targets[c] * targets[c];
    sums.frames += used_;
    const double root = std::sqrt(share);
    for (double& x : row_of(column_sums_, waiting_, n_)) x *= root;
    for (double& x : targets) x *= root;
    if (++waiting_ == kSentences) flush();
  }

  /// Takes off the products of sums of the sentences since the last time.
  void flush() {
    if (waiting_ == 0) return;
    const std::span<const double> columns(column_sums_.data(), waiting_ * n_);
    const std::span<const double> targets(target_sums_.data(), waiting_ * k_);
    subtract_gram_of_rows(columns, waiting_, n_, sums.gram.values());
    subtract_product_of_rows(columns, targets, waiting_, sums.right);
    std::fill(column_sums_.begin(), column_sums_.end(), 0.0);
    std::fill(target_sums_.begin(), target_sums_.end(), 0.0);
    waiting_ = 0;
  }

  CurveSums sums;

 private:
  using Square = std::array<double, kRefinedOrders * kRefinedOrders>;  // column by column

  static std::span<double> row_of(std::vector<double>& rows, std::size_t i, std::size_t width) {
    return {&rows[i * width], width};
  }
  static void add_to(std::span<double> out, double scale, const double* __restrict from) {
    double* __restrict to = out.data();
    for (std::size_t c = 0; c < out.size(); ++c) to[c] += scale * from[c];
  }

  /// Products of the weighted polynomials of every two occurrences that meet, their sums, and their
  /// products with the target: small numbers, from which all terms follow.
  void collect(const FitSentence& sentence, const RefinedDesign& design) {
    const std::size_t count = sentence.occurrences;
    meet_.assign(count, {});
    products_.clear();
    pairs_.clear();
    own_sum_.assign(count * kRefinedOrders, 0.0);
    own_target_.assign(count * kRefinedOrders * k_, 0.0);
    frames_ = 0;
    used_ = 0;
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      const std::size_t frame = sentence.first_frame + i;
      const double weight = weight_[frame];
      if (weight == 0) continue;
      ++used_;
      frames_ += weight;
      const double* y = &data_.target[frame * k_];
      for (std::size_t c = 0; c < k_; ++c) sums.energy[c] += weight * y[c] * y[c];
      add_to(row_of(target_sums_, waiting_, k_), weight, y);
      add_frame(sentence, design.frame(i), y, weight);
    }
  }

  void add_frame(const FitSentence& sentence, std::span<const RefinedPart> parts, const double* y,
                 double weight) {
    for (const RefinedPart& a : parts) {
      const std::size_t ja = a.occurrence - sentence.first_occurrence;
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double x = weight * a.weight * a.basis[m];
        own_sum_[ja * kRefinedOrders + m] += x;
        add_to(row_of(own_target_, ja * kRefinedOrders + m, k_), x, y);
      }
      for (const RefinedPart& b : parts) {
        const std::size_t jb = b.occurrence - sentence.first_occurrence;
        if (jb > ja) continue;
        const double w = weight * a.weight * b.weight;
        Square& square = products_[slot_of(ja, jb)];
        for (std::size_t n = 0; n < kRefinedOrders; ++n)
          for (std::size_t m = 0; m < kRefinedOrders; ++m)
            square[n * kRefinedOrders + m] += w * a.basis[m] * b.basis[n];
      }
    }
  }

  /// Place in products_ of two occurrences that meet. A phone meets some ten others.
  std::size_t slot_of(std::size_t a, std::size_t b) {
    for (const auto& [other, slot] : meet_[a])
      if (other == b) return slot;
    meet_[a].emplace_back(b, products_.size());
    products_.push_back({});
    pairs_.emplace_back(a, b);
    return products_.size() - 1;
  }

  void expand(const FitSentence& sentence) {
    std::vector<PlacedTerms> terms;
    for (std::size_t j = 0; j < sentence.occurrences; ++j)
      terms.push_back(place(data_, space_, sentence.first_occurrence + j));
    for (std::size_t j = 0; j < sentence.occurrences; ++j)
      for (const PlacedTerm& t : terms[j])
        for (std::size_t m = 0; m < t.orders; ++m) {
          column_sums_[waiting_ * n_ + t.first + m] += t.scale * own_sum_[j * kRefinedOrders + m];
          add_to(row_of(sums.right, t.first + m, k_), t.scale,
                 &own_target_[(j * kRefinedOrders + m) * k_]);
        }
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const auto [a, b] = pairs_[p];
      for (const PlacedTerm& ta : terms[a])
        for (const PlacedTerm& tb : terms[b]) {
          add_block(ta, tb, products_[p], false);
          if (a != b) add_block(tb, ta, products_[p], true);
        }
    }
  }

  /// Where the rows lie below the columns, or both are the same term.
  void add_block(const PlacedTerm& row, const PlacedTerm& column, const Square& products,
                 bool transposed) {
    if (row.first < column.first) return;
    const double scale = row.scale * column.scale;
    for (std::size_t n = 0; n < column.orders; ++n) {
      double* out = &sums.gram[(column.first + n) * space_.size + row.first];
      for (std::size_t m = 0; m < row.orders; ++m)
        out[m] += scale * (transposed ? products[m * kRefinedOrders + n]
                                      : products[n * kRefinedOrders + m]);
    }
  }

  const RefinedData& data_;
  const TermSpace& space_;
  std::span<const PhoneDominance> dominance_;
  std::span<const float> weight_;
  std::size_t n_, k_;
  std::vector<double> column_sums_, target_sums_;  // rows of the sentences that wait, scaled
  std::size_t waiting_ = 0;
  double frames_ = 0;     // weights of the sentence
  std::size_t used_ = 0;  // its frames that have one
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> meet_;
  std::vector<Square> products_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<double> own_sum_, own_target_;
};

}  // namespace

std::size_t TermSpace::at(std::size_t term, std::uint32_t key) const {
  const Table& table = tables[term];
  const auto found = std::lower_bound(table.keys.begin(), table.keys.end(), key);
  return table.first + std::size_t(found - table.keys.begin()) * kTermInfo[term].orders;
}

bool TermSpace::holds(std::size_t term, const TermUse& use) const {
  const Table& table = tables[term];
  return use.scale != 0 && std::binary_search(table.keys.begin(), table.keys.end(), use.key);
}

void TermSpace::number() {
  size = 0;
  for (std::size_t t = 0; t < kTermCount; ++t) {
    tables[t].first = size;
    size += tables[t].keys.size() * kTermInfo[t].orders;
  }
}

namespace {

using KeyCounts = std::map<std::uint32_t, std::size_t>;

/// Leaves the `most` most frequent keys that have `least` examples; of equals the lower ones.
void thin_out(KeyCounts& counts, std::size_t least, std::size_t most) {
  std::vector<std::pair<std::size_t, std::uint32_t>> order;
  for (const auto& [key, count] : counts)
    if (count >= least) order.emplace_back(count, key);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  order.resize(std::min(order.size(), most));
  counts.clear();
  for (const auto& [count, key] : order) counts[key] = count;
}

}  // namespace

TermSpace term_space(const RefinedData& data) {
  std::array<KeyCounts, kTermCount> keys;
  for (const Neighbourhood& here : data.around) {
    const auto uses = terms_of(data.phones, here);
    for (std::size_t t = 0; t < kTermCount; ++t)
      if ((data.terms >> t & 1) != 0 && uses[t].scale != 0) ++keys[t][uses[t].key];
  }
  thin_out(keys[std::size_t(RefinedTerm::triphone)], kLeastTriphones, kMostTriphones);
  TermSpace space;
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (const auto& [key, count] : keys[t]) space.tables[t].keys.push_back(key);
  space.number();
  return space;
}

void CurveSums::add(const CurveSums& other) {
  for (std::size_t i = 0; i < gram.rows(); ++i) {
    const auto to = gram.below(i);
    const auto from = other.gram.below(i);
    for (std::size_t j = 0; j < to.size(); ++j) to[j] += from[j];
  }
  for (std::size_t i = 0; i < right.size(); ++i) right[i] += other.right[i];
  for (std::size_t i = 0; i < energy.size(); ++i) energy[i] += other.energy[i];
  frames += other.frames;
}

CurveSums sum_curves(const RefinedData& data, const TermSpace& space,
                     std::span<const PhoneDominance> dominance, std::span<const float> weight) {
  const std::size_t count = data.speech->sentences.size();
  std::vector<CurveSums> parts(std::min(kCurveParts, count));
  parallel_for(parts.size(), data.threads, [&](std::size_t p) {
    Summer summer(data, space, dominance, weight);
    for (std::size_t s = p * count / parts.size(); s < (p + 1) * count / parts.size(); ++s)
      summer.add(data.speech->sentences[s]);
    summer.flush();
    parts[p] = std::move(summer.sums);
  });
  for (std::size_t p = 1; p < parts.size(); ++p) parts[0].add(parts[p]);
  return std::move(parts[0]);
}

std::vector<double> ridge_of(const TermSpace& space, double factor) {
  std::vector<double> ridge(space.size);
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t row = 0; row < space.tables[t].keys.size(); ++row)
      for (std::size_t m = 0; m < kTermInfo[t].orders; ++m)
        ridge[space.tables[t].first + row * kTermInfo[t].orders + m] =
            factor * kTermInfo[t].ridge[m];
  return ridge;
}

std::vector<double> solve_curves(const CurveSums& sums, const TermSpace& space,
                                 std::size_t controls, double ridge_factor, int threads,
                                 SquareMatrix& work) {
  const std::size_t n = space.size;
  if (work.rows() != n) work = SquareMatrix(n);
  std::vector<double> ridge = ridge_of(space, ridge_factor);
  double lift = 0;
  for (int attempt = 0; attempt < 12; ++attempt) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto below = sums.gram.below(i);
      std::copy(below.begin(), below.end(), work.below(i).begin());
      work[i * n + i] += ridge[i] + lift;
    }
    if (cholesky_in_place(work.values(), n, threads)) {
      std::vector<double> curves = sums.right;
      cholesky_solve(work.values(), n, curves, controls, threads);
      return curves;
    }
    lift = lift == 0 ? 1e-6 : lift * 10;
  }
  return std::vector<double>(n * controls, 0.0);
}

std::vector<double> errors_of(const CurveSums& sums, const std::vector<double>& curves,
                              std::size_t controls) {
  const std::size_t n = sums.right.size() / controls;
  const std::vector<double> product = multiply_symmetric({sums.gram.data(), n * n}, n, curves);
  std::vector<double> squares(controls), along(controls);
  for (std::size_t i = 0; i < n * controls; ++i) {
    squares[i % controls] += curves[i] * product[i];
    along[i % controls] += curves[i] * sums.right[i];
  }
  std::vector<double> errors = sums.energy;
  for (std::size_t c = 0; c < controls; ++c) errors[c] += squares[c] - 2 * along[c];
  return errors;
}

}  // namespace animeme::dam

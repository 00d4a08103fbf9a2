#include "dam/kinds/refined/curves_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <map>

#include "dam/maths/cholesky.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t kCurveParts = 2;   // each needs a matrix of all unknowns
constexpr Eigen::Index kSentences = 64;  // whose sums are taken off together

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
        n_(Eigen::Index(space.size)),
        k_(Eigen::Index(data.controls)),
        column_sums_(RowMatrix::Zero(kSentences, n_)),
        target_sums_(RowMatrix::Zero(kSentences, k_)) {
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
    for (Eigen::Index c = 0; c < k_; ++c)
      sums.energy[std::size_t(c)] -= share * target_sums_(waiting_, c) * target_sums_(waiting_, c);
    sums.frames += used_;
    column_sums_.row(waiting_) *= std::sqrt(share);
    target_sums_.row(waiting_) *= std::sqrt(share);
    if (++waiting_ == kSentences) flush();
  }

  /// Takes off the products of sums of the sentences since the last time.
  void flush() {
    if (waiting_ == 0) return;
    Eigen::Map<Eigen::MatrixXd> gram(sums.gram.data(), n_, n_);
    Eigen::Map<RowMatrix> right(sums.right.data(), n_, k_);
    const auto columns = column_sums_.topRows(waiting_);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose(), -1);
    right.noalias() -= columns.transpose() * target_sums_.topRows(waiting_);
    column_sums_.setZero();
    target_sums_.setZero();
    waiting_ = 0;
  }

  CurveSums sums;

 private:
  using Square = Eigen::Matrix<double, kRefinedOrders, kRefinedOrders>;

  /// Products of the weighted polynomials of every two occurrences that meet, their sums, and their
  /// products with the target: small numbers, from which all terms follow.
  void collect(const FitSentence& sentence, const RefinedDesign& design) {
    const std::size_t count = sentence.occurrences;
    meet_.assign(count, {});
    products_.clear();
    pairs_.clear();
    own_sum_.assign(count * kRefinedOrders, 0.0);
    own_target_ = RowMatrix::Zero(Eigen::Index(count * kRefinedOrders), k_);
    frames_ = 0;
    used_ = 0;
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      const std::size_t frame = sentence.first_frame + i;
      const double weight = weight_[frame];
      if (weight == 0) continue;
      ++used_;
      frames_ += weight;
      const Eigen::Map<const Eigen::RowVectorXd> y(&data_.target[frame * data_.controls], k_);
      for (Eigen::Index c = 0; c < k_; ++c) sums.energy[std::size_t(c)] += weight * y[c] * y[c];
      target_sums_.row(waiting_) += weight * y;
      add_frame(sentence, design.frame(i), y, weight);
    }
  }

  void add_frame(const FitSentence& sentence, std::span<const RefinedPart> parts,
                 const Eigen::Map<const Eigen::RowVectorXd>& y, double weight) {
    for (const RefinedPart& a : parts) {
      const std::size_t ja = a.occurrence - sentence.first_occurrence;
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double x = weight * a.weight * a.basis[m];
        own_sum_[ja * kRefinedOrders + m] += x;
        own_target_.row(Eigen::Index(ja * kRefinedOrders + m)) += x * y;
      }
      for (const RefinedPart& b : parts) {
        const std::size_t jb = b.occurrence - sentence.first_occurrence;
        if (jb > ja) continue;
        const double w = weight * a.weight * b.weight;
        Square& square = products_[slot_of(ja, jb)];
        for (std::size_t n = 0; n < kRefinedOrders; ++n)
          for (std::size_t m = 0; m < kRefinedOrders; ++m)
            square(Eigen::Index(m), Eigen::Index(n)) += w * a.basis[m] * b.basis[n];
      }
    }
  }

  /// Place in products_ of two occurrences that meet. A phone meets some ten others.
  std::size_t slot_of(std::size_t a, std::size_t b) {
    for (const auto& [other, slot] : meet_[a])
      if (other == b) return slot;
    meet_[a].emplace_back(b, products_.size());
    products_.push_back(Square::Zero());
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
          column_sums_(waiting_, Eigen::Index(t.first + m)) +=
              t.scale * own_sum_[j * kRefinedOrders + m];
          Eigen::Map<Eigen::RowVectorXd>(&sums.right[(t.first + m) * data_.controls], k_) +=
              t.scale * own_target_.row(Eigen::Index(j * kRefinedOrders + m));
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
        out[m] += scale * (transposed ? products(Eigen::Index(n), Eigen::Index(m))
                                      : products(Eigen::Index(m), Eigen::Index(n)));
    }
  }

  const RefinedData& data_;
  const TermSpace& space_;
  std::span<const PhoneDominance> dominance_;
  std::span<const float> weight_;
  Eigen::Index n_, k_;
  RowMatrix column_sums_, target_sums_;  // of the sentences that wait, scaled
  Eigen::Index waiting_ = 0;
  double frames_ = 0;     // weights of the sentence
  std::size_t used_ = 0;  // its frames that have one
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> meet_;
  std::vector<Square> products_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<double> own_sum_;
  RowMatrix own_target_;
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
  const auto n = Eigen::Index(sums.right.size() / controls);
  const auto k = Eigen::Index(controls);
  const Eigen::Map<const Eigen::MatrixXd> gram(sums.gram.data(), n, n);
  const Eigen::Map<const RowMatrix> a(curves.data(), n, k);
  const Eigen::Map<const RowMatrix> right(sums.right.data(), n, k);
  const RowMatrix product = gram.selfadjointView<Eigen::Lower>() * a;
  std::vector<double> errors = sums.energy;
  for (Eigen::Index c = 0; c < k; ++c)
    errors[std::size_t(c)] += a.col(c).dot(product.col(c)) - 2 * a.col(c).dot(right.col(c));
  return errors;
}

}  // namespace animeme::dam

// What is inside TrainingSums. Internal. See dam/training/accumulate.h for what the sums are for.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dam/corpus/statistics_internal.h"
#include "dam/corpus/train_options.h"
#include "dam/kinds/refined/curves_fit.h"
#include "dam/model/model.h"
#include "dam/training/fixed_sum_internal.h"

namespace animeme::dam {

/// Triphones are left out: which of them are frequent is known when all sentences are.
inline constexpr std::uint32_t kSummedTerms =
    kAllTerms & ~(std::uint32_t(1) << unsigned(RefinedTerm::triphone));

/// What must not change while sums are taken. Phones are all of phones.h, by label; of PhoneModel,
/// label, class and (usual) duration count.
struct SumsBase {
  double pause_edge = 0.3;
  RefinedParameters refined;  ///< margin, exponent and dominance; no tables
  double offset_frames = 10;
  std::vector<PhoneModel> phones;

  friend bool operator==(const SumsBase&, const SumsBase&) = default;
};

/// One control: over the frames of speech, and over those of rest.
struct ControlSums {
  std::string name;
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  FixedSum sum, squares, rest_sum;
};

struct PhoneSums {
  std::uint64_t examples = 0;
  FixedSum log_duration;
  double longest = 0;
};

/// ShutSums, exactly.
struct ShutTotals {
  std::uint64_t count = 0;
  FixedSum phone, shut, phone_squared, both;

  void add(const ShutSums& sentence);
  void add(const ShutTotals& other);
  ShutSums values() const;
};

/// How often values fell into bins of kBin units; bounded, so that parts add up.
class Histogram {
 public:
  static constexpr double kBin = 0.5, kMost = 1024;
  static constexpr std::int32_t kLastBin = std::int32_t(kMost / kBin);

  void add(double value);
  void add(const Histogram& other);
  /// The bin of the upper median; none with fewer than kFewContacts values.
  std::optional<double> median() const;

  std::map<std::int32_t, std::uint64_t> counts;  ///< number of the bin: value / kBin, rounded
};

/// The lower triangle of a symmetric matrix that grows: rows stay where they are.
class Triangle {
 public:
  SmallFixedSum& at(std::size_t a, std::size_t b) { return values_[place(a, b)]; }
  SmallFixedSum at(std::size_t a, std::size_t b) const { return values_[place(a, b)]; }
  void grow(std::size_t rows) { values_.resize(rows * (rows + 1) / 2); }

 private:
  static std::size_t place(std::size_t a, std::size_t b) {
    return a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a;
  }
  std::vector<SmallFixedSum> values_;
};

/// Normal equations in the units of the controls. Behind the controls there is one more column, of
/// ones: its right side is what a change of all targets by a constant adds. Unknowns have a row in
/// the order in which they came (SumsState::rows), so that a sentence with new ones costs no more
/// than itself.
struct FitSums {
  std::uint64_t sentences = 0, frames = 0;
  SmallFixedSum bound;  ///< no number of `gram` is larger: sum of the largest of each sentence
  Triangle gram;
  std::vector<FixedSum> right;   ///< rows x (controls + 1), row by row
  std::vector<FixedSum> energy;  ///< per control, and of the column of ones
  std::vector<FixedSum> level;   ///< per control: product with the column of ones
};

/// The same of one sentence, in the order of its own space.
struct SentenceSums {
  TermSpace space;
  CurveSums curves;           ///< for controls + 1 columns
  std::vector<double> level;  ///< as FitSums::level

  /// The largest number of the matrix, which has no negative squares: on its diagonal.
  double largest() const;
};

struct SumsState {
  SumsBase base;
  fap::Rate rate;
  std::uint64_t speech_frames = 0, rest_frames = 0;
  std::vector<ControlSums> controls;
  std::vector<PhoneSums> phones;  ///< as base.phones
  Histogram closures, lip_tooth;
  ShutTotals shut;
  /// Identifier and digest of every sentence. Merged parts may have two contents under one id.
  std::set<std::pair<std::string, std::uint64_t>> sentences;
  TermSpace space;                ///< of both sets
  std::vector<std::size_t> rows;  ///< of each unknown of `space`, in both sets
  FitSums kept, held;
};

/// What adding and merging refuse.
inline Error refused(const std::string& what) { return make_error(Code::invalid_argument, what); }

/// Every phone of phones.h, sorted by label, with start values.
SumsBase start_base();

/// Of all of a sentence that is learned from: identifier, phones, curves.
std::uint64_t sentence_digest(const Utterance& sentence);

/// TrainingSums::add() of a sentence whose glitches are out; `digest`: of the sentence as it came.
Result<bool> add_to_sums(SumsState& state, const Utterance& sentence, std::uint64_t digest);

/// The controls and the rate of the first sentence or part.
void set_controls(SumsState& state, const std::vector<std::string>& names, fap::Rate rate);

/// Makes room for more unknowns: the union of both spaces.
void widen(SumsState& state, const TermSpace& space);

/// Whether exact sums have room for a sentence: its numbers are not absurdly large.
bool fits(const SentenceSums& sentence, const FitSums& to);
/// The same of other sums.
bool fits(const FitSums& from, const FitSums& to);

/// Adds a sentence to one of the sets of `state`, whose space must have all unknowns.
void add_sentence_sums(const SentenceSums& from, const SumsState& state, FitSums& to);

/// Adds a set of another state.
void add_fit(const FitSums& from, const SumsState& from_state, const SumsState& state, FitSums& to);

}  // namespace animeme::dam

#include "dam/training/training_sums_internal.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "dam/corpus/statistics_internal.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

/// Where the unknowns of one space are in another that has them all.
std::vector<std::size_t> places_in(const TermSpace& from, const TermSpace& to) {
  std::vector<std::size_t> places(from.size);
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t row = 0; row < from.tables[t].keys.size(); ++row)
      for (std::size_t m = 0; m < kTermInfo[t].orders; ++m)
        places[from.tables[t].first + row * kTermInfo[t].orders + m] =
            to.at(t, from.tables[t].keys[row]) + m;
  return places;
}

/// Makes room for `rows` unknowns.
void grow(FitSums& fit, std::size_t rows, std::size_t columns) {
  fit.gram.grow(rows);
  fit.right.resize(rows * columns);
  fit.energy.resize(columns);
  fit.level.resize(columns - 1);
}

template <class Number>
void add(std::span<const Number> from, std::span<FixedSum> to) {
  for (std::size_t i = 0; i < from.size(); ++i) to[i].add(from[i]);
}

bool small_sums(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double v) { return std::abs(v) <= FixedSum::kMost; });
}

}  // namespace

void Histogram::add(double value) {
  const double bin = std::round(std::clamp(value, -kMost, kMost) / kBin);
  ++counts[std::int32_t(bin)];
}

void Histogram::add(const Histogram& other) {
  for (const auto& [bin, count] : other.counts) counts[bin] += count;
}

std::optional<double> Histogram::median() const {
  std::uint64_t total = 0, below = 0;
  for (const auto& [bin, count] : counts) total += count;
  if (total < kFewContacts) return std::nullopt;
  for (const auto& [bin, count] : counts) {
    below += count;
    if (below > total / 2) return bin * kBin;
  }
  return std::nullopt;
}

void ShutTotals::add(const ShutSums& sentence) {
  count += std::uint64_t(sentence.count);
  phone.add(sentence.phone);
  shut.add(sentence.shut);
  phone_squared.add(sentence.phone_squared);
  both.add(sentence.both);
}

void ShutTotals::add(const ShutTotals& other) {
  count += other.count;
  phone.add(other.phone);
  shut.add(other.shut);
  phone_squared.add(other.phone_squared);
  both.add(other.both);
}

ShutSums ShutTotals::values() const {
  return {double(count), phone.value(), shut.value(), phone_squared.value(), both.value()};
}

SumsBase start_base() {
  SumsBase base;
  for (const PhoneInfo& info : phones()) {
    PhoneModel phone;
    phone.label = info.label;
    phone.context_class = context_class_of(info.label);
    base.phones.push_back(phone);
  }
  std::sort(base.phones.begin(), base.phones.end(),
            [](const PhoneModel& a, const PhoneModel& b) { return a.label < b.label; });
  base.refined.dominance.resize(base.phones.size());
  return base;
}

void set_controls(SumsState& state, const std::vector<std::string>& names, fap::Rate rate) {
  for (const std::string& name : names) state.controls.emplace_back().name = name;
  state.rate = rate;
}

double SentenceSums::largest() const {
  double largest = 0;
  for (std::size_t i = 0; i < space.size; ++i) largest = std::max(largest, curves.gram.at(i, i));
  return largest;
}

bool fits(const SentenceSums& sentence, const FitSums& to) {
  return small_sums(sentence.curves.right) && small_sums(sentence.curves.energy) &&
         small_sums(sentence.level) &&
         to.bound.value() + sentence.largest() <= SmallFixedSum::kMost;
}

bool fits(const FitSums& from, const FitSums& to) {
  return to.bound.value() + from.bound.value() <= SmallFixedSum::kMost;
}

void add_sentence_sums(const SentenceSums& from, const SumsState& state, FitSums& to) {
  const auto places = places_in(from.space, state.space);
  const std::size_t n = places.size(), columns = to.energy.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t row = state.rows[places[i]];
    const auto below = from.curves.gram.below(i);
    for (std::size_t j = i; j < n; ++j) to.gram.at(row, state.rows[places[j]]).add(below[j - i]);
    add(std::span(from.curves.right).subspan(i * columns, columns),
        std::span(to.right).subspan(row * columns, columns));
  }
  add(std::span(from.curves.energy), to.energy);
  add(std::span(from.level), to.level);
  to.bound.add(from.largest());
  to.frames += from.curves.frames;
  ++to.sentences;
}

void add_fit(const FitSums& from, const SumsState& from_state, const SumsState& state,
             FitSums& to) {
  const auto places = places_in(from_state.space, state.space);
  const std::size_t n = places.size(), columns = to.energy.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t out = state.rows[places[i]], in = from_state.rows[i];
    for (std::size_t j = i; j < n; ++j)
      to.gram.at(out, state.rows[places[j]]).add(from.gram.at(in, from_state.rows[j]));
    add(std::span(from.right).subspan(in * columns, columns),
        std::span(to.right).subspan(out * columns, columns));
  }
  add(std::span(from.energy), to.energy);
  add(std::span(from.level), to.level);
  to.bound.add(from.bound);
  to.frames += from.frames;
  to.sentences += from.sentences;
}

void widen(SumsState& state, const TermSpace& space) {
  TermSpace all;
  for (std::size_t t = 0; t < kTermCount; ++t) {
    const auto &a = state.space.tables[t].keys, &b = space.tables[t].keys;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all.tables[t].keys));
  }
  all.number();
  constexpr std::size_t kNone = ~std::size_t(0);
  std::vector<std::size_t> rows(all.size, kNone);
  const auto places = places_in(state.space, all);
  for (std::size_t i = 0; i < places.size(); ++i) rows[places[i]] = state.rows[i];
  std::size_t next = places.size();
  for (std::size_t& row : rows)
    if (row == kNone) row = next++;
  for (FitSums* fit : {&state.kept, &state.held}) grow(*fit, all.size, state.controls.size() + 1);
  state.space = std::move(all);
  state.rows = std::move(rows);
}

}  // namespace animeme::dam

#include "dam/training/training_sums_internal.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "dam/corpus/statistics_internal.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

/// Where the unknowns of one space are in another that has them all. Ascending, as keys are.
std::vector<std::size_t> places_in(const TermSpace& from, const TermSpace& to) {
  std::vector<std::size_t> places(from.size);
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t row = 0; row < from.tables[t].keys.size(); ++row)
      for (std::size_t m = 0; m < kTermInfo[t].orders; ++m)
        places[from.tables[t].first + row * kTermInfo[t].orders + m] =
            to.at(t, from.tables[t].keys[row]) + m;
  return places;
}

FitSums zero_fit(std::size_t unknowns, std::size_t columns) {
  FitSums fit;
  fit.curves.gram.assign(unknowns * unknowns, 0.0);
  fit.curves.right.assign(unknowns * columns, 0.0);
  fit.curves.energy.assign(columns, 0.0);
  fit.level.assign(columns - 1, 0.0);
  return fit;
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

void add_fit(const FitSums& from, const TermSpace& from_space, FitSums& to,
             const TermSpace& to_space, std::size_t columns) {
  const auto places = places_in(from_space, to_space);
  const std::size_t n = places.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double* column = &from.curves.gram[i * n];
    double* out = &to.curves.gram[places[i] * to_space.size];
    for (std::size_t j = i; j < n; ++j) out[places[j]] += column[j];
    for (std::size_t c = 0; c < columns; ++c)
      to.curves.right[places[i] * columns + c] += from.curves.right[i * columns + c];
  }
  for (std::size_t c = 0; c < columns; ++c) to.curves.energy[c] += from.curves.energy[c];
  for (std::size_t c = 0; c + 1 < columns; ++c) to.level[c] += from.level[c];
  to.curves.frames += from.curves.frames;
  to.sentences += from.sentences;
}

void widen(SumsState& state, const TermSpace& space) {
  TermSpace all;
  for (std::size_t t = 0; t < kTermCount; ++t) {
    const auto &a = state.space.tables[t].keys, &b = space.tables[t].keys;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all.tables[t].keys));
  }
  all.number();
  const std::size_t columns = state.controls.size() + 1;
  const bool fresh = state.kept.curves.energy.empty();
  if (all.size == state.space.size && !fresh) return;
  for (FitSums* fit : {&state.kept, &state.held}) {
    FitSums wide = zero_fit(all.size, columns);
    if (!fresh) add_fit(*fit, state.space, wide, all, columns);
    *fit = std::move(wide);
  }
  state.space = std::move(all);
}

}  // namespace animeme::dam

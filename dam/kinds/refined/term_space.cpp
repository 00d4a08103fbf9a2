// Which unknowns there are, and which of them are equal.
#include <algorithm>
#include <map>
#include <utility>

#include "dam/kinds/refined/curves_fit.h"

namespace animeme::dam {
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

/// An occurrence with the scale of its term.
using Use = std::pair<std::size_t, double>;

}  // namespace

bool TermSpace::holds(std::size_t term, const TermUse& use) const {
  const Table& table = tables[term];
  return use.scale != 0 && std::binary_search(table.keys.begin(), table.keys.end(), use.key);
}

std::size_t TermSpace::row_of(std::size_t term, std::uint32_t key) const {
  const auto& keys = tables[term].keys;
  return std::size_t(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
}

std::size_t TermSpace::at(std::size_t term, std::uint32_t key) const {
  return tables[term].first + row_of(term, key) * kTermInfo[term].orders;
}

void TermSpace::number() {
  size = 0;
  for (std::size_t t = 0; t < kTermCount; ++t) {
    tables[t].first = size;
    size += tables[t].keys.size() * kTermInfo[t].orders;
  }
}

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

TermColumns own_columns(const TermSpace& space) {
  TermColumns columns;
  columns.size = space.size;
  for (std::uint32_t i = 0; i < space.size; ++i) columns.of.push_back(i);
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t row = 0; row < space.tables[t].keys.size(); ++row)
      columns.first[t].push_back(std::uint32_t(space.tables[t].first + row * kTermInfo[t].orders));
  return columns;
}

TermColumns shared_columns(const RefinedData& data, const TermSpace& space) {
  std::array<std::vector<std::vector<Use>>, kTermCount> uses_of;
  for (std::size_t t = 0; t < kTermCount; ++t) uses_of[t].resize(space.tables[t].keys.size());
  for (std::size_t j = 0; j < data.around.size(); ++j) {
    const auto uses = terms_of(data.phones, data.around[j]);
    for (std::size_t t = 0; t < kTermCount; ++t)
      if (space.holds(t, uses[t]))
        uses_of[t][space.row_of(t, uses[t].key)].emplace_back(j, uses[t].scale);
  }
  // Of equal keys the one with most orders stands for all.
  struct Standing {
    std::size_t term = 0, row = 0;
  };
  std::map<std::vector<Use>, Standing> standing;
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t row = 0; row < uses_of[t].size(); ++row) {
      const auto [at, fresh] = standing.try_emplace(uses_of[t][row], Standing{t, row});
      if (!fresh && kTermInfo[t].orders > kTermInfo[at->second.term].orders) at->second = {t, row};
    }
  TermColumns columns;
  columns.of.resize(space.size);
  for (std::size_t t = 0; t < kTermCount; ++t) {
    columns.first[t].assign(uses_of[t].size(), TermColumns::kNone);
    for (std::size_t row = 0; row < uses_of[t].size(); ++row) {
      const Standing& one = standing[uses_of[t][row]];
      if (one.term != t || one.row != row) continue;
      columns.first[t][row] = std::uint32_t(columns.size);
      columns.size += kTermInfo[t].orders;
    }
  }
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::size_t row = 0; row < uses_of[t].size(); ++row) {
      const Standing& one = standing[uses_of[t][row]];
      for (std::uint32_t m = 0; m < kTermInfo[t].orders; ++m)
        columns.of[space.tables[t].first + row * kTermInfo[t].orders + m] =
            columns.first[one.term][one.row] + m;
    }
  return columns;
}

}  // namespace animeme::dam

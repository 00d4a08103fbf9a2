#include "dam/kinds/animeme/modes.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "dam/maths/affinity.h"
#include "dam/maths/parallel.h"
#include "dam/maths/spline.h"

namespace animeme::dam {
namespace {

/// resample_points x controls values per occurrence.
std::vector<double> resample(const FitData& data, std::size_t points) {
  const std::size_t k = data.controls, width = points * k;
  std::vector<double> vectors(data.occurrences.size() * width);
  for (const FitSentence& sentence : data.sentences) {
    if (sentence.frames == 0) continue;
    for (std::size_t c = 0; c < k; ++c) {
      std::vector<double> samples(sentence.frames);
      for (std::size_t i = 0; i < sentence.frames; ++i)
        samples[i] = data.target[(sentence.first_frame + i) * k + c];
      const Spline spline(std::move(samples));
      for (std::size_t j = 0; j < sentence.occurrences; ++j) {
        const std::size_t index = sentence.first_occurrence + j;
        const FitOccurrence& o = data.occurrences[index];
        for (std::size_t p = 0; p < points; ++p) {
          const double t = o.start + o.duration * double(p) / double(points - 1);
          vectors[index * width + p * k + c] = spline(t * data.rate);
        }
      }
    }
  }
  return vectors;
}

double squared_distance(const double* a, const double* b, std::size_t n) {
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// Drops the exemplars of fewer than kSmallestMode points, the smallest first.
void drop_small(const Clusters& clusters, std::vector<std::size_t>& exemplars) {
  exemplars = clusters.exemplars;
  std::vector<std::size_t> members(exemplars.size(), 0);
  for (const std::size_t c : clusters.label) ++members[c];
  while (exemplars.size() > 1) {
    const auto least = std::min_element(members.begin(), members.end());
    if (*least >= kSmallestMode) return;
    exemplars.erase(exemplars.begin() + (least - members.begin()));
    members.erase(least);
  }
}

/// Mode of each of `members` (indices of occurrences), numbered from 0.
std::vector<std::size_t> cluster(const std::vector<double>& vectors, std::size_t width,
                                 const std::vector<std::size_t>& members,
                                 const AnimemeOptions& options) {
  std::vector<std::size_t> label(members.size(), 0);
  if (!options.modes || members.size() < std::size_t(options.mode_examples)) return label;
  const std::size_t n = std::min(members.size(), std::size_t(options.affinity_limit));
  const auto point = [&](std::size_t i) {  // evenly spread over the corpus
    return &vectors[members[i * members.size() / n] * width];
  };
  std::vector<double> similarity(n * n, 0.0);
  double smallest = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double s = -squared_distance(point(i), point(j), width);
      similarity[i * n + j] = similarity[j * n + i] = s;
      smallest = std::min(smallest, s);
    }
  if (smallest == 0) return label;  // all alike
  const Clusters clusters = affinity_propagation(similarity, options.preference * smallest,
                                                 {options.damping, options.affinity_iterations});
  std::vector<std::size_t> exemplars;
  drop_small(clusters, exemplars);
  for (std::size_t i = 0; i < members.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < exemplars.size(); ++c) {
      const double d = squared_distance(&vectors[members[i] * width], point(exemplars[c]), width);
      if (d < nearest) {
        nearest = d;
        label[i] = c;
      }
    }
  }
  return label;
}

}  // namespace

ModeTable find_modes(FitData& data, std::size_t phones, const AnimemeOptions& options,
                     int threads) {
  std::vector<std::vector<std::size_t>> members(phones), labels(phones);
  for (std::size_t j = 0; j < data.occurrences.size(); ++j)
    members[std::size_t(data.occurrences[j].phone)].push_back(j);
  const auto points = std::size_t(options.resample_points);
  const std::vector<double> vectors =
      options.modes ? resample(data, points) : std::vector<double>{};
  parallel_for(phones, threads, [&](std::size_t p) {
    labels[p] = cluster(vectors, points * data.controls, members[p], options);
  });
  ModeTable table{{0}};
  for (std::size_t p = 0; p < phones; ++p) {
    std::size_t count = 1;
    for (std::size_t i = 0; i < members[p].size(); ++i) {
      data.occurrences[members[p][i]].mode = std::uint32_t(table.first[p] + labels[p][i]);
      count = std::max(count, labels[p][i] + 1);
    }
    table.first.push_back(table.first[p] + count);
  }
  return table;
}

void count_contexts(const FitData& data, const ModeTable& table,
                    std::vector<AnimemePhone>& phones) {
  using Key = std::tuple<std::int32_t, std::int32_t, std::uint32_t>;
  std::vector<std::map<Key, std::uint32_t>> counts(phones.size());
  for (const FitOccurrence& o : data.occurrences) {
    const auto p = std::size_t(o.phone);
    ++counts[p][{o.left, o.right, o.mode - std::uint32_t(table.first[p])}];
  }
  for (std::size_t p = 0; p < phones.size(); ++p) {
    phones[p].modes.resize(table.of(std::int32_t(p)));
    phones[p].contexts.clear();
    for (const auto& [key, count] : counts[p])
      phones[p].contexts.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key), count});
  }
}

}  // namespace animeme::dam

#include "dam/crossmap/key_shapes.h"

#include <algorithm>
#include <cmath>

#include "dam/maths/affinity.h"

namespace animeme::dam {
namespace {

constexpr int kHalvings = 14;

struct KeyCandidate {
  std::size_t track = 0, frame = 0;
};

Result<void> check_key_options(std::span<const PointTrack> tracks, std::span<const double> weights,
                               const KeyShapeOptions& options) {
  if (auto ok = check_tracks(tracks); !ok) return ok;
  const auto refuse = [](const char* text) { return make_error(Code::invalid_argument, text); };
  if (options.count > 200) return refuse("more than 200 key shapes are too many to adjust");
  if (!(options.damping >= 0.5 && options.damping <= 0.99)) {
    return refuse("the damping of affinity propagation must be 0.5 to 0.99");
  }
  if (options.most_frames < 2 || options.most_frames > 4000) {
    return refuse("2 to 4000 frames can be compared");
  }
  if (options.preference && !std::isfinite(*options.preference)) {
    return refuse("the preference of affinity propagation must be a number, usually below 0");
  }
  if (weights.empty()) return {};
  if (weights.size() != tracks.front().names.size()) return refuse("each point has one weight");
  double sum = 0;
  for (const double weight : weights) {
    if (!(weight >= 0)) return refuse("weights of points must be 0 or more");
    sum += weight;
  }
  if (!(sum > 0 && std::isfinite(sum))) return refuse("at least one point needs a weight above 0");
  return {};
}

bool all_seen(const PointTrack& track, std::size_t frame, std::span<const double> weights) {
  for (std::size_t p = 0; p < track.names.size(); ++p) {
    if ((weights.empty() || weights[p] > 0) && !track.seen(frame, p)) return false;
  }
  return true;
}

std::vector<KeyCandidate> candidates_of(std::span<const PointTrack> tracks,
                                        std::span<const double> weights, std::size_t most) {
  std::vector<KeyCandidate> all;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (std::size_t i = 0; i < tracks[t].frames(); ++i) {
      if (all_seen(tracks[t], i, weights)) all.push_back({t, i});
    }
  }
  const std::size_t every = (all.size() + most - 1) / std::max<std::size_t>(most, 1);
  if (every <= 1) return all;
  std::vector<KeyCandidate> some;
  for (std::size_t i = 0; i < all.size(); i += every) some.push_back(all[i]);
  return some;
}

std::vector<double> similarities(std::span<const PointTrack> tracks,
                                 const std::vector<KeyCandidate>& frames,
                                 std::span<const double> weights) {
  const std::size_t dimensions = tracks.front().dimensions;
  std::vector<std::vector<double>> shapes;
  for (const KeyCandidate& c : frames) {
    const auto shape = tracks[c.track].frame(c.frame);
    std::vector<double>& weighed = shapes.emplace_back();
    for (std::size_t k = 0; k < shape.size(); ++k) {
      const double weight = weights.empty() ? 1 : weights[k / dimensions];
      weighed.push_back(weight > 0 ? weight * shape[k] : 0);
    }
  }
  const std::size_t n = frames.size();
  std::vector<double> out(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < shapes[i].size(); ++k) {
        const double step = shapes[i][k] - shapes[j][k];
        sum += step * step;
      }
      out[i * n + j] = out[j * n + i] = -sum;
    }
  }
  return out;
}

// Of all pairs of two different frames.
double median_similarity(const std::vector<double>& similarity, std::size_t n) {
  std::vector<double> pairs;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) pairs.push_back(similarity[i * n + j]);
  }
  if (pairs.empty()) return -1;
  const auto middle = pairs.begin() + std::ptrdiff_t(pairs.size() / 2);
  std::nth_element(pairs.begin(), middle, pairs.end());
  return *middle;
}

struct FoundClusters {
  Clusters clusters;
  double preference = 0;
};

// The number of clusters falls with the preference, by and large: exponents are halved.
FoundClusters with_count(const std::vector<double>& similarity, std::size_t n, double median,
                         std::size_t count, const AffinityOptions& options) {
  const double scale = median < 0 ? -median : 1;
  double many = std::log(scale * 1e-3), few = std::log(scale * double(n) * 10);
  const auto miss = [&](const Clusters& c) {
    return c.exemplars.size() > count ? c.exemplars.size() - count : count - c.exemplars.size();
  };
  FoundClusters best;
  for (int round = 0; round < kHalvings; ++round) {
    const double middle = (many + few) / 2;
    FoundClusters found{affinity_propagation(similarity, -std::exp(middle), options),
                        -std::exp(middle)};
    (found.clusters.exemplars.size() > count ? many : few) = middle;
    const bool better = round == 0 || miss(found.clusters) < miss(best.clusters) ||
                        (miss(found.clusters) == miss(best.clusters) && found.clusters.converged &&
                         !best.clusters.converged);
    if (better) best = std::move(found);
    if (miss(best.clusters) == 0 && best.clusters.converged) break;
  }
  return best;
}

}  // namespace

Result<KeyFrames> find_key_frames(std::span<const PointTrack> tracks,
                                  std::span<const double> weights, const KeyShapeOptions& options) {
  if (auto ok = check_key_options(tracks, weights, options); !ok) return ok.error();
  const std::vector<KeyCandidate> frames = candidates_of(tracks, weights, options.most_frames);
  const std::size_t n = frames.size();
  if (n == 0) {
    return make_error(Code::not_found,
                      "there is no frame in which all points are seen; leave out points that are "
                      "missing all the time");
  }
  const std::vector<double> similarity = similarities(tracks, frames, weights);
  const double median = median_similarity(similarity, n);
  const AffinityOptions affinity{.damping = options.damping};
  FoundClusters found;
  if (options.count > 0) {
    found = with_count(similarity, n, median, options.count, affinity);
  } else {
    found.preference = options.preference.value_or(median);
    found.clusters = affinity_propagation(similarity, found.preference, affinity);
  }
  KeyFrames out{{}, n, found.preference, found.clusters.converged || n == 1};
  for (const std::size_t k : found.clusters.exemplars) {
    out.keys.push_back({frames[k].track, frames[k].frame, 0});
  }
  for (const std::size_t label : found.clusters.label) out.keys[label].share += 1 / double(n);
  return out;
}

}  // namespace animeme::dam

#include "codec/encode/trellis_internal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "codec/encode/clip_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

constexpr int kReach = 3;                    // levels on each side of the nearest one
constexpr int kStates = 2 * kReach + 1 + 1;  // one more, never taken: eight fill two registers
constexpr int kDifferences = 2 * kStates - 1;
constexpr int kRounds = 5;             // of search and counting
constexpr double kHardlyLess = 0.998;  // of the cost, where another round is not worth its time
constexpr float kNever = 1e30F;

// Four states, by an extension that g++ and clang++ share.
using F4 = float __attribute__((vector_size(16)));

F4 load4(const float* from) {
  F4 out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
F4 splat(float value) { return F4{value, value, value, value}; }
F4 smaller(F4 a, F4 b) { return a < b ? a : b; }

std::span<const std::int32_t> part(std::span<const std::int32_t> row,
                                   std::span<const std::size_t> begins, std::size_t run) {
  const std::size_t end = run + 1 < begins.size() ? begins[run + 1] : row.size();
  return row.subspan(begins[run], end - begins[run]);
}

double wanted(const TrellisProblem& problem, std::size_t plane) {
  return problem.b.empty() ? problem.a[plane] : (double(problem.a[plane]) + problem.b[plane]) * 0.5;
}

// Sum of squared differences.
double squares(std::span<const std::int32_t> values, const std::vector<std::int32_t>& levels,
               std::int32_t step) {
  double sum = 0;
  for (std::size_t plane = 0; plane < levels.size(); ++plane) {
    const double error = double(values[plane]) - double(levels[plane]) * step;
    sum += error * error;
  }
  return sum;
}

// Bits and error of levels that are given.
void measure(const TrellisProblem& problem, TrellisResult& row) {
  row.bits = 0;
  row.fits = true;
  for (std::size_t run = 0; run < problem.run_begin.size(); ++run) {
    const RunCost cost = run_cost(part(row.levels, problem.run_begin, run), problem.scale);
    row.bits += cost.bits;
    row.fits &= cost.fits;
  }
  row.error = squares(problem.a, row.levels, problem.step);
  if (!problem.b.empty()) row.error += squares(problem.b, row.levels, problem.step);
  row.error /= problem.unit * problem.unit;
}

struct Limit {
  int up = kMaxRange;
  int down = kMaxRange;
};

// What each difference of a run would cost, lambda included.
class Rates {
 public:
  // `limit`: largest range numbers allowed, upwards and downwards.
  void make(std::span<const std::int32_t> levels, int scale, double lambda, const Limit& limit) {
    const RunCost ranges = run_ranges(levels, scale);
    low_ = -level_range(std::min<int>(ranges.range[kPredictiveMin], limit.down), scale);
    high_ = level_range(std::min<int>(ranges.range[kPredictiveMax], limit.up), scale);
    histogram_.count(levels, low_, high_);
    const std::uint32_t n = std::uint32_t(high_ - low_ + 1);
    const Bits total = log2_of(histogram_.total() + n);
    const float of_none = float(lambda * double(total) / double(kOneBit));
    cost_.assign(n + 2 * kDifferences, kNever);
    float* cost = cost_.data() + kDifferences;
    for (std::int32_t level = low_; level <= high_; ++level) {
      const std::uint32_t count = histogram_[level];
      *cost++ = count == 0 ? of_none
                           : float(lambda * double(total - log2_of(count + 1)) / double(kOneBit));
    }
  }
  // Costs of kDifferences differences from `level` on.
  const float* from(std::int64_t level) const {
    const std::int64_t last = std::int64_t(cost_.size()) - kDifferences;
    return cost_.data() + std::clamp<std::int64_t>(level - low_ + kDifferences, 0, last);
  }

 private:
  std::int32_t low_ = 0;
  std::int32_t high_ = 0;
  Histogram histogram_;
  std::vector<float> cost_;  // with differences that cannot be coded on both sides
};

// The search through time.
class Search {
 public:
  explicit Search(const TrellisProblem& problem) : problem_(problem) {
    const std::size_t planes = problem.a.size();
    centre_.resize(planes);
    rest_.resize(planes);
    cost_.resize(planes);
    // Two rows are as far from a level as their mean is twice, and a constant.
    weight_ = splat(problem.b.empty() ? 1 : 2);
    const double by_step = 1.0 / problem.step;
    const double by_unit = 1 / problem.unit;
    for (std::size_t plane = 0; plane < planes; ++plane) {
      const double value = wanted(problem, plane);
      const double level = value * by_step;
      centre_[plane] = std::int32_t(level < 0 ? level - 0.5 : level + 0.5);
      rest_[plane] = float((value - double(centre_[plane]) * problem.step) * by_unit);
    }
    std::array<float, kStates> offset{};
    for (int state = 0; state < kStates; ++state) {
      offset[std::size_t(state)] = float((state - kReach) * problem.step * by_unit);
    }
    offset.back() = 1e15F;  // whose square is kNever
    offset_[0] = load4(offset.data());
    offset_[1] = load4(offset.data() + 4);
  }

  // The best levels at the rates that `levels` imply; false if there are none in range.
  bool improve(std::vector<std::int32_t>& levels, double lambda, const Limit& limit) {
    for (std::size_t run = 0; run < problem_.run_begin.size(); ++run) {
      const auto run_levels = part(levels, problem_.run_begin, run);
      rates_.make(run_levels, problem_.scale, lambda, limit);
      const std::size_t first = problem_.run_begin[run];
      const std::size_t end = first + run_levels.size();
      if (!forward(first, end)) return false;
      back(first, end, levels);
    }
    return true;
  }

 private:
  using States = std::array<float, kStates>;

  static std::size_t cheapest(const States& cost) {
    return std::size_t(std::min_element(cost.begin(), cost.end()) - cost.begin());
  }
  F4 error(std::size_t plane, std::size_t half) const {
    const F4 distance = splat(rest_[plane]) - offset_[half];
    return weight_ * (distance * distance);
  }
  // Costs of the differences to all states of a plane from the last state of the plane before;
  // those from the state before that one begin one further on.
  const float* rates(std::size_t plane) const {
    const std::int64_t shift = std::int64_t(centre_[plane]) - centre_[plane - 1];
    return rates_.from(shift - (kStates - 1));
  }

  // The costs of the states of each plane of a run. False if no difference is in range.
  bool forward(std::size_t first, std::size_t end) {
    constexpr std::size_t kOften = 16;  // planes, after which costs are made small again
    for (std::size_t plane = first; plane < end; ++plane) {
      F4 low = error(plane, 0);
      F4 high = error(plane, 1);
      if (plane > first) {
        const float* before = cost_[plane - 1].data();
        const float* row = rates(plane) + (kStates - 1);
        // From seven states; two and two at a time, as each step waits for the one before.
        F4 best_low[2];
        F4 best_high[2];
        for (int from = 0; from < 2; ++from) {
          const F4 cost = splat(before[from]);
          best_low[from] = cost + load4(row - from);
          best_high[from] = cost + load4(row - from + 4);
        }
        for (int from = 2; from < kStates - 1; ++from) {
          const F4 cost = splat(before[from]);
          best_low[from % 2] = smaller(cost + load4(row - from), best_low[from % 2]);
          best_high[from % 2] = smaller(cost + load4(row - from + 4), best_high[from % 2]);
        }
        low += smaller(best_low[0], best_low[1]);
        high += smaller(best_high[0], best_high[1]);
      }
      std::memcpy(cost_[plane].data(), &low, sizeof low);
      std::memcpy(cost_[plane].data() + 4, &high, sizeof high);
      if (plane % kOften == 0 || plane + 1 == end) {
        // Relative to the smallest, so that they do not lose digits in long rows.
        const float least = cost_[plane][cheapest(cost_[plane])];
        if (least >= kNever / 2) return false;
        for (float& cost : cost_[plane]) cost = std::min(cost - least, kNever);
      }
    }
    return true;
  }

  // The levels on the way to the cheapest state at the end of a run.
  void back(std::size_t first, std::size_t end, std::vector<std::int32_t>& levels) const {
    std::size_t state = cheapest(cost_[end - 1]);
    for (std::size_t plane = end; plane-- > first;) {
      levels[plane] = centre_[plane] + std::int32_t(state) - kReach;
      if (plane == first) return;
      const float* row = rates(plane) + (kStates - 1) + state;
      const States& before = cost_[plane - 1];
      std::size_t best[2] = {0, 1};
      float least[2] = {before[0] + row[0], before[1] + *(row - 1)};
      for (std::size_t from = 2; from + 1 < before.size(); ++from) {
        const float cost = before[from] + *(row - from);
        best[from % 2] = cost < least[from % 2] ? from : best[from % 2];
        least[from % 2] = std::min(least[from % 2], cost);
      }
      state = least[1] < least[0] ? best[1] : best[0];
    }
  }

  const TrellisProblem& problem_;
  Rates rates_;
  std::vector<std::int32_t> centre_;  // the level nearest to each value
  std::vector<float> rest_;           // what is left of the value, in units
  std::vector<States> cost_;
  std::array<F4, 2> offset_{};  // of the states from the centre, in units
  F4 weight_{};
};

}  // namespace

TrellisResult plain_row(const TrellisProblem& problem) {
  TrellisResult row;
  if (problem.b.empty()) {
    quantise_row(problem.a, problem.step, row.levels);
  } else {
    std::vector<std::int32_t> mean(problem.a.size());
    for (std::size_t plane = 0; plane < mean.size(); ++plane) {
      mean[plane] = std::int32_t(std::lround(wanted(problem, plane)));
    }
    quantise_row(mean, problem.step, row.levels);
  }
  measure(problem, row);
  return row;
}

TrellisResult still_row(const TrellisProblem& problem) {
  double sum = 0;
  for (std::size_t plane = 0; plane < problem.a.size(); ++plane) sum += wanted(problem, plane);
  TrellisResult row;
  const double mean = sum / double(problem.a.size());
  row.levels.assign(problem.a.size(), std::int32_t(std::lround(mean / problem.step)));
  measure(problem, row);
  return row;
}

namespace {

// Search and counting in turn until nothing is gained.
void settle(const TrellisProblem& problem, Search& search, double lambda, const Limit& limit,
            std::vector<std::int32_t> levels, TrellisResult& best) {
  TrellisResult row;
  row.levels = std::move(levels);
  for (int round = 0; round < kRounds; ++round) {
    if (!search.improve(row.levels, lambda, limit)) return;
    measure(problem, row);
    const double before = cost_of(best, lambda);
    const double now = cost_of(row, lambda);
    if (!row.fits || now >= before) return;
    best = row;
    if (now > kHardlyLess * before) return;
  }
}

// The same, with a few rounds with a larger lambda first: they gather the differences on few
// symbols, from where the search for the true lambda finds shorter codes than from scattered ones.
void gather_and_settle(const TrellisProblem& problem, Search& search, double lambda,
                       const Limit& limit, std::vector<std::int32_t> levels, TrellisResult& best) {
  for (const double factor : {4.0, 2.0}) {
    if (!search.improve(levels, factor * lambda, limit)) return;
  }
  settle(problem, search, lambda, limit, std::move(levels), best);
}

// The widest predictive ranges of a row.
Limit widest(const TrellisProblem& problem, const std::vector<std::int32_t>& levels) {
  Limit limit{0, 0};
  for (std::size_t run = 0; run < problem.run_begin.size(); ++run) {
    const RunCost cost = run_ranges(part(levels, problem.run_begin, run), problem.scale);
    limit.up = std::max<int>(limit.up, cost.range[kPredictiveMax]);
    limit.down = std::max<int>(limit.down, cost.range[kPredictiveMin]);
  }
  return limit;
}

// Whether few enough differences lie outside narrower ranges that others could take their place.
bool can_narrow(const TrellisProblem& problem, const std::vector<std::int32_t>& levels,
                const Limit& limit) {
  if (limit.up < 0 || limit.down < 0) return false;
  const std::int64_t high = level_range(limit.up, problem.scale);
  const std::int64_t low = -level_range(limit.down, problem.scale);
  const std::size_t few = 3 + levels.size() / 12;
  std::size_t outside = 0;
  for (std::size_t run = 0; run < problem.run_begin.size(); ++run) {
    const auto row = part(levels, problem.run_begin, run);
    for (std::size_t plane = 1; plane < row.size(); ++plane) {
      const std::int64_t change = std::int64_t(row[plane]) - row[plane - 1];
      outside += change < low || change > high ? 1 : 0;
    }
  }
  return outside <= few;
}

}  // namespace

TrellisResult search_row(const TrellisProblem& problem, double lambda, const TrellisResult& start,
                         std::span<const std::int32_t> warm) {
  TrellisResult best = start;
  if (!start.fits || lambda == 0 || is_still(start.levels)) return best;
  Search search(problem);
  if (warm.empty()) {
    gather_and_settle(problem, search, lambda, {}, start.levels, best);
  } else {
    TrellisResult row;
    row.levels.assign(warm.begin(), warm.end());
    measure(problem, row);
    if (row.fits && cost_of(row, lambda) < cost_of(best, lambda)) best = row;
    settle(problem, search, lambda, {}, std::move(row.levels), best);
  }
  // A narrower range makes every symbol cheaper, if its few largest steps can be spread.
  for (bool gained = true; gained;) {
    gained = false;
    const Limit now = widest(problem, best.levels);
    for (const Limit& limit : {Limit{now.up - 1, now.down}, Limit{now.up, now.down - 1}}) {
      if (!can_narrow(problem, best.levels, limit)) continue;
      const double before = cost_of(best, lambda);
      settle(problem, search, lambda, limit, best.levels, best);
      gained |= cost_of(best, lambda) < before;
    }
  }
  return best;
}

TrellisResult search_runs(const TrellisProblem& problem, double lambda,
                          std::span<const std::int32_t> warm) {
  if (problem.run_begin.size() == 1) return search_row(problem, lambda, plain_row(problem), warm);
  constexpr std::size_t kFromItsBegin = 0;
  TrellisResult all;
  all.levels.reserve(problem.a.size());
  for (std::size_t run = 0; run < problem.run_begin.size(); ++run) {
    TrellisProblem alone = problem;
    alone.a = part(problem.a, problem.run_begin, run);
    if (!problem.b.empty()) alone.b = part(problem.b, problem.run_begin, run);
    alone.run_begin = std::span(&kFromItsBegin, 1);
    const auto warm_run = warm.empty() ? warm : part(warm, problem.run_begin, run);
    const TrellisResult moving = search_row(alone, lambda, plain_row(alone), warm_run);
    const TrellisResult still = still_row(alone);
    const bool rests = lambda > 0 && still.fits && cost_of(still, lambda) < cost_of(moving, lambda);
    const TrellisResult& best = rests ? still : moving;
    all.levels.insert(all.levels.end(), best.levels.begin(), best.levels.end());
    all.bits += best.bits;
    all.error += best.error;
    all.fits &= best.fits;
  }
  return all;
}

}  // namespace animeme::fba::internal

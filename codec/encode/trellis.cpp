#include "codec/encode/trellis_internal.h"

#include <algorithm>
#include <cmath>

#include "codec/encode/clip_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

constexpr int kReach = 3;                    // levels on each side of the nearest one
constexpr int kStates = 2 * kReach + 1 + 1;  // one more, never taken: eight fill a register
constexpr int kRounds = 5;                   // of search and counting
constexpr float kNever = 1e30F;

std::span<const std::int32_t> part(std::span<const std::int32_t> row,
                                   std::span<const std::size_t> begins, std::size_t run) {
  const std::size_t end = run + 1 < begins.size() ? begins[run + 1] : row.size();
  return row.subspan(begins[run], end - begins[run]);
}

double squared_error(const TrellisProblem& problem, std::size_t plane, double rec) {
  const double a = (problem.a[plane] - rec) / problem.unit;
  if (problem.b.empty()) return a * a;
  const double b = (problem.b[plane] - rec) / problem.unit;
  return a * a + b * b;
}

double wanted(const TrellisProblem& problem, std::size_t plane) {
  return problem.b.empty() ? problem.a[plane] : (double(problem.a[plane]) + problem.b[plane]) * 0.5;
}

// Bits and error of levels that are given.
void measure(const TrellisProblem& problem, TrellisResult& row) {
  row.bits = 0;
  row.error = 0;
  row.fits = true;
  for (std::size_t run = 0; run < problem.run_begin.size(); ++run) {
    const RunCost cost = run_cost(part(row.levels, problem.run_begin, run), problem.scale);
    row.bits += cost.bits;
    row.fits &= cost.fits;
  }
  for (std::size_t plane = 0; plane < row.levels.size(); ++plane) {
    row.error += squared_error(problem, plane, double(row.levels[plane]) * problem.step);
  }
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
    cost_.resize(n);
    for (std::int32_t level = low_; level <= high_; ++level) {
      const Bits bits = total - log2_of(histogram_[level] + 1);
      cost_[std::size_t(level - low_)] = float(lambda * double(bits) / double(kOneBit));
    }
  }
  // Costs of `count` differences from `level` on.
  void copy(std::int64_t level, std::span<float> out) const {
    for (float& cost : out) {
      cost = level < low_ || level > high_ ? kNever : cost_[std::size_t(level - low_)];
      ++level;
    }
  }

 private:
  std::int32_t low_ = 0;
  std::int32_t high_ = 0;
  Histogram histogram_;
  std::vector<float> cost_;
};

// The search through time.
class Search {
 public:
  using States = std::array<float, kStates>;

  explicit Search(const TrellisProblem& problem) : problem_(problem) {
    const std::size_t planes = problem.a.size();
    centre_.resize(planes);
    from_.resize(planes);
    error_.resize(planes);
    for (std::size_t plane = 0; plane < planes; ++plane) {
      centre_[plane] = std::int32_t(std::lround(wanted(problem, plane) / problem.step));
      for (int state = 0; state < kStates - 1; ++state) {
        const double rec = double(centre_[plane] + state - kReach) * problem.step;
        error_[plane][std::size_t(state)] = float(squared_error(problem, plane, rec));
      }
      error_[plane].back() = kNever;
    }
  }

  // The best levels at the rates that `levels` imply; false if there are none in range.
  bool improve(std::vector<std::int32_t>& levels, double lambda, const Limit& limit) {
    States cost{};
    for (std::size_t run = 0; run < problem_.run_begin.size(); ++run) {
      const auto run_levels = part(levels, problem_.run_begin, run);
      rates_.make(run_levels, problem_.scale, lambda, limit);
      const std::size_t first = problem_.run_begin[run];
      intra(first, cost);
      for (std::size_t plane = first + 1; plane < first + run_levels.size(); ++plane) {
        if (!predictive(plane, cost)) return false;
      }
    }
    std::size_t state = cheapest(cost);
    for (std::size_t plane = levels.size(); plane-- > 0;) {
      levels[plane] = centre_[plane] + std::int32_t(state) - kReach;
      state = from_[plane][state];
    }
    return true;
  }

 private:
  static std::size_t cheapest(const States& cost) {
    return std::size_t(std::min_element(cost.begin(), cost.end()) - cost.begin());
  }

  // Whatever came before: an intra plane depends on nothing.
  void intra(std::size_t plane, States& cost) {
    from_[plane].fill(std::int32_t(plane == 0 ? 0 : cheapest(cost)));
    cost = error_[plane];
  }

  // False if no difference is in range. Costs are kept relative to the smallest one, so that they
  // do not lose digits in long rows.
  bool predictive(std::size_t plane, States& cost) {
    std::array<float, 2 * kStates - 1> rate;
    const std::int64_t shift = std::int64_t(centre_[plane]) - centre_[plane - 1];
    rates_.copy(shift - (kStates - 1), rate);
    States next;
    next.fill(kNever);
    std::array<std::int32_t, kStates>& from_state = from_[plane];
    from_state.fill(0);
    for (std::size_t from = 0; from < kStates; ++from) {
      const float* row = rate.data() + (kStates - 1 - from);
      for (std::size_t state = 0; state < kStates; ++state) {
        const float total = cost[from] + row[state];
        const bool better = total < next[state];
        next[state] = better ? total : next[state];
        from_state[state] = better ? std::int32_t(from) : from_state[state];
      }
    }
    const float least = next[cheapest(next)];
    if (least >= kNever) return false;
    for (std::size_t state = 0; state < kStates; ++state) {
      cost[state] = std::min(next[state] - least + error_[plane][state], kNever);
    }
    return true;
  }

  const TrellisProblem& problem_;
  Rates rates_;
  std::vector<std::int32_t> centre_;
  std::vector<std::array<std::int32_t, kStates>> from_;
  std::vector<States> error_;
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

// Search and counting in turn until nothing is gained. A few rounds with a larger lambda come
// first: they gather the differences on few symbols, from where the search for the true lambda
// finds shorter codes than from scattered ones.
void settle(const TrellisProblem& problem, Search& search, double lambda, const Limit& limit,
            std::vector<std::int32_t> levels, TrellisResult& best) {
  for (const double factor : {4.0, 2.0}) {
    if (!search.improve(levels, factor * lambda, limit)) return;
  }
  TrellisResult row;
  row.levels = std::move(levels);
  for (int round = 0; round < kRounds; ++round) {
    if (!search.improve(row.levels, lambda, limit)) return;
    measure(problem, row);
    if (!row.fits || cost_of(row, lambda) >= cost_of(best, lambda)) return;
    best = row;
  }
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

}  // namespace

TrellisResult search_row(const TrellisProblem& problem, double lambda, const TrellisResult& start) {
  TrellisResult best = start;
  if (!start.fits || lambda == 0) return best;
  Search search(problem);
  settle(problem, search, lambda, {}, start.levels, best);
  // A narrower range makes every symbol cheaper, if its few largest steps can be spread.
  for (bool gained = true; gained;) {
    gained = false;
    const Limit now = widest(problem, best.levels);
    for (const Limit& limit : {Limit{now.up - 1, now.down}, Limit{now.up, now.down - 1}}) {
      if (limit.up < 0 || limit.down < 0) continue;
      const double before = cost_of(best, lambda);
      settle(problem, search, lambda, limit, best.levels, best);
      gained |= cost_of(best, lambda) < before;
    }
  }
  return best;
}

TrellisResult search_runs(const TrellisProblem& problem, double lambda) {
  if (problem.run_begin.size() == 1) return search_row(problem, lambda, plain_row(problem));
  constexpr std::size_t kFromItsBegin = 0;
  TrellisResult all;
  for (std::size_t run = 0; run < problem.run_begin.size(); ++run) {
    TrellisProblem alone = problem;
    alone.a = part(problem.a, problem.run_begin, run);
    if (!problem.b.empty()) alone.b = part(problem.b, problem.run_begin, run);
    alone.run_begin = std::span(&kFromItsBegin, 1);
    const TrellisResult moving = search_row(alone, lambda, plain_row(alone));
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

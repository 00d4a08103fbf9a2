#include <algorithm>
#include <cmath>

#include "codec/encode/rate_distortion_internal.h"

namespace animeme::fba::internal {

namespace {

constexpr int kMaxQuant = 31;
constexpr double kSlope = 1.4;  // of the error over bits at fine quantisation
constexpr double kFewBits = 100;
constexpr double kClearlyMore = 1.03;  // bits of a quantiser behind which no better one is sought

// At fine quantisation lambda is near 0.14 squared steps, with a step of 2 * quant units for most
// parameters.
double exact_quant_for(double lambda) { return std::sqrt(lambda / 0.14) / 2; }
int quant_for(double lambda) {
  return std::clamp(int(std::lround(exact_quant_for(lambda))), 1, kMaxQuant);
}

// Looks for the lambda at which something is reached that grows with it, or falls, about as a power
// of it.
class Guess {
 public:
  explicit Guess(double power) : power_(power) {}
  // `reached`: as a part of what is wanted.
  void add(double lambda, double reached) {
    Point& side = (reached <= 1) == (power_ > 0) ? low_ : high_;
    // The nearer one on each side.
    if (side.lambda == 0 || (&side == &low_ ? lambda > side.lambda : lambda < side.lambda)) {
      side = {lambda, std::log(std::max(reached, 1e-9))};
    }
    last_ = {lambda, std::log(std::max(reached, 1e-9))};
  }
  // Where `part` of what is wanted should be reached; 0: nothing between both sides is left.
  double next(double part) const {
    const double goal = std::log(part);
    if (low_.lambda == 0 || high_.lambda == 0) {
      const double factor = std::exp((goal - last_.reached) / power_);
      return last_.lambda *
             (high_.lambda == 0 ? std::clamp(factor, 1.1, 20.0) : std::clamp(factor, 0.05, 0.9));
    }
    if (high_.lambda < 1.005 * low_.lambda) return 0;
    const double span = high_.reached - low_.reached;
    const double at = span == 0 ? 0.5 : std::clamp((goal - low_.reached) / span, 0.2, 0.8);
    return low_.lambda * std::pow(high_.lambda / low_.lambda, at);
  }

 private:
  struct Point {
    double lambda = 0;
    double reached = 0;  // logarithm
  };
  double power_;
  Point low_;
  Point high_;
  Point last_;
};

// A row that stays at 0 need not be coded.
void forget_if_zero(TrellisResult& row) {
  if (is_zero(row.levels)) row.bits = 0;
}

}  // namespace

RateDistortion::RateDistortion(const ClipData& clip, const EncodeOptions& options)
    : clip_(clip), options_(options) {
  add_periods(clip.number, 0, clip.planes(), period_frames(options.intra_seconds, clip.rate.rate()),
              run_begin_);
}

TrellisProblem RateDistortion::problem(std::size_t channel, int quant) const {
  const Channel& row = clip_.channels[channel];
  TrellisProblem problem;
  problem.a = row.value;
  problem.step = step_at(row, quant);
  problem.scale = scale_at(row.body, quant);
  problem.unit = row.unit;
  problem.run_begin = run_begin_;
  return problem;
}

namespace {

// The least error of one row in place of both: their mean.
double error_of_mean(const TrellisProblem& both) {
  double sum = 0;
  for (std::size_t plane = 0; plane < both.a.size(); ++plane) {
    const double apart = double(both.a[plane]) - double(both.b[plane]);
    sum += apart * apart;
  }
  return sum * 0.5 / (both.unit * both.unit);
}

}  // namespace

RateDistortion::UnitResult RateDistortion::solve_unit(const Unit& unit, int quant, double lambda,
                                                      const Start& start,
                                                      const UnitResult* before) const {
  const bool coarser = before != nullptr && lambda >= start.lambda;
  const auto solve_row = [&](const TrellisProblem& row, const std::vector<std::int32_t>* warm) {
    const bool has_warm = warm != nullptr && !warm->empty();
    TrellisResult best;
    // What was not worth its bits is not where they count for more.
    const bool rests = has_warm && coarser && lambda > 0 && is_still(*warm) && !is_still(row.a);
    if (!rests) {
      best = search_runs(row, lambda, has_warm ? std::span(*warm) : std::span<const int>());
      forget_if_zero(best);
      if (lambda == 0) return best;
    }
    TrellisResult still = still_row(row);
    forget_if_zero(still);
    if (rests) return still;
    return still.fits && cost_of(still, lambda) < cost_of(best, lambda) ? still : best;
  };
  UnitResult result;
  TrellisProblem left = problem(unit.left, quant);
  if (unit.right == SIZE_MAX) {
    result.left = solve_row(left, before != nullptr ? &before->left.levels : nullptr);
    return result;
  }
  const bool merged = before != nullptr && before->merged;
  TrellisProblem both = left;
  both.b = clip_.channels[unit.right].value;
  if (merged && coarser) {
    result.left = solve_row(both, &before->left.levels);
    result.merged = true;
    return result;
  }
  const std::vector<std::int32_t>* warm_left = before != nullptr ? &before->left.levels : nullptr;
  const std::vector<std::int32_t>* warm_right =
      before == nullptr ? nullptr : &(merged ? before->left : before->right).levels;
  result.left = solve_row(left, warm_left);
  result.right = solve_row(problem(unit.right, quant), warm_right);
  if (!options_.leave_out) return result;
  if (before != nullptr && !merged && !coarser) return result;
  const double apart = cost_of(result.left, lambda) + cost_of(result.right, lambda);
  if (error_of_mean(both) > apart) return result;
  TrellisResult one = solve_row(both, warm_left);
  if (cost_of(one, lambda) <= apart) {
    result.merged = true;
    result.left = std::move(one);
    result.right = {};
  }
  return result;
}

RateDistortion::Solution RateDistortion::solve(const std::vector<Unit>& units, int quant,
                                               double lambda, const Start& start) const {
  tell_progress();
  Solution solution;
  solution.units.reserve(units.size());
  for (std::size_t i = 0; i < units.size(); ++i) {
    UnitResult result = solve_unit(units[i], quant, lambda, start,
                                   start.solution != nullptr ? &start.solution->units[i] : nullptr);
    for (const TrellisResult* row : {&result.left, &result.right}) {
      solution.bits += double(row->bits) / double(kOneBit);
      solution.error += row->error;
      solution.fits &= row->fits;
    }
    solution.units.push_back(std::move(result));
  }
  return solution;
}

// How many solutions there will be is not known: some thirty as a rule.
void RateDistortion::tell_progress() const {
  constexpr double kUsual = 30;
  ++solved_;
  if (options_.progress) options_.progress(1 - kUsual / (kUsual + 4 * solved_));
}

// The largest lambda whose error stays within `max_error`, nearly. `lambda`: where to look first,
// and what was found.
RateDistortion::Solution RateDistortion::solve_error(const std::vector<Unit>& units, int quant,
                                                     double max_error, double most_bits,
                                                     double& lambda) const {
  Solution best = solve(units, quant, 0, {});
  if (!best.fits || best.error > max_error || max_error <= 0) {
    best.fits = best.error <= max_error && best.fits;
    return best;
  }
  constexpr double kNearEnough = 0.994;  // of the error
  constexpr int kTries = 8;
  Guess guess(0.7);  // the slope of the error over lambda, both as logarithms
  double try_next = lambda;
  lambda = 0;
  for (int i = 0; i < kTries; ++i) {
    Solution next = solve(units, quant, try_next, warm_start(best, lambda, try_next));
    const double reached = next.error / max_error;
    guess.add(try_next, reached);
    const double least_bits = next.bits - (max_error - next.error) / try_next;
    if (reached <= 1 && (lambda == 0 || next.bits <= best.bits)) {
      lambda = try_next;
      best = std::move(next);
      if (reached >= kNearEnough) break;
    }
    // By the slope, what the bits will be where the error is reached.
    if (least_bits > most_bits) {
      best.bits = least_bits;
      best.given_up = true;
      break;
    }
    try_next = guess.next((1 + kNearEnough) / 2);
    if (try_next == 0) break;
  }
  return best;
}

// From a smaller lambda the search goes on well; from a larger one it would stay where it is.
RateDistortion::Start RateDistortion::warm_start(const Solution& solution, double lambda,
                                                 double next) {
  constexpr double kFar = 3;
  return lambda > 0 && next >= lambda && next <= kFar * lambda ? Start{&solution, lambda} : Start{};
}

std::vector<RateDistortion::Unit> RateDistortion::units_of(bool body, Kind kind) const {
  std::vector<Unit> units;
  std::vector<std::size_t> unit_of(clip_.channels.size(), SIZE_MAX);
  for (std::size_t i = 0; i < clip_.channels.size(); ++i) {
    const Channel& channel = clip_.channels[i];
    if (channel.body != body || !channel.given) continue;
    if (kind != Kind::all && channel.distance != (kind == Kind::distances)) continue;
    if (channel.left >= 0) {
      units[unit_of[std::size_t(channel.left)]].right = i;
      continue;
    }
    unit_of[i] = units.size();
    units.push_back({i, SIZE_MAX});
  }
  return units;
}

double RateDistortion::moving_values(const std::vector<Unit>& units) const {
  std::size_t rows = 0;
  for (const Unit& unit : units) {
    rows += is_still(clip_.channels[unit.left].value) ? 0 : 1;
    if (unit.right == SIZE_MAX) continue;
    rows += is_still(clip_.channels[unit.right].value) ? 0 : 1;
  }
  return double(rows) * double(clip_.planes());
}

void RateDistortion::store(const std::vector<Unit>& units, const Solution& solution, int quant,
                           Decision& decision) const {
  for (std::size_t i = 0; i < units.size(); ++i) {
    const UnitResult& result = solution.units[i];
    decision.rows[units[i].left].levels = result.left.levels;
    if (units[i].right == SIZE_MAX) continue;
    decision.rows[units[i].right].levels = result.merged ? result.left.levels : result.right.levels;
  }
  if (!units.empty()) {
    (clip_.channels[units.front().left].body ? decision.bap_quant : decision.fap_quant) = quant;
  }
}

double RateDistortion::limit_error_of(bool body, double max_rms, Decision& decision) const {
  const std::vector<Unit> kinds[2] = {units_of(body, Kind::distances),
                                      units_of(body, Kind::others)};
  double values[2];
  double lambda[2];
  for (std::size_t i = 0; i < 2; ++i) {
    values[i] = std::max(moving_values(kinds[i]), 1.0);
    lambda[i] = kSlope * max_rms * max_rms;
  }
  double best_bits = 0;
  double best_of_kind[2] = {0, 0};
  int best = 0;
  // False: the quantiser cannot keep the error, or takes clearly more bits than the best one.
  const auto try_quant = [&](int quant) {
    Solution solutions[2];
    double bits = 0;
    bool fits = true;
    bool given_up = false;
    for (std::size_t i = 0; i < 2; ++i) {
      double found = lambda[i];
      const double most_bits = best == 0 ? 1e300 : best_of_kind[i] + kFewBits;
      solutions[i] = solve_error(kinds[i], quant, max_rms * max_rms * values[i], most_bits, found);
      given_up |= solutions[i].given_up;
      if (found > 0) lambda[i] = found;
      bits += solutions[i].bits;
      fits &= solutions[i].fits;
    }
    // The finest is taken if none can keep the error.
    if (!fits && quant > 1) return false;
    if (!given_up && (best == 0 || bits < best_bits)) {
      best_bits = bits;
      best = quant;
      for (std::size_t i = 0; i < 2; ++i) best_of_kind[i] = solutions[i].bits;
      for (std::size_t i = 0; i < 2; ++i) store(kinds[i], solutions[i], quant, decision);
      return true;
    }
    return bits <= kClearlyMore * best_bits;
  };
  // From where theory expects the best one, first towards coarser ones, then towards finer ones.
  const int middle = quant_for(kSlope * max_rms * max_rms);
  int first = middle;
  while (!try_quant(first) && best == 0 && first > 1) --first;
  if (first == middle) {
    for (int quant = first + 1; quant <= kMaxQuant && try_quant(quant); ++quant) {
    }
  }
  for (int quant = first - 1; quant >= 1 && try_quant(quant); --quant) {
  }
  return best_bits;
}

double RateDistortion::limit_error(double max_rms, Decision& decision) const {
  double bits = 0;
  if (clip_.has_face) bits += limit_error_of(false, max_rms, decision);
  if (clip_.has_body) bits += limit_error_of(true, max_rms, decision);
  return bits;
}

// From one quantiser to its neighbours, as long as they cost less.
int RateDistortion::best_quant(const std::vector<Unit>& units, double lambda, int quant,
                               const Solution& solution) const {
  double best_cost = solution.error + lambda * solution.bits;
  for (const double factor : {1.25, 0.8}) {
    const int begin = quant;
    for (;;) {
      const int step = factor > 1 ? 1 : -1;
      const int away = quant + step;
      const int far = int(std::lround(factor * quant));
      const int next =
          std::clamp(step > 0 ? std::max(away, far) : std::min(away, far), 1, kMaxQuant);
      if (next == quant) break;
      const Solution other = solve(units, next, lambda, {});
      const double cost = other.error + lambda * other.bits;
      if (!other.fits || cost >= best_cost) break;
      best_cost = cost;
      quant = next;
    }
    if (quant != begin) break;
  }
  return quant;
}

void RateDistortion::limit_bits(double bits, Decision& decision, SearchHint& hint) const {
  constexpr double kLeast = 0.02;
  constexpr double kLargest = 1e6;
  constexpr double kNearEnough = 0.985;
  constexpr double kAlike = 0.85;  // so many bits of others will want the same quantisers
  constexpr int kTries = 6;
  struct Part {
    std::vector<Unit> units;
    int quant = 1;
    Solution solution;
    Solution finer;  // with too many bits, for a smaller lambda
  };
  std::vector<Part> parts;
  for (const bool body : {false, true}) {
    if (body ? clip_.has_body : clip_.has_face) {
      parts.emplace_back().units = units_of(body, Kind::all);
    }
  }
  double finer_lambda = 0;
  bool stored = false;
  double least_error = 0;
  // Solves and returns the bits as a part of what is wanted. What is small enough and errs least so
  // far is stored.
  const auto solve_all = [&](double lambda) {
    double sum = 0;
    double error = 0;
    for (Part& part : parts) {
      part.solution =
          solve(part.units, part.quant, lambda, warm_start(part.finer, finer_lambda, lambda));
      sum += part.solution.bits;
      error += part.solution.error;
    }
    if (sum <= bits ? !stored || error < least_error : !stored && lambda >= kLargest) {
      for (const Part& part : parts) store(part.units, part.solution, part.quant, decision);
      hint.lambda = lambda;
      hint.bits = sum;
      for (std::size_t i = 0; i < parts.size(); ++i) hint.quant[i] = parts[i].quant;
      least_error = error;
      stored = true;
    }
    return sum / bits;
  };
  double lambda = hint.lambda;
  const double hint_bits = hint.bits;
  const bool hinted = lambda > 0 && bits > kAlike * hint_bits;
  if (hinted) {
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].quant = hint.quant[i];
  } else {
    // About where it will be, with the quantisers that theory expects.
    lambda = lambda > 0 ? lambda * std::pow(hint_bits / bits, 2) : 4;
    Guess guess(-0.4);
    for (int i = 0; i < kTries; ++i) {
      for (Part& part : parts) part.quant = quant_for(lambda);
      const double reached = solve_all(lambda);
      if (reached > 0.9 && reached < 1.1) break;
      guess.add(lambda, reached);
      const double next = guess.next(1);
      if (next == 0 || std::clamp(next, kLeast, kLargest) == lambda) break;
      lambda = std::clamp(next, kLeast, kLargest);
    }
  }
  // The best quantisers at a lambda, then the lambda with them, until both agree.
  constexpr int kTurns = 2;
  constexpr double kSame = 1.5;
  for (int turn = 0; turn < kTurns; ++turn) {
    const double chosen_at = lambda;
    bool other = turn == 0;
    for (Part& part : parts) {
      if (hinted) continue;
      const int quant = best_quant(part.units, lambda, part.quant, part.solution);
      other |= quant != part.quant;
      part.quant = quant;
    }
    if (!other) return;
    finer_lambda = 0;
    Guess guess(-0.4);
    if (hinted && hint_bits > bits) {
      guess.add(lambda, hint_bits / bits);
      lambda = std::clamp(guess.next((1 + kNearEnough) / 2), kLeast, kLargest);
    }
    double within = 0;  // a lambda with few enough bits
    for (int i = 0; i < kTries || within == 0; ++i) {
      // What cannot be reached comes as near as it can.
      if (i >= kTries) lambda = std::min(lambda * 4, kLargest);
      const double reached = solve_all(lambda);
      guess.add(lambda, reached);
      if (reached <= 1 || lambda >= kLargest) {
        within = lambda;
        if (reached >= kNearEnough || lambda <= kLeast || reached > 1) break;
      } else {
        for (Part& part : parts) part.finer = std::move(part.solution);
        finer_lambda = lambda;
      }
      if (i + 1 >= kTries) continue;
      const double next = guess.next((1 + kNearEnough) / 2);
      if (next == 0) break;
      lambda = std::clamp(next, kLeast, kLargest);
    }
    lambda = within;
    if (hinted || (lambda < kSame * chosen_at && chosen_at < kSame * lambda)) return;
  }
}

}  // namespace animeme::fba::internal

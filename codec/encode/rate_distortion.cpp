#include <algorithm>
#include <cmath>

#include "codec/encode/rate_distortion_internal.h"

namespace animeme::fba::internal {

namespace {

constexpr int kMaxQuant = 31;

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

RateDistortion::UnitResult RateDistortion::solve_unit(const Unit& unit, int quant,
                                                      double lambda) const {
  const auto solve_row = [&](const TrellisProblem& row) {
    TrellisResult best = search_runs(row, lambda);
    TrellisResult still = still_row(row);
    forget_if_zero(best);
    forget_if_zero(still);
    return still.fits && cost_of(still, lambda) < cost_of(best, lambda) ? still : best;
  };
  UnitResult result;
  TrellisProblem left = problem(unit.left, quant);
  result.left = solve_row(left);
  if (unit.right == SIZE_MAX) return result;
  result.right = solve_row(problem(unit.right, quant));
  if (!options_.leave_out) return result;
  left.b = clip_.channels[unit.right].value;
  TrellisResult both = solve_row(left);
  if (cost_of(both, lambda) <= cost_of(result.left, lambda) + cost_of(result.right, lambda)) {
    result.merged = true;
    result.left = std::move(both);
    result.right = {};
  }
  return result;
}

RateDistortion::Solution RateDistortion::solve(const std::vector<Unit>& units, int quant,
                                               double lambda) const {
  tell_progress();
  Solution solution;
  for (const Unit& unit : units) {
    UnitResult result = solve_unit(unit, quant, lambda);
    for (const TrellisResult* row : {&result.left, &result.right}) {
      solution.bits += double(row->bits) / double(kOneBit);
      solution.error += row->error;
      solution.fits &= row->fits;
    }
    solution.units.push_back(std::move(result));
  }
  return solution;
}

// How many solutions there will be is not known: some sixty as a rule.
void RateDistortion::tell_progress() const {
  constexpr double kUsual = 60;
  ++solved_;
  if (options_.progress) options_.progress(1 - kUsual / (kUsual + 4 * solved_));
}

// The largest lambda whose error stays within `max_error`, by bisection.
RateDistortion::Solution RateDistortion::solve_error(const std::vector<Unit>& units, int quant,
                                                     double max_error) const {
  Solution best = solve(units, quant, 0);
  if (!best.fits || best.error > max_error) {
    best.fits = best.error <= max_error && best.fits;
    return best;
  }
  const double values = std::max(moving_values(units), 1.0);
  double low = 0;
  double high = 1.4 * max_error / values;  // the slope of error over bits at fine quantisation
  for (int i = 0; i < 12; ++i) {
    Solution next = solve(units, quant, high);
    if (next.error > max_error) break;
    low = high;
    high *= 2;
    if (next.bits < best.bits) best = std::move(next);
  }
  for (int i = 0; i < 5; ++i) {
    const double middle = low == 0 ? high / 2 : std::sqrt(low * high);
    Solution next = solve(units, quant, middle);
    if (next.error > max_error) {
      high = middle;
    } else {
      low = middle;
      if (next.bits < best.bits) best = std::move(next);
    }
  }
  return best;
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
  double best_bits = 0;
  for (int quant = 1; quant <= kMaxQuant; ++quant) {
    Solution solutions[2];
    double bits = 0;
    bool fits = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const double values = std::max(moving_values(kinds[i]), 1.0);
      solutions[i] = solve_error(kinds[i], quant, max_rms * max_rms * values);
      bits += solutions[i].bits;
      fits &= solutions[i].fits;
    }
    // Coarser quantisers err more: the first that cannot keep the error ends the search. The
    // finest is taken if none can.
    if (quant > 1 && (!fits || bits > 1.1 * best_bits)) break;
    if (quant > 1 && bits >= best_bits) continue;
    best_bits = bits;
    for (std::size_t i = 0; i < 2; ++i) store(kinds[i], solutions[i], quant, decision);
  }
  return best_bits;
}

double RateDistortion::limit_error(double max_rms, Decision& decision) const {
  double bits = 0;
  if (clip_.has_face) bits += limit_error_of(false, max_rms, decision);
  if (clip_.has_body) bits += limit_error_of(true, max_rms, decision);
  return bits;
}

// At fine quantisation lambda is near 0.14 squared steps, with a step of 2 * quant units for most
// parameters. The quantisers around that are tried.
int RateDistortion::best_quant(const std::vector<Unit>& units, double lambda) const {
  const double middle = std::sqrt(lambda / 0.14) / 2;
  int best = 0;
  double best_cost = 0;
  int last = 0;
  for (const double factor : {0.6, 0.8, 1.0, 1.3, 1.7}) {
    const int quant = std::clamp(int(std::lround(factor * middle)), 1, kMaxQuant);
    if (quant == last) continue;
    last = quant;
    const Solution solution = solve(units, quant, lambda);
    const double cost = solution.error + lambda * solution.bits;
    if (best != 0 && (!solution.fits || cost >= best_cost)) continue;
    best_cost = cost;
    best = quant;
  }
  return best;
}

double RateDistortion::fill_lambda(double lambda, Decision& decision) const {
  double bits = 0;
  for (const bool body : {false, true}) {
    if (!(body ? clip_.has_body : clip_.has_face)) continue;
    const std::vector<Unit> units = units_of(body, Kind::all);
    const int quant = body ? decision.bap_quant : decision.fap_quant;
    const Solution solution = solve(units, quant, lambda);
    bits += solution.bits;
    store(units, solution, quant, decision);
  }
  return bits;
}

double RateDistortion::fill_lambda_at_best_quant(double lambda, Decision& decision) const {
  if (clip_.has_face) decision.fap_quant = best_quant(units_of(false, Kind::all), lambda);
  if (clip_.has_body) decision.bap_quant = best_quant(units_of(true, Kind::all), lambda);
  return fill_lambda(lambda, decision);
}

void RateDistortion::limit_bits(double bits, Decision& decision) const {
  constexpr double kLargest = 1e6;
  double low = 0.02;
  double high = 0.02;
  while (high < kLargest && fill_lambda_at_best_quant(high, decision) > bits) {
    low = high;
    high *= 3;
  }
  if (low == high) return;
  for (int i = 0; i < 7; ++i) {
    const double middle = std::sqrt(low * high);
    (fill_lambda(middle, decision) > bits ? low : high) = middle;
  }
  fill_lambda(high, decision);
}

}  // namespace animeme::fba::internal

// Which mixture of own curves and of the base does best on sentences that are left out.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dam/corpus/statistics_internal.h"
#include "dam/signal/closure.h"
#include "dam/training/adapt_internal.h"

namespace animeme::dam {
namespace {

/// With so many sentences the first fold alone is enough.
constexpr std::size_t kManySentences = 100;
/// What varies by less, of its square, does not move.
constexpr double kStill = 1e-9;
/// Shares of the base that are tried.
constexpr double kShares[] = {0, 0.25, 0.5, 0.75, 1};

/// Squared errors and correlations of predictions, offsets kept.
class Errors {
 public:
  explicit Errors(std::size_t controls) : squares_(controls), sum_(controls) {}
  void add(const Utterance& u, const std::vector<bool>& speech, const std::vector<double>& made) {
    const std::size_t k = squares_.size();
    std::vector<Correlation> each(k);
    Correlation gap;
    const auto lips = inner_lip_channels(u.signal.names);
    for (std::size_t i = 0; i < speech.size(); ++i) {
      if (!speech[i]) continue;
      frames_ += 1;
      for (std::size_t c = 0; c < k; ++c) {
        const double x = made[i * k + c], y = u.signal.at(i, c);
        squares_[c] += (x - y) * (x - y);
        each[c].add(x, y);
      }
      if (lips)
        gap.add(made[i * k + lips->upper] + made[i * k + lips->lower],
                u.signal.at(i, lips->upper) + u.signal.at(i, lips->lower));
    }
    for (std::size_t c = 0; c < k; ++c) sum_[c] += each[c].value();
    gap_ += gap.value();
    has_gap_ = lips.has_value();
    sentences_ += 1;
  }
  HeldOutError result(std::span<const Control> scale) const {
    HeldOutError out;
    double moving = 0;
    for (std::size_t c = 0; c < scale.size(); ++c) {
      if (scale[c].sd == 0) continue;
      moving += 1;
      out.nrmse += std::sqrt(squares_[c] / std::max(1.0, frames_)) / scale[c].sd;
      out.correlation += sum_[c] / std::max(1.0, sentences_);
    }
    out.nrmse /= std::max(1.0, moving);
    out.correlation =
        has_gap_ ? gap_ / std::max(1.0, sentences_) : out.correlation / std::max(1.0, moving);
    return out;
  }

 private:
  struct Correlation {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    void add(double a, double b) { n += 1, x += a, y += b, xx += a * a, yy += b * b, xy += a * b; }
    double value() const {
      const double vx = xx - x * x / std::max(1.0, n), vy = yy - y * y / std::max(1.0, n);
      return vx > kStill * xx && vy > kStill * yy ? (xy - x * y / n) / std::sqrt(vx * vy) : 0;
    }
  };
  std::vector<double> squares_, sum_;
  double frames_ = 0, sentences_ = 0, gap_ = 0;
  bool has_gap_ = false;
};

/// A sentence that was left out, as every ingredient has it: frames x own controls each.
struct HeldOut {
  const Utterance* sentence = nullptr;
  std::vector<bool> speech;
  std::vector<std::vector<double>> own;   ///< by ridge
  std::vector<std::vector<double>> bent;  ///< without own curves, then by ridge
  std::vector<double> still;              ///< one row: the mean of the other sentences
};

/// The base bent: told of it, and corrected by own curves, if `learned` (own controls, then those
/// of the base) is given.
std::vector<double> bent_rows(const Signal& made, const Telling& telling, std::size_t ny,
                              const Signal* learned) {
  const std::size_t nx = made.names.size();
  std::vector<double> rows(made.frames() * ny);
  for (std::size_t i = 0; i < made.frames(); ++i) {
    for (std::size_t c = 0; c < ny; ++c) {
      double value = learned != nullptr ? learned->at(i, c) : telling.offset[c];
      for (std::size_t b = 0; b < nx; ++b)
        value += telling.gain[c * nx + b] *
                 (made.at(i, b) - (learned != nullptr ? learned->at(i, ny + b) : 0));
      rows[i * ny + c] = value;
    }
  }
  return rows;
}

std::vector<double> first_columns(const Signal& signal, std::size_t count) {
  std::vector<double> rows;
  for (std::size_t i = 0; i < signal.frames(); ++i)
    for (std::size_t c = 0; c < count; ++c) rows.push_back(signal.at(i, c));
  return rows;
}

std::vector<double> mixed_rows(const HeldOut& one, const Recipe& recipe,
                               std::span<const double> ridges) {
  const auto place = [&](double ridge) {
    return std::size_t(std::find(ridges.begin(), ridges.end(), ridge) - ridges.begin());
  };
  const auto& own = one.own[place(recipe.own_ridge)];
  const auto& bent = one.bent[recipe.bent_ridge > 0 ? place(recipe.bent_ridge) + 1 : 0];
  const std::size_t k = recipe.share.size();
  std::vector<double> rows(own.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = (1 - recipe.share[i % k]) * own[i] + recipe.share[i % k] * bent[i];
  return rows;
}

HeldOutError error_of(const std::vector<HeldOut>& all, const Recipe& recipe,
                      std::span<const double> ridges, std::span<const Control> scale) {
  Errors errors(scale.size());
  for (const HeldOut& one : all)
    errors.add(*one.sentence, one.speech, mixed_rows(one, recipe, ridges));
  return errors.result(scale);
}

/// Sums of products of the errors of two ingredients, per control and in its variance.
std::vector<double> products(const std::vector<HeldOut>& all, std::span<const Control> scale,
                             const std::vector<double>& (*a)(const HeldOut&, std::size_t),
                             std::size_t a_at,
                             const std::vector<double>& (*b)(const HeldOut&, std::size_t),
                             std::size_t b_at) {
  const std::size_t k = scale.size();
  std::vector<double> sum(k);
  for (const HeldOut& one : all) {
    const auto &x = a(one, a_at), &y = b(one, b_at);
    for (std::size_t i = 0; i < one.speech.size(); ++i) {
      if (!one.speech[i]) continue;
      for (std::size_t c = 0; c < k; ++c) {
        const double now = one.sentence->signal.at(i, c);
        sum[c] += (x[i * k + c] - now) * (y[i * k + c] - now);
      }
    }
  }
  for (std::size_t c = 0; c < k; ++c)
    sum[c] = scale[c].sd > 0 ? sum[c] / (scale[c].sd * scale[c].sd) : 0;
  return sum;
}

const std::vector<double>& own_rows(const HeldOut& one, std::size_t at) { return one.own[at]; }
const std::vector<double>& bent_rows_at(const HeldOut& one, std::size_t at) { return one.bent[at]; }

/// The mixture with the least squared error on sentences that were left out.
Recipe best_recipe(const std::vector<HeldOut>& all, std::span<const double> ridges,
                   std::span<const Control> scale) {
  Recipe best;
  double least = std::numeric_limits<double>::infinity();
  const auto total = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  for (std::size_t o = 0; o < ridges.size(); ++o) {
    const double own = total(products(all, scale, own_rows, o, own_rows, o));
    for (std::size_t b = 0; b <= ridges.size(); ++b) {
      const double bent = total(products(all, scale, bent_rows_at, b, bent_rows_at, b));
      const double both = total(products(all, scale, own_rows, o, bent_rows_at, b));
      for (const double w : kShares) {
        const double error = (1 - w) * (1 - w) * own + w * w * bent + 2 * w * (1 - w) * both;
        if (!(error < least)) continue;
        least = error;
        best = {ridges[o], b > 0 ? ridges[b - 1] : 0, std::vector<double>(scale.size(), w)};
      }
    }
  }
  return best;
}

/// Leaves sentences out in turn and has every ingredient speak them.
Result<std::vector<HeldOut>> hold_out(const Ingredients& from, const TrainOptions& options,
                                      const ProgressFunction& progress) {
  const std::size_t folds = from.folds.size();
  const std::size_t tried = from.material.sentences.size() >= kManySentences ? 1 : folds;
  const std::size_t ny = from.material.sentences[0].signal.names.size();
  std::vector<HeldOut> all;
  for (std::size_t fold = 0; fold < tried && folds > 1; ++fold) {
    const auto [in, in_made] = from.material.part(fold, folds, false);
    const auto [out, out_made] = from.material.part(fold, folds, true);
    const Telling telling = tell_base(from.base, from.controls, in, in_made);
    const auto sums = sums_without(from.folds, fold);
    if (!sums) return sums.error();
    const std::size_t first = all.size();
    std::vector<double> still;
    for (const Control& control : control_statistics(in, from.base.pause_edge))
      still.push_back(control.mean);
    for (std::size_t s = 0; s < out.size(); ++s)
      all.push_back({out[s],
                     speech_frames(*out[s]),
                     {},
                     {bent_rows(*out_made[s], telling, ny, nullptr)},
                     still});
    for (std::size_t r = 0; r < from.ridges.size(); ++r) {
      const double done = double(fold) + double(r) / double(from.ridges.size());
      if (progress && !progress({"base", done / double(tried), 0}))
        return make_error(Code::invalid_argument, "cancelled");
      const auto model = solved(from.base, *sums, options, from.ridges[r]);
      if (!model) return model.error();
      for (std::size_t s = 0; s < out.size(); ++s) {
        const auto learned = synthesise(*model, out[s]->script, as_learned(out[s]->signal));
        if (!learned) return learned.error();
        all[first + s].own.push_back(first_columns(*learned, ny));
        all[first + s].bent.push_back(bent_rows(*out_made[s], telling, ny, &*learned));
      }
    }
  }
  return all;
}

}  // namespace

SynthesisOptions as_learned(const Signal& like) {
  SynthesisOptions options;
  options.rate = like.rate;
  options.frames = like.frames();
  options.closure = false;
  options.sharpness = 0;
  options.rest_at_ends = false;
  return options;
}

Result<Recipe> choose_recipe(const Ingredients& from, const TrainOptions& options,
                             AdaptReport& report, const ProgressFunction& progress) {
  const std::size_t k = from.controls.size();
  const auto all = hold_out(from, options, progress);
  if (!all) return all.error();
  const auto fixed = [&](double share) {
    return Recipe{from.ridges[0], 0, std::vector<double>(k, share)};
  };
  if (all->empty()) return fixed(0.5);
  Recipe best = best_recipe(*all, from.ridges, from.controls);
  const auto errors = [&](const Recipe& recipe) {
    return error_of(*all, recipe, from.ridges, from.controls);
  };
  report.error = errors(best);
  report.base_error = errors(fixed(1));
  report.own_error = errors(fixed(0));
  Errors still(k);
  for (const HeldOut& one : *all) {
    std::vector<double> rows;
    for (std::size_t i = 0; i < one.speech.size(); ++i)
      rows.insert(rows.end(), one.still.begin(), one.still.end());
    still.add(*one.sentence, one.speech, rows);
  }
  report.still_error = still.result(from.controls);
  return best;
}

}  // namespace animeme::dam

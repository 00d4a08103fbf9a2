// From sums to a model.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "dam/corpus/statistics_internal.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/refined/solve.h"
#include "dam/training/accumulate.h"
#include "dam/training/train_notes_internal.h"
#include "dam/training/training_sums_internal.h"

namespace animeme::dam {
namespace {

constexpr double kConstantRange = 1e-9;  // values closer together do not move
constexpr double kOtherPace = 1.5;       // usual durations further off than this factor
constexpr std::uint64_t kEnoughExamples = 30;

std::vector<Control> controls_of(const SumsState& state) {
  std::vector<Control> controls;
  const double speech = std::max(1.0, double(state.speech_frames));
  for (const ControlSums& sums : state.controls) {
    Control c{sums.name, 0, 0, 0};
    c.mean = sums.sum.value() / speech;
    const bool moves = sums.high - sums.low > kConstantRange * (1 + std::abs(c.mean));
    if (moves) c.sd = std::sqrt(std::max(0.0, sums.squares.value() / speech - c.mean * c.mean));
    c.rest = state.rest_frames > 0 ? sums.rest_sum.value() / double(state.rest_frames) : c.mean;
    controls.push_back(c);
  }
  settle_controls(controls);
  return controls;
}

std::vector<ControlLimit> limits_of(const SumsState& state, std::span<const Control> controls) {
  std::vector<std::string> names;
  for (const Control& control : controls) names.push_back(control.name);
  std::vector<ControlLimit> limits = natural_limits(names);
  // The sums do not contain whether the two of a pair were ever above 0 together.
  untie(limits, [](std::size_t, std::size_t) { return false; });
  for (std::size_t c = 0; c < limits.size(); ++c) {
    const ControlSums& sums = state.controls[c];
    limits[c] = limit_of_data(limits[c], controls[c], sums.low, sums.high);
  }
  return settled(std::move(limits));
}

/// Phones that occurred, with their keys in `space` renumbered; dominance likewise.
std::vector<PhoneModel> phones_of(const SumsState& state, std::vector<PhoneDominance>& dominance,
                                  TermSpace& space) {
  std::vector<PhoneModel> phones;
  std::vector<std::uint32_t> number(state.phones.size(), 0);
  for (std::size_t p = 0; p < state.phones.size(); ++p) {
    const PhoneSums& sums = state.phones[p];
    if (sums.examples == 0) continue;
    number[p] = std::uint32_t(phones.size());
    phones.push_back(state.base.phones[p]);
    phones.back().examples = std::uint32_t(std::min<std::uint64_t>(sums.examples, 0xFFFFFFFFu));
    phones.back().longest = std::max(kLongestAnyway, sums.longest);
    dominance.push_back(state.base.refined.dominance[p]);
  }
  for (std::size_t t = 0; t < kTermCount; ++t)
    for (std::uint32_t& key : space.tables[t].keys)
      if (const auto phone = phone_of_key(kTermInfo[t].term, key))
        key = key_with_phone(kTermInfo[t].term, key, number[*phone]);
  return phones;
}

/// Unknowns whose sums are the same in both sets have the same columns: the sums are exact, and two
/// columns whose squares and product are equal do not differ.
TermColumns equal_columns(const SumsState& state) {
  const auto& rows = state.rows;
  const auto at = [&](std::size_t a, std::size_t b) {
    return std::pair(state.kept.gram.at(rows[a], rows[b]), state.held.gram.at(rows[a], rows[b]));
  };
  std::map<std::pair<double, double>, std::vector<std::uint32_t>> by_square;  // first of its kind
  TermColumns columns;
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    const auto square = at(i, i);
    auto& others = by_square[{square.first.value(), square.second.value()}];
    const auto same = std::find_if(others.begin(), others.end(), [&](std::uint32_t j) {
      return at(j, j) == square && at(i, j) == square;
    });
    columns.of.push_back(same == others.end() ? std::uint32_t(columns.size) : columns.of[*same]);
    if (same != others.end()) continue;
    others.push_back(i);
    ++columns.size;
  }
  return columns;
}

/// Rows of the sums for the columns.
std::vector<std::size_t> rows_of(const SumsState& state, const TermColumns& columns) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < columns.of.size(); ++i)
    if (columns.of[i] == rows.size()) rows.push_back(state.rows[i]);
  return rows;
}

/// Measured from the mean in standard deviations; the column of ones is used up.
CurveSums standardised(const FitSums& fit, const std::vector<std::size_t>& rows,
                       std::span<const Control> controls) {
  const std::size_t k = controls.size(), n = rows.size();
  CurveSums out(n, k);
  for (std::size_t i = 0; i < n; ++i) {
    const auto below = out.gram.below(i);
    for (std::size_t j = i; j < n; ++j) below[j - i] = fit.gram.at(rows[i], rows[j]).value();
  }
  out.frames = std::size_t(fit.frames);
  for (std::size_t c = 0; c < k; ++c) {
    const double mean = controls[c].mean, sd = controls[c].sd;
    if (sd == 0) continue;
    for (std::size_t i = 0; i < n; ++i) {
      const FixedSum* row = &fit.right[rows[i] * (k + 1)];
      out.right[i * k + c] = (row[c].value() - mean * row[k].value()) / sd;
    }
    const double energy = fit.energy[c].value() - 2 * mean * fit.level[c].value() +
                          mean * mean * fit.energy[k].value();
    out.energy[c] = std::max(0.0, energy) / (sd * sd);
  }
  return out;
}

void warn_of_pace(const SumsState& state, TrainSummary& summary) {
  std::string labels;
  for (std::size_t p = 0; p < state.phones.size(); ++p) {
    const PhoneSums& sums = state.phones[p];
    if (sums.examples < kEnoughExamples || state.base.phones[p].label == kSilence) continue;
    const double usual = std::exp(sums.log_duration.value() / double(sums.examples));
    const double ratio = usual / state.base.phones[p].duration;
    if (ratio > kOtherPace || ratio < 1 / kOtherPace) labels += " " + state.base.phones[p].label;
  }
  if (!labels.empty())
    summary.warnings.push_back(
        "phones that are 1.5 times longer or shorter than in the base of the sums:" + labels +
        "; a base that was trained on a part of these sentences fits better");
}

void warn_of_versions(const SumsState& state, TrainSummary& summary) {
  for (auto a = state.sentences.begin(); a != state.sentences.end(); ++a)
    if (const auto b = std::next(a); b != state.sentences.end() && a->first == b->first)
      summary.warnings.push_back("sentence '" + a->first +
                                 "' occurs with different contents; both count");
}

void summarise(const SumsState& state, const Model& model, TrainSummary& summary) {
  summary.utterances = state.sentences.size();
  summary.frames = std::size_t(state.kept.frames + state.held.frames);
  summary.speech_seconds = state.rate.seconds(double(state.speech_frames));
  for (const PhoneSums& sums : state.phones) summary.occurrences += std::size_t(sums.examples);
  note_phones(model, summary);
  add_warnings(summary);
  warn_of_pace(state, summary);
  warn_of_versions(state, summary);
}

Model start_model(const SumsState& state, const TrainOptions& options) {
  Model model;
  model.method = Method::dam;
  model.pause_edge = state.base.pause_edge;
  model.closure_gap = closure_gap_of(state.closures.median());
  if (const auto low = state.lip_tooth.median()) model.lip_tooth_raise = -*low;
  model.closure_duration = state.shut.values().line();
  model.rate = state.rate;
  model.attribution = options.attribution;
  model.provenance = options.provenance;
  model.controls = controls_of(state);
  model.limits = limits_of(state, model.controls);
  return model;
}

}  // namespace

Result<Model> train_from_sums(TrainingSums sums, const TrainOptions& options,
                              TrainSummary* summary) {
  const auto begin = std::chrono::steady_clock::now();
  if (auto ok = validate(options); !ok) return ok.error();
  if (options.method != Method::dam)
    return make_error(Code::invalid_argument, "only the method dam can be trained from sums");
  TrainSummary own;
  TrainSummary& out = summary != nullptr ? *summary : own;
  out = {};
  const std::unique_ptr<SumsState> state = std::move(sums).release();
  if (state->sentences.empty())
    return make_error(Code::invalid_argument, "there is no sentence in the sums");
  Model model = start_model(*state, options);
  std::vector<PhoneDominance> dominance;
  TermSpace space = state->space;
  model.phones = phones_of(*state, dominance, space);
  if (model.phones.empty())
    return make_error(Code::invalid_argument, "no sentence has a phone other than silence");
  const std::size_t k = model.controls.size();
  const bool choose = state->sentences.size() >= kLeastToChoose && state->kept.sentences > 0 &&
                      state->held.sentences > 0;
  const TermColumns columns = equal_columns(*state);
  const std::vector<std::size_t> rows = rows_of(*state, columns);
  CurveSums all = standardised(state->kept, rows, model.controls);
  state->kept.gram = {};
  const CurveSums held = standardised(state->held, rows, model.controls);
  state->held.gram = {};
  double factor = options.refined.ridge > 0 ? options.refined.ridge : kUsualRidge;
  std::vector<double> explained;
  if (choose) {
    const RidgeChooser chooser(all.gram, space, columns, options.refined.ridge, options.threads);
    const RidgeTrial trial{all.gram, all.right, k, [&](const std::vector<double>& solution) {
                             return errors_of(held, solution, k);
                           }};
    factor = chooser.choose(trial);
    if (summary != nullptr) explained = chooser.explained(trial, factor);
  }
  all.add(held);
  const auto solution =
      solve_curves(all.gram, all.right, space, columns, k, factor, options.threads);
  if (summary != nullptr)
    note_explained(model.controls, choose ? explained : explained_by(errors_of(all, solution, k)),
                   choose, out);
  const auto curves = curves_of(space, columns, solution, k);
  RefinedOptions refined;
  refined.time_margin = state->base.refined.time_margin;
  refined.duration_exponent = state->base.refined.duration_exponent;
  model.parameters = refined_parameters(space, curves, means_from_rest(model.controls), refined,
                                        std::move(dominance));
  if (auto ok = validate(model); !ok)
    return make_error(Code::invalid_argument, "the sums have no solution: " + ok.error().message);
  out.ridge = factor;
  summarise(*state, model, out);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return model;
}

}  // namespace animeme::dam

// Compares the training sentences, synthesised by the model, with the recordings.
#include <algorithm>
#include <cmath>
#include <optional>

#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/refined/solve.h"
#include "dam/maths/parallel.h"
#include "dam/model/kind_internal.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/train_notes_internal.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kFewSentences = 8;
constexpr std::size_t kNamed = 3;
constexpr double kLeastOffset = 0.1;     // standard deviations of the control
constexpr double kToDeviation = 1.4826;  // of a normal distribution, from the median of |x|

Review review(const TrainingSet& set, const Model& model, const Utterance& u,
              const FitSentence& sentence) {
  const auto timeline = make_timeline(u.script, model.pause_edge);
  std::vector<std::int32_t> phone;
  for (const Occurrence& o : timeline) phone.push_back(index_of(model.phones, o.label));
  const SynthesisOptions options;
  const Speech speech{model, timeline, phone, options, set.rate, 0, sentence.frames};
  const std::size_t k = set.data.controls;
  std::vector<double> rows(sentence.frames * k, 0.0);
  SynthesisReport report;
  if (!timeline.empty()) kind_of(model.method).speak(speech, rows, report);
  std::vector<double> sum(k, 0.0), squares(k, 0.0);
  Review out{0, std::vector<double>(k, 0.0), std::vector<double>(k, 0.0),
             std::vector<double>(k, 0.0)};
  for (std::size_t i = 0; i < sentence.frames; ++i) {
    if (set.data.use[sentence.first_frame + i] == 0) continue;
    out.frames += 1;
    for (std::size_t c = 0; c < k; ++c) {
      const double y = set.data.target[(sentence.first_frame + i) * k + c];
      const double r = y - rows[i * k + c];
      sum[c] += y;
      squares[c] += y * y;
      out.offset[c] += r;
      out.error[c] += r * r;
    }
  }
  const double n = std::max(1.0, out.frames);
  for (std::size_t c = 0; c < k; ++c) {
    out.error[c] = std::max(0.0, out.error[c] - out.offset[c] * out.offset[c] / n);
    out.offset[c] /= n;
    out.energy[c] = std::max(0.0, squares[c] - sum[c] * sum[c] / n);
  }
  return out;
}

double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> explained(const std::vector<Review>& all, std::size_t controls) {
  std::vector<double> share(controls, 0.0);
  for (std::size_t c = 0; c < controls; ++c) {
    double error = 0, energy = 0;
    for (const Review& r : all) {
      error += r.error[c];
      energy += r.energy[c];
    }
    if (energy > 0) share[c] = 1 - error / energy;
  }
  return share;
}

/// Root mean square of the offsets over the controls that move, each in usual offsets.
std::vector<double> offsets(const std::vector<Review>& all, const std::vector<Control>& controls) {
  std::vector<double> sum(all.size(), 0.0);
  double moving = 0;
  for (std::size_t c = 0; c < controls.size(); ++c) {
    if (controls[c].sd == 0) continue;
    moving += 1;
    std::vector<double> sizes;
    for (const Review& r : all) sizes.push_back(std::abs(r.offset[c]));
    const double usual = std::max(kLeastOffset, kToDeviation * upper_median(sizes));
    for (std::size_t s = 0; s < all.size(); ++s) sum[s] += std::pow(sizes[s] / usual, 2);
  }
  for (double& x : sum) x = std::sqrt(x / std::max(1.0, moving));
  return sum;
}

/// Root mean square errors, divided by their median.
std::vector<double> relative_errors(const std::vector<Review>& all) {
  std::vector<double> errors;
  for (const Review& r : all) {
    double sum = 0;
    for (const double e : r.error) sum += e;
    errors.push_back(std::sqrt(sum / std::max(1.0, r.frames)));
  }
  const double usual = upper_median(errors);
  for (double& e : errors) e = usual > 0 ? e / usual : 0;
  return errors;
}

double strangeness(const SentenceNote& s) {
  return std::max(s.offset / kOutlierOffset, s.error / kOutlierError);
}

/// A sentence that was not in the training, in the deviations of the model.
std::optional<Review> review_other(const Model& model, const Utterance& sentence) {
  auto script = replace_unknown_phones(model, sentence.script);
  if (!script) return std::nullopt;
  Utterance u = sentence;
  u.script = std::move(*script);
  TrainingSet set;
  set.controls = model.controls;
  set.phones = model.phones;
  set.rate = u.signal.rate;
  set.data.controls = set.controls.size();
  add_sentence(u, make_timeline(u.script, model.pause_edge), model.pause_edge, set);
  return review(set, model, u, set.data.sentences[0]);
}

}  // namespace

void HeldOutShare::add(const Model& model, std::span<const Utterance* const> sentences,
                       int threads) {
  std::vector<std::optional<Review>> all(sentences.size());
  parallel_for(all.size(), threads,
               [&](std::size_t s) { all[s] = review_other(model, *sentences[s]); });
  for (auto& one : all)
    if (one) reviews_.push_back(std::move(*one));
}

void HeldOutShare::note(std::span<const Control> controls, TrainSummary& summary) const {
  if (reviews_.empty()) return;
  note_explained(controls, explained(reviews_, controls.size()), true, summary);
}

void review_sentences(const TrainingSet& set, const Model& model,
                      std::span<const Utterance* const> sentences, int threads,
                      TrainSummary& summary) {
  std::vector<Review> all(sentences.size());
  parallel_for(all.size(), threads, [&](std::size_t s) {
    all[s] = review(set, model, *sentences[s], set.data.sentences[s]);
  });
  if (!summary.held_out)
    note_explained(model.controls, explained(all, model.controls.size()), false, summary);
  if (all.size() < kFewSentences) return;
  const auto offset = offsets(all, model.controls);
  const auto error = relative_errors(all);
  for (std::size_t s = 0; s < all.size(); ++s)
    if (const SentenceNote note{sentences[s]->id, offset[s], error[s]}; strangeness(note) > 1)
      summary.outliers.push_back(note);
  std::stable_sort(
      summary.outliers.begin(), summary.outliers.end(),
      [](const SentenceNote& a, const SentenceNote& b) { return strangeness(a) > strangeness(b); });
  if (summary.outliers.size() > kNamed) summary.outliers.resize(kNamed);
}

}  // namespace animeme::dam

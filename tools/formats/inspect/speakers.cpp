#include "tools/formats/inspect/speakers.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/training/adapt.h"
#include "dam/training/train.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"

namespace animeme::inspect {
namespace {

using dam::Model;
using dam::SentencePair;
using dam::Utterance;
using tools::format;
using tools::Json;

constexpr std::size_t kLeastTests = 4;
constexpr double kSpeech = 0.2;  // seconds around a phone that count as its speech

using Means = std::array<MeanInterval, SpeakerScore::kCount>;

// ---- scores ----

std::optional<std::size_t> channel_of_fap(const dam::Signal& signal, int fap) {
  for (std::size_t c = 0; c < signal.names.size(); ++c)
    if (dam::fap_of_channel(signal.names[c]) == fap) return c;
  return std::nullopt;
}

void add_gaps(const dam::Signal& signal, const dam::Script& script, std::vector<double>& gaps) {
  const auto upper = channel_of_fap(signal, 4), lower = channel_of_fap(signal, 5);
  if (!upper || !lower) return;
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const double time = signal.time(i);
    const bool spoken =
        std::any_of(script.phones.begin(), script.phones.end(), [&](const dam::Phone& phone) {
          return phone.label != dam::kSilence && phone.start - kSpeech <= time &&
                 time <= phone.end + kSpeech;
        });
    if (spoken) gaps.push_back(-(signal.at(i, *upper) + signal.at(i, *lower)));
  }
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Result<SpeakerScore> score_of(const std::vector<SentencePair>& pairs,
                              const dam::ScoreOptions& options) {
  const auto result = dam::score(pairs, options);
  if (!result) return result.error();
  SpeakerScore out;
  out.gap_correlation = result->gap_correlation;
  out.nrmse = result->nrmse;
  out.fitted_nrmse = result->fitted_nrmse;
  for (const dam::SeriesScore& measure : result->measures) {
    if (measure.name != "inner_gap") continue;
    out.gap_error = measure.nrmse;
    out.gap_fitted = measure.fitted_nrmse;
  }
  std::vector<double> recorded, made;
  for (const SentencePair& pair : pairs) {
    add_gaps(pair.recorded.signal, pair.recorded.script, recorded);
    add_gaps(pair.synthesised, pair.recorded.script, made);
  }
  out.gap_recorded = median(std::move(recorded));
  out.gap_made = median(std::move(made));
  return out;
}

/// The mean pose of the speech in the training sentences.
std::vector<double> mean_pose(std::span<const Utterance> sentences) {
  std::vector<const Utterance*> all;
  for (const Utterance& u : sentences) all.push_back(&u);
  std::vector<double> pose;
  for (const dam::Control& control : dam::recording_scale(all)) pose.push_back(control.mean);
  return pose;
}

dam::Signal still_face(const Utterance& like, const std::vector<double>& pose) {
  dam::Signal still = like.signal;
  still.measured.clear();
  for (std::size_t i = 0; i < still.values.size(); ++i) still.values[i] = pose[i % pose.size()];
  return still;
}

/// What a model makes of sentences; no model: a still face.
std::vector<SentencePair> spoken(const Model* model, std::span<const Utterance> tests,
                                 const std::vector<double>& pose,
                                 const dam::EvaluateOptions& options) {
  std::vector<SentencePair> pairs;
  for (const Utterance& u : tests) {
    SentencePair pair{u, still_face(u, pose)};
    dam::SynthesisOptions how = options.synthesis;
    how.rate = u.signal.rate;
    how.frames = u.signal.frames();
    if (model != nullptr)
      if (auto made = dam::synthesise(*model, u.script, how)) pair.synthesised = std::move(*made);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

// ---- speakers ----

std::uint64_t place_of(const std::string& speaker, const std::string& id) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : speaker + "/" + id) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3u;
  hash ^= hash >> 31;
  return hash * 0x9e3779b97f4a7c15u;
}

/// In an order that depends on nothing but names.
std::vector<Utterance> shuffled(std::vector<Utterance> sentences, const std::string& speaker) {
  std::sort(sentences.begin(), sentences.end(), [&](const Utterance& a, const Utterance& b) {
    return std::pair(place_of(speaker, a.id), a.id) < std::pair(place_of(speaker, b.id), b.id);
  });
  return sentences;
}

MeanInterval mean_interval(const std::vector<double>& values, int draws) {
  MeanInterval out;
  if (values.empty()) return out;
  for (const double value : values) out.mean += value / double(values.size());
  std::mt19937 random(1);
  std::vector<double> means;
  for (int d = 0; d < draws; ++d) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[random() % values.size()];
    means.push_back(sum / double(values.size()));
  }
  std::sort(means.begin(), means.end());
  out.low = means.empty() ? out.mean : means[means.size() / 40];
  out.high = means.empty() ? out.mean : means[means.size() - 1 - means.size() / 40];
  return out;
}

/// Means of scores, or of their differences to others.
Means means_of(const std::vector<SpeakerScore>& scores, const std::vector<SpeakerScore>* less,
               int draws) {
  Means out;
  for (std::size_t m = 0; m < SpeakerScore::kCount; ++m) {
    std::vector<double> values;
    for (std::size_t s = 0; s < scores.size(); ++s)
      values.push_back(scores[s].values()[m] - (less != nullptr ? (*less)[s].values()[m] : 0));
    out[m] = mean_interval(values, draws);
  }
  return out;
}

const char* const kSystems[] = {"still", "base", "own", "adapted"};

/// Scores of all systems of one size for one speaker.
Result<std::array<SpeakerScore, 4>> compare(const Model& base, std::span<const Utterance> train,
                                            std::span<const Utterance> tests,
                                            const SpeakersOptions& options) {
  const std::vector<double> pose = mean_pose(train);
  const auto own = dam::train(train, options.train);
  if (!own) return own.error();
  const auto adapted = dam::adapt(base, train, options.train);
  if (!adapted) return adapted.error();
  const Model* const models[] = {nullptr, &base, &*own, &*adapted};
  std::array<SpeakerScore, 4> out;
  dam::ScoreOptions score = options.evaluate.score;
  if (score.scale.empty()) {  // the same for all
    std::vector<const Utterance*> recorded;
    for (const Utterance& u : tests) recorded.push_back(&u);
    for (const dam::Control& control : dam::recording_scale(recorded))
      if (base.find_control(control.name) >= 0) score.scale.push_back(control);
  }
  for (std::size_t m = 0; m < out.size(); ++m) {
    const auto found = score_of(spoken(models[m], tests, pose, options.evaluate), score);
    if (!found) return found.error();
    out[m] = *found;
  }
  return out;
}

/// A model of another speaker, of sentences that nothing else is done with.
Result<Model> base_of(const std::vector<Utterance>& own, std::size_t used, std::size_t most,
                      std::span<const Utterance> sentences, const SpeakerHabits& habits,
                      const SpeakersOptions& options) {
  std::vector<Utterance> rest;
  for (std::size_t i = used; i < own.size() && rest.size() < most; ++i) {
    const auto same = std::find_if(sentences.begin(), sentences.end(),
                                   [&](const Utterance& u) { return u.id == own[i].id; });
    rest.push_back(*same);
  }
  if (rest.empty())
    return make_error(Code::invalid_argument, "no sentence is left to train a base on");
  const auto warped = warp(rest, habits);
  if (!warped) return warped.error();
  return dam::train(*warped, options.train);
}

Result<void> score_others(const SpeakersOptions& options, SpeakersReport& report) {
  for (const Utterance& u : options.others) {
    const auto pairs = spoken(options.base, {&u, 1}, mean_pose({&u, 1}), options.evaluate);
    dam::ScoreOptions score = options.evaluate.score;
    if (score.scale.empty()) {
      const Utterance* const recorded[] = {&u};
      for (const dam::Control& control : dam::recording_scale(recorded))
        if (options.base->find_control(control.name) >= 0) score.scale.push_back(control);
    }
    const auto found = score_of(pairs, score);
    if (!found) return found.error();
    report.others.push_back(u.id);
    report.other_scores.push_back(*found);
  }
  report.other_mean = means_of(report.other_scores, nullptr, options.draws);
  return {};
}

// ---- output ----

std::string cell(const MeanInterval& value, const char* pattern) {
  return format(pattern, value.mean, value.low, value.high);
}

std::string line_of(const std::string& system, const Means& mean) {
  return format("%-22s", system.c_str()) + cell(mean[0], "%6.3f (%5.3f-%5.3f)") +
         cell(mean[1], "  %5.2f (%4.2f-%4.2f)") + cell(mean[2], "  %5.3f (%5.3f-%5.3f)") +
         cell(mean[3], "  %5.2f (%4.2f-%4.2f)") + cell(mean[4], "  %5.3f (%5.3f-%5.3f)") +
         format("  %5.0f %5.0f\n", mean[5].mean, mean[6].mean);
}

std::string difference_of(const std::string& what, const Means& mean) {
  return format("  %-20s", what.c_str()) + cell(mean[0], "%+6.3f (%+.3f to %+.3f)") +
         cell(mean[1], ", gap error %+.2f (%+.2f to %+.2f)") +
         cell(mean[3], ", NRMSE %+.3f (%+.3f to %+.3f)") + "\n";
}

Json json_of(const Means& mean) {
  Json out = Json::object();
  for (std::size_t m = 0; m < SpeakerScore::kCount; ++m)
    out[SpeakerScore::names()[m]] = {
        {"mean", mean[m].mean}, {"low", mean[m].low}, {"high", mean[m].high}};
  return out;
}

Json json_of(const std::vector<SpeakerScore>& scores, const std::vector<std::string>& names) {
  Json out = Json::object();
  for (std::size_t s = 0; s < scores.size(); ++s)
    for (std::size_t m = 0; m < SpeakerScore::kCount; ++m)
      out[names[s]][SpeakerScore::names()[m]] = scores[s].values()[m];
  return out;
}

Json json_of(const SpeakerHabits& h) {
  return {{"name", h.name},           {"jaw_rest", h.jaw_rest},   {"gap_rest", h.gap_rest},
          {"jaw_level", h.jaw_level}, {"range", h.range},         {"bend", h.bend},
          {"habits", h.habits},       {"contexts", h.contexts},   {"wide_iy", h.wide_iy},
          {"asymmetry", h.asymmetry}, {"lips_late", h.lips_late}, {"pace", h.pace},
          {"vowels", h.vowels},       {"uneven", h.uneven},       {"noise", h.noise},
          {"posture", h.posture}};
}

}  // namespace

std::array<double, SpeakerScore::kCount> SpeakerScore::values() const {
  return {gap_correlation, gap_error, gap_fitted, nrmse, fitted_nrmse, gap_recorded, gap_made};
}

std::array<const char*, SpeakerScore::kCount> SpeakerScore::names() {
  return {"gap_correlation", "gap_nrmse",           "gap_fitted_nrmse", "nrmse",
          "fitted_nrmse",    "median_gap_recorded", "median_gap_made"};
}

Result<SpeakersReport> compare_speakers(std::span<const Utterance> sentences,
                                        const SpeakersOptions& options) {
  const auto bad = [](const std::string& what) { return make_error(Code::invalid_argument, what); };
  if (options.base == nullptr) return bad("there is no base to compare with");
  std::vector<std::size_t> sizes;
  for (const std::size_t size : options.sizes)
    if (size > 0 && size + kLeastTests <= sentences.size()) sizes.push_back(size);
  if (sizes.empty())
    return bad("comparing speakers needs at least " +
               std::to_string(kLeastTests + (options.sizes.empty() ? 1 : options.sizes[0])) +
               " sentences, these are " + std::to_string(sentences.size()));
  std::sort(sizes.begin(), sizes.end());
  SpeakersReport report;
  report.speakers = warped_habits(options.speakers);
  auto habits_of_bases = warped_habits(options.speakers + 1);
  habits_of_bases.erase(habits_of_bases.begin());
  const std::size_t left = sentences.size() - sizes.back();
  report.tests = std::min(options.most_tests, options.base_sentences > 0 ? left / 2 : left);
  for (const std::size_t size : sizes)
    for (const char* system : kSystems) report.rows.push_back({system, size, {}, {}, {}, {}});
  for (std::size_t s = 0; s < report.speakers.size(); ++s) {
    auto copies = warp(sentences, report.speakers[s]);
    if (!copies) return copies.error();
    const auto own = shuffled(std::move(*copies), report.speakers[s].name);
    const auto tests = std::span(own).subspan(sizes.back(), report.tests);
    Model base = *options.base;
    if (options.base_sentences > 0) {
      auto model = base_of(own, sizes.back() + report.tests, options.base_sentences, sentences,
                           habits_of_bases[s], options);
      if (!model) return model.error();
      base = std::move(*model);
    }
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const double done =
          (double(s) + double(i) / double(sizes.size())) / double(report.speakers.size());
      if (options.progress && !options.progress(done)) return bad("the comparison was stopped");
      const auto scores = compare(base, std::span(own).first(sizes[i]), tests, options);
      if (!scores) return scores.error();
      for (std::size_t m = 0; m < scores->size(); ++m)
        report.rows[i * scores->size() + m].scores.push_back((*scores)[m]);
    }
  }
  for (std::size_t i = 0; i < report.rows.size(); i += 4) {
    for (std::size_t m = 0; m < 4; ++m) {
      SpeakersRow& row = report.rows[i + m];
      row.mean = means_of(row.scores, nullptr, options.draws);
      if (m < 3) continue;
      row.over_base = means_of(row.scores, &report.rows[i + 1].scores, options.draws);
      row.over_own = means_of(row.scores, &report.rows[i + 2].scores, options.draws);
    }
  }
  if (auto ok = score_others(options, report); !ok) return ok.error();
  return report;
}

std::string speakers_text(const SpeakersReport& report) {
  std::string text = format(
      "%zu warped speakers, %zu held-out sentences each; means and 95 %% of bootstrap draws over "
      "speakers. Errors are NRMSE; fitted: after a gain and an offset for each control.\n\n"
      "sentences, system      gap correlation       gap error          fitted               all "
      "lip "
      "FAPs       fitted               median gap: recorded, made\n",
      report.speakers.size(), report.tests);
  for (const SpeakersRow& row : report.rows) {
    text += line_of(format("%3zu  ", row.sentences) + row.system, row.mean);
    if (row.system != "adapted") continue;
    text += difference_of("over own", row.over_own) + difference_of("over base", row.over_base);
  }
  if (!report.others.empty())
    text += format("\nbase on %zu recordings of other people\n", report.others.size()) +
            line_of("     base", report.other_mean);
  return text;
}

std::string speakers_json(const SpeakersReport& report) {
  std::vector<std::string> names;
  Json speakers = Json::array(), rows = Json::array();
  for (const SpeakerHabits& habits : report.speakers) {
    names.push_back(habits.name);
    speakers.push_back(json_of(habits));
  }
  for (const SpeakersRow& row : report.rows) {
    Json one = {{"system", row.system},
                {"sentences", row.sentences},
                {"mean", json_of(row.mean)},
                {"speakers", json_of(row.scores, names)}};
    if (row.system == "adapted") {
      one["minus_own"] = json_of(row.over_own);
      one["minus_base"] = json_of(row.over_base);
    }
    rows.push_back(std::move(one));
  }
  Json out = {{"speakers", speakers}, {"held_out_sentences", report.tests}, {"rows", rows}};
  if (!report.others.empty())
    out["others"] = {{"mean", json_of(report.other_mean)},
                     {"recordings", json_of(report.other_scores, report.others)}};
  return tools::pretty(out);
}

}  // namespace animeme::inspect

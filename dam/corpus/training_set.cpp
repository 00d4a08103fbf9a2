#include "dam/corpus/training_set_internal.h"

#include <algorithm>
#include <cmath>

#include "dam/corpus/statistics_internal.h"
#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

Error in_sentence(const Utterance& u, const std::string& what) {
  return make_error(Code::invalid_argument, "sentence '" + u.id + "': " + what);
}

using Timelines = std::vector<std::vector<Occurrence>>;

std::vector<PhoneModel> phone_table(const Timelines& timelines) {
  struct Examples {
    std::uint32_t count = 0;
    double log_sum = 0, longest = kLongestAnyway;
  };
  std::map<std::string, Examples> examples;
  for (const auto& timeline : timelines)
    for (const Occurrence& o : timeline) {
      Examples& e = examples[o.label];
      ++e.count;
      e.log_sum += std::log(o.duration);
      e.longest = std::max(e.longest, o.duration);
    }
  std::vector<PhoneModel> phones;
  for (const auto& [label, e] : examples) {
    phones.push_back(
        {label, e.count, context_class_of(label), std::exp(e.log_sum / e.count), e.longest});
  }
  return phones;
}

/// SpeechData::word of the frames of a sentence.
void number_words(const Utterance& u, TrainingSet& set) {
  std::vector<std::uint32_t>& word = set.data.word;
  const std::size_t first = word.size();
  word.resize(first + u.signal.frames(), 0);
  std::size_t i = 0;
  for (const Phone& phone : u.script.phones) {
    while (i < u.signal.frames() && u.signal.time(i) < phone.start) ++i;
    if (phone.word.empty()) continue;
    const auto number =
        set.words.try_emplace(phone.word, std::uint32_t(set.words.size() + 1)).first->second;
    for (; i < u.signal.frames() && u.signal.time(i) < phone.end; ++i) word[first + i] = number;
  }
}

}  // namespace

std::uint32_t context_class_of(std::string_view label) {
  const PhoneInfo* info = find_phone(label);
  return info != nullptr ? std::uint32_t(info->phone_class) : std::uint32_t(kPhoneClassCount);
}

Result<void> check_sentence(const Utterance& u, const std::vector<std::string>& names,
                            fap::Rate rate) {
  const Signal& s = u.signal;
  if (s.names.empty() || s.names != names)
    return in_sentence(u, "its controls are not those of the first sentence");
  if (!s.rate.valid() || !(s.rate == rate))
    return in_sentence(u, "its frame rate is not that of the first sentence; resample it");
  if (s.values.size() != s.frames() * s.names.size() || s.frames() == 0)
    return in_sentence(u, "its signal is empty or has an incomplete frame");
  for (std::size_t i = 0; i < s.values.size(); ++i)
    if (!std::isfinite(s.values[i]))
      return in_sentence(u, "frame " + std::to_string(i / s.names.size()) + " of " +
                                s.names[i % s.names.size()] + " is not a finite number");
  if (auto ok = check_script(u.script); !ok) return in_sentence(u, ok.error().message);
  return {};
}

std::int32_t index_of(const std::vector<PhoneModel>& phones, const std::string& label) {
  if (label.empty()) return kRestContext;
  const auto at =
      std::lower_bound(phones.begin(), phones.end(), label,
                       [](const PhoneModel& p, const std::string& l) { return p.label < l; });
  return std::int32_t(at - phones.begin());
}

void add_sentence(const Utterance& u, const std::vector<Occurrence>& timeline, double pause_edge,
                  TrainingSet& set) {
  SpeechData& data = set.data;
  const std::size_t k = set.controls.size();
  data.sentences.push_back(
      {data.use.size(), u.signal.frames(), data.occurrences.size(), timeline.size()});
  const auto stretches = speech_stretches(u.script);
  for (std::size_t i = 0; i < u.signal.frames(); ++i) {
    const double distance = distance_to_speech(stretches, u.signal.time(i));
    data.use.push_back(is_measured(u.signal, i) && distance <= pause_edge ? 1 : 0);
    for (std::size_t c = 0; c < k; ++c) {
      const Control& control = set.controls[c];
      data.target.push_back(
          control.sd > 0 ? (u.signal.values[i * k + c] - control.rest) / control.sd : 0.0);
    }
  }
  number_words(u, set);
  for (const Occurrence& o : timeline)
    data.occurrences.push_back({o.start, o.duration, index_of(set.phones, o.label),
                                index_of(set.phones, o.left), index_of(set.phones, o.right), 0});
}

Result<TrainingSet> make_training_set(std::span<const Utterance* const> sentences,
                                      const TrainOptions& options) {
  if (sentences.empty())
    return make_error(Code::invalid_argument, "there is no sentence to train on");
  TrainingSet set;
  Timelines timelines;
  bool speech = false;
  for (const Utterance* u : sentences) {
    const Signal& first = sentences[0]->signal;
    if (auto ok = check_sentence(*u, first.names, first.rate); !ok) return ok.error();
    timelines.push_back(make_timeline(u->script, options.pause_edge));
    speech = speech || !timelines.back().empty();
  }
  if (!speech)
    return make_error(Code::invalid_argument, "no sentence has a phone other than silence");
  set.controls = control_statistics(sentences, options.pause_edge);
  set.closure_gap = measured_closure_gap(sentences);
  set.lip_tooth_raise = measured_lip_tooth_raise(sentences);
  set.closure_duration = measured_closure_duration(sentences);
  set.phones = phone_table(timelines);
  set.rate = sentences[0]->signal.rate;
  set.data.controls = set.controls.size();
  set.data.rate = set.rate.frames_per_second();
  for (std::size_t i = 0; i < sentences.size(); ++i)
    add_sentence(*sentences[i], timelines[i], options.pause_edge, set);
  return set;
}

void note_explained(std::span<const Control> controls, const std::vector<double>& explained,
                    bool held_out, TrainSummary& summary) {
  summary.held_out = held_out;
  summary.controls.clear();
  for (std::size_t c = 0; c < controls.size(); ++c) {
    const bool constant = controls[c].sd == 0;
    summary.controls.push_back({controls[c].name, constant, constant ? 0.0 : explained[c]});
  }
}

}  // namespace animeme::dam

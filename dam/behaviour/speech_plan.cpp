#include "dam/behaviour/speech_plan.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

constexpr double kPhrasePause = 0.2, kUtterancePause = 0.6;
constexpr double kAccentDistance = 0.45, kProminent = 1.25;
constexpr double kFinal = 1.25;       // what the end of a phrase draws its last vowel out by
constexpr double kRise = 1.5;         // semitones to an accent
constexpr double kOfSemitone = 0.12;  // of a vowel's prominence, for one above its surroundings
constexpr double kOfLevel = 0.5;      // likewise, for a level that is 1 above the median

// How long a vowel is beside others, unstressed ones aside (Klatt 1976 has these orders).
double usual_length(std::string_view label) {
  if (label == "AX") return 0.6;
  if (label == "IH" || label == "UH" || label == "EH" || label == "AH") return 0.85;
  if (label == "AY" || label == "AW" || label == "OY" || label == "EY" || label == "OW")
    return 1.25;
  return 1.05;
}

bool is_sounding_vowel(const Phone& phone) {
  const PhoneInfo* info = find_phone(phone.label);
  return info != nullptr && info->vowel;
}

bool ends_in_any(std::string_view text, std::initializer_list<std::string_view> marks) {
  return std::any_of(marks.begin(), marks.end(),
                     [&](std::string_view mark) { return text.ends_with(mark); });
}

// What follows the marks of a sentence: quotes and brackets.
std::string_view without_quotes(std::string_view word) {
  static constexpr std::string_view kQuotes[] = {"\"", "'", ")",  "]",  "}",  "»",       "”",
                                                 "’",  "“", "」", "』", "）", "\xC2\xA0"};
  for (bool again = true; again;) {
    again = false;
    for (const std::string_view quote : kQuotes) {
      if (!word.ends_with(quote)) continue;
      word.remove_suffix(quote.size());
      again = true;
    }
  }
  return word;
}

struct Marks {
  bool pause = false, end = false, question = false, exclaimed = false;
};

Marks marks_of(std::string_view word) {
  word = without_quotes(word);
  Marks marks;
  marks.question = ends_in_any(word, {"?", "？", "؟", "\xCD\xBE", "?!", "⁇", "፧"});
  marks.exclaimed = ends_in_any(word, {"!", "！", "?!", "!?", "‼"});
  marks.end =
      marks.question || marks.exclaimed || ends_in_any(word, {".", "。", "…", "।", "．", "۔", "።"});
  marks.pause = marks.end || ends_in_any(word, {",", ";", ":", "，", "、", "；", "：", "،", "—"});
  return marks;
}

std::vector<SpeechPhrase> phrases_of(const Script& script) {
  std::vector<SpeechPhrase> phrases;
  Marks marks;  // of the last word
  for (const Phone& phone : script.phones) {
    if (phone.label == kSilence) continue;
    const double pause = phrases.empty() ? 0 : phone.start - phrases.back().end;
    const bool parted = pause >= kPhrasePause || (pause > kTimeTolerance && marks.pause);
    if (phrases.empty() || parted) {
      SpeechPhrase phrase{phone.start, phone.end};
      phrase.begins = true;
      if (!phrases.empty()) {
        phrases.back().ends = phrases.back().ends || pause >= kUtterancePause;
        phrase.begins = phrases.back().ends;
      }
      phrases.push_back(phrase);
    }
    SpeechPhrase& last = phrases.back();
    last.end = phone.end;
    marks = marks_of(phone.word);
    last.question = marks.question;
    last.exclaimed = marks.exclaimed;
    last.ends = marks.end;
  }
  if (!phrases.empty()) phrases.back().ends = true;
  return phrases;
}

float median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Semitones and levels of a plan.
void take_prosody(const Prosody& from, SpeechPlan& plan) {
  const std::size_t count = std::min(from.pitch.size(), from.level.size());
  std::vector<float> voiced, heard;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(from.pitch[i] > 0)) continue;
    voiced.push_back(from.pitch[i]);
    heard.push_back(from.level[i]);
  }
  if (voiced.empty() || !(from.step > 0)) return;
  const float usual = median(std::move(voiced)), loud = 2 * median(std::move(heard));
  plan.step = from.step;
  plan.pitch.resize(count);
  plan.level.resize(count);
  std::size_t last = count;  // that had a voice
  for (std::size_t i = 0; i < count; ++i) {
    plan.level[i] = loud > 0 ? std::clamp(from.level[i] / loud, 0.0f, 1.0f) : 0.0f;
    if (!(from.pitch[i] > 0)) continue;
    plan.pitch[i] = 12 * std::log2(from.pitch[i] / usual);
    const std::size_t first = last == count ? 0 : last + 1;
    for (std::size_t k = first; k < i; ++k) {
      const float share = last == count ? 1.0f : float(k - last) / float(i - last);
      const float before = last == count ? plan.pitch[i] : plan.pitch[last];
      plan.pitch[k] = before + share * (plan.pitch[i] - before);
    }
    last = i;
  }
  for (std::size_t k = last + 1; k < count; ++k) plan.pitch[k] = plan.pitch[last];
}

struct PitchRange {
  float low = 0, high = 0, mean = 0;
};

PitchRange range_of(const std::vector<float>& values, double step, double from, double to) {
  const auto place = [&](double time) {
    return std::size_t(std::clamp(time / step, 0.0, double(values.size())));
  };
  const std::size_t first = place(from), end = std::max(place(to), first);
  if (first == end) return {};
  PitchRange range{values[first], values[first], 0};
  for (std::size_t i = first; i < end; ++i) {
    range.low = std::min(range.low, values[i]);
    range.high = std::max(range.high, values[i]);
    range.mean += values[i];
  }
  range.mean /= float(end - first);
  return range;
}

struct Candidate {
  const Phone* vowel = nullptr;
  double prominence = 0;
};

// In the order of the script; `usual` is the duration of a vowel of factor 1.
std::vector<Candidate> candidates_of(const Script& script, const SpeechPhrase& phrase, double usual,
                                     const SpeechPlan& plan) {
  std::vector<Candidate> list;
  auto phone = std::lower_bound(script.phones.begin(), script.phones.end(), phrase.start,
                                [](const Phone& p, double time) { return p.start < time; });
  for (; phone != script.phones.end() && phone->start < phrase.end; ++phone) {
    if (!is_sounding_vowel(*phone) || phone->label == "AX") continue;
    list.push_back({&*phone, phone->duration() / (usual * usual_length(phone->label))});
  }
  if (!list.empty()) list.back().prominence /= kFinal;
  if (plan.pitch.empty()) return list;
  for (Candidate& one : list) {
    const Phone& vowel = *one.vowel;
    const PitchRange here = range_of(plan.pitch, plan.step, vowel.start, vowel.end);
    const PitchRange about = range_of(plan.pitch, plan.step, vowel.start - 0.4, vowel.end + 0.4);
    const PitchRange level = range_of(plan.level, plan.step, vowel.start, vowel.end);
    const double above = std::clamp(double(here.high - about.mean), -2.0, 5.0);
    one.prominence *= 1 + kOfSemitone * above + kOfLevel * (double(level.mean) - 0.5);
  }
  return list;
}

bool rises_to(const Phone& vowel, const SpeechPlan& plan) {
  const PitchRange here = range_of(plan.pitch, plan.step, vowel.start - 0.05, vowel.end);
  const PitchRange before = range_of(plan.pitch, plan.step, vowel.start - 0.25, vowel.start + 0.02);
  return double(here.high - before.low) >= kRise;
}

void add_accents(std::vector<Candidate> candidates, const SpeechPhrase& phrase, SpeechPlan& plan) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.prominence > b.prominence; });
  std::vector<SpeechAccent> here;
  for (const Candidate& one : candidates) {
    const bool first = here.empty();
    if (!first && one.prominence < kProminent) break;
    const bool near = std::any_of(here.begin(), here.end(), [&](const SpeechAccent& other) {
      return std::abs(other.start - one.vowel->start) < kAccentDistance;
    });
    if (near) continue;
    SpeechAccent accent{one.vowel->start, one.vowel->end};
    const double above = one.prominence - 1;
    accent.weight = first ? std::clamp(0.7 + 0.3 * above, 0.6, 1.0) : std::clamp(above, 0.3, 0.9);
    if (phrase.exclaimed) accent.weight = std::min(1.0, 1.3 * accent.weight);
    accent.strong = first;
    accent.rise = plan.pitch.empty() ? accent.weight >= 0.7 : rises_to(*one.vowel, plan);
    here.push_back(accent);
  }
  std::sort(here.begin(), here.end(),
            [](const SpeechAccent& a, const SpeechAccent& b) { return a.start < b.start; });
  plan.accents.insert(plan.accents.end(), here.begin(), here.end());
}

double usual_vowel(const Script& script) {
  std::vector<float> lengths;
  for (const Phone& phone : script.phones)
    if (is_sounding_vowel(phone))
      lengths.push_back(float(phone.duration() / usual_length(phone.label)));
  const double found = double(median(std::move(lengths)));
  return found > 0 ? found : 0.1;
}

}  // namespace

SpeechPlan plan_speech(const Script& script, const Prosody* prosody) {
  SpeechPlan plan;
  plan.phrases = phrases_of(script);
  if (prosody != nullptr) take_prosody(*prosody, plan);
  const double usual = usual_vowel(script);
  for (const SpeechPhrase& phrase : plan.phrases)
    add_accents(candidates_of(script, phrase, usual, plan), phrase, plan);
  return plan;
}

}  // namespace animeme::dam

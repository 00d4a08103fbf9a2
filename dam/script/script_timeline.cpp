#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "dam/script/ipa.h"
#include "dam/script/phones.h"
#include "dam/script/script_readers_internal.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/timings.h"

namespace animeme::dam {
namespace {

using Labels = std::vector<IpaPhone>;

// Upper-case letters and digits alone are more likely a misspelt ARPAbet label than X-SAMPA.
bool may_be_arpabet(std::string_view label) {
  return label.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789") == label.npos;
}

// Labels that only one of the two alphabets has decide which one the script is written in:
// consonants like "s" are in both.
Alphabet guess_alphabet(const std::vector<TimedLabel>& labels) {
  std::set<std::string_view> seen;
  std::size_t only_arpabet = 0, only_ipa = 0;
  for (const TimedLabel& timed : labels) {
    const std::string_view label = timed.label;
    if (timed.alphabet != Alphabet::automatic || !seen.insert(label).second) continue;
    if (is_silence_spelling(label)) continue;
    const std::string_view known = arpabet_label(label);
    if (known.size() == 2 && label.size() >= 2) {
      ++only_arpabet;
    } else if (known.empty() && !may_be_arpabet(label) && parse_ipa(label)) {
      ++only_ipa;
    }
  }
  return only_ipa > only_arpabet ? Alphabet::ipa : Alphabet::arpabet;
}

Error unknown_label(const TimedLabel& timed, Alphabet alphabet) {
  const std::string_view label = timed.label;
  std::string message = "unknown phone label " + in_quotes(label);
  const std::string_view nearest = nearest_label(label);
  const bool alike = label.size() <= 4 && lower_case(label)[0] == lower_case(nearest)[0];
  if (alphabet == Alphabet::arpabet && !alike) {
    message += "; it is neither a sound of ARPAbet nor a mark such as [noise]";
  } else if (alphabet == Alphabet::arpabet) {
    message += "; the nearest ARPAbet label is " + std::string(nearest);
  } else {
    const auto parsed = parse_ipa(label);
    message += parsed ? "; a label must be one sound, these letters are several"
                      : ": " + parsed.error().message;
  }
  return error_at_line(Code::not_found, message, timed.line, timed.column);
}

std::optional<Labels> map_label(std::string_view label, Alphabet alphabet) {
  if (is_silence_spelling(label)) return Labels{{kSilence, 1.0}};
  if (alphabet == Alphabet::arpabet) {
    const std::string_view known = arpabet_label(label);
    if (!known.empty()) return Labels{{known, 1.0}};
    // One foreign letter in an otherwise English script is still clear; Latin letters are not.
    bool ascii = true;
    for (const char c : label) ascii = ascii && static_cast<unsigned char>(c) < 0x80;
    if (ascii) return std::nullopt;
  }
  auto parsed = parse_ipa(label);
  if (!parsed || !is_one_sound(label, *parsed)) return std::nullopt;
  return *std::move(parsed);
}

std::string place_of(const TimedLabel& label) {
  std::string place = "line " + std::to_string(label.line);
  if (label.column > 0) place += ", column " + std::to_string(label.column);
  return place;
}

std::string seconds_text(double seconds) { return format_seconds(seconds) + " s"; }

std::optional<Error> check_times(const TimedLabel& phone) {
  const std::string name = "phone " + in_quotes(phone.label);
  if (!std::isfinite(phone.start) || !std::isfinite(phone.end)) {
    return error_at_line(Code::out_of_range, name + " has a time that is not a finite number",
                         phone.line, phone.column);
  }
  if (phone.start < 0) {
    return error_at_line(Code::syntax,
                         name + " starts at " + seconds_text(phone.start) +
                             ", before the audio; times count from its start and are not negative",
                         phone.line, phone.column);
  }
  if (phone.end <= phone.start) {
    return error_at_line(Code::syntax,
                         name + " ends at " + seconds_text(phone.end) +
                             ", not after its start at " + seconds_text(phone.start) +
                             "; give it a duration or remove it",
                         phone.line, phone.column);
  }
  if (phone.end > kMaxScriptSeconds) {
    return error_at_line(Code::out_of_range,
                         name + " ends at " + seconds_text(phone.end) +
                             ", beyond one day; times are in seconds (not samples or ms), and "
                             "longer scripts have to be split",
                         phone.line, phone.column);
  }
  return std::nullopt;
}

std::optional<Error> check_order(const TimedLabel& before, const TimedLabel& phone) {
  const std::string names = "phone " + in_quotes(phone.label) + " starts at " +
                            seconds_text(phone.start) + ", before " + in_quotes(before.label);
  if (phone.start <= before.start) {
    return error_at_line(Code::syntax,
                         names + " (" + place_of(before) + ") or with it; sort the phones by time",
                         phone.line, phone.column);
  }
  if (phone.start < before.end - kTimeTolerance - 1e-9) {
    return error_at_line(Code::syntax,
                         names + " (" + place_of(before) + ") ends at " + seconds_text(before.end) +
                             "; phones must not overlap, so move one of the two times",
                         phone.line, phone.column);
  }
  return std::nullopt;
}

// Words keep to one line without blanks at the ends, so that every format can hold them.
std::string clean_word(std::string_view word) {
  std::string out(word);
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  return std::string(trimmed(out));
}

// A pause that takes no time says nothing.
void drop_empty_pauses(std::vector<TimedLabel>& labels) {
  std::erase_if(labels, [](const TimedLabel& label) {
    return label.start == label.end && is_silence_spelling(label.label);
  });
}

bool may_be_vowel(std::string_view label) {
  const PhoneInfo* phone = find_phone(arpabet_label(label));
  if (phone != nullptr) return phone->vowel;
  const auto sounds = parse_ipa(label);
  return !sounds || sounds->empty() || find_phone(sounds->front().label)->vowel;
}

// TIMIT separates the closure of a stop from its burst; one stop that begins at the closure is what
// the lips do. Sets that fold TIMIT's and those of Japanese do not say which stop it is.
bool closes_for(std::string_view closure, std::string_view stop) {
  if (closure == "cl" || closure == "vcl") {
    return !is_silence_spelling(stop) && !may_be_vowel(stop);
  }
  if (closure.size() != 3 || !closure.ends_with("cl")) return false;
  return stop.substr(0, 1) == closure.substr(0, 1)
             ? stop.size() == 1
             : (closure == "tcl" && stop == "ch") || (closure == "dcl" && stop == "jh");
}

void join_closures(std::vector<TimedLabel>& labels) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (kept > 0) {
      const TimedLabel& before = labels[kept - 1];
      const bool touches = std::abs(labels[i].start - before.end) <= kTimeTolerance;
      if (touches && closes_for(lower_case(before.label), lower_case(labels[i].label))) {
        labels[i].start = before.start;
        --kept;
      }
    }
    if (kept != i) labels[kept] = std::move(labels[i]);
    ++kept;
  }
  labels.resize(kept);
}

void append(std::vector<Phone>& phones, Phone phone) {
  const bool silent = phone.label == kSilence;
  phone.word = silent ? std::string() : clean_word(phone.word);
  if (phone.word.empty()) phone.link = WordLink::automatic;
  if (silent && !phones.empty() && phones.back().label == kSilence) {
    phones.back().end = phone.end;
  } else {
    phones.push_back(std::move(phone));
  }
}

// Ends the last phone at `end`, which differs by rounding only: the later entry of the file
// decides. Halves of a very short affricate may begin after it and go.
void move_end(std::vector<Phone>& phones, double end) {
  while (phones.size() > 1 && phones.back().start >= end) phones.pop_back();
  phones.back().end = end;
}

// One interval with the phones of its label.
void append(std::vector<Phone>& phones, const TimedLabel& raw, double start, const Labels& labels) {
  if (labels.empty()) {  // a lone length mark: the sound before it goes on
    if (phones.empty()) {
      append(phones, {start, raw.end, std::string(kSilence), {}});
    } else {
      phones.back().end = raw.end;
    }
    return;
  }
  double share = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double from = i == 0 ? start : phones.back().end;
    share += labels[i].share;
    const double to = i + 1 == labels.size() ? raw.end : start + share * (raw.end - start);
    const WordLink link = i == 0 ? raw.link : WordLink::automatic;
    if (to > from) append(phones, {from, to, std::string(labels[i].label), raw.word, link});
  }
}

}  // namespace

// A label is a vowel with its glides, or consonants that are said together ("ts"), not a syllable
// and not any word that can be spelt: "qqq" and "abc" are no sounds.
bool is_one_sound(std::string_view label, const std::vector<IpaPhone>& labels) {
  for (std::size_t i = 2; i < label.size(); ++i) {
    const bool letter = static_cast<unsigned char>(label[i] | 0x20) - unsigned('a') < 26;
    if (letter && label[i] == label[i - 1] && label[i] == label[i - 2]) return false;
  }
  std::size_t consonants = 0, vowels = 0, after_vowel = 0;
  for (const IpaPhone& phone : labels) {
    const std::string_view name = phone.label;
    const bool vowel = find_phone(name)->vowel;
    const bool glide = name == "W" || name == "Y" || name == "R";
    const bool nasal = name == "L" || name == "N" || name == "M" || name == "NG";
    if (vowel && (consonants > 0 || after_vowel > 0)) return false;
    if (!vowel && !glide && vowels > 0 && (!nasal || ++after_vowel > 1)) return false;
    vowels += vowel ? 1 : 0;
    consonants += vowel || glide || vowels > 0 ? 0 : 1;
  }
  return consonants <= 2 && vowels <= 3;
}

bool has_words(const Timings& timings) {
  return std::any_of(timings.labels.begin(), timings.labels.end(),
                     [](const TimedLabel& label) { return label.is_word; });
}

Result<Script> make_script(const Timings& timings) {
  std::vector<TimedLabel> raw = timings.labels;
  drop_empty_pauses(raw);
  if (raw.empty()) {
    return make_error(Code::truncated, "the script holds no phones; align or type at least one");
  }
  if (has_words(timings)) {
    return make_error(Code::unsupported,
                      "these are words with times but without phones; for pronunciation use "
                      "`animeme speak --script`");
  }
  phones_of_sets_to_ipa(raw);
  join_closures(raw);
  Alphabet usual = timings.alphabet;
  if (usual == Alphabet::automatic) usual = guess_alphabet(raw);
  const auto alphabet_of = [&](const TimedLabel& phone) {
    return phone.alphabet == Alphabet::automatic ? usual : phone.alphabet;
  };
  std::map<std::pair<std::string_view, Alphabet>, Labels> mapped;
  for (const TimedLabel& phone : raw) {
    const Alphabet alphabet = alphabet_of(phone);
    if (mapped.contains({phone.label, alphabet})) continue;
    auto labels = map_label(phone.label, alphabet);
    if (!labels) return unknown_label(phone, alphabet);
    mapped.emplace(std::pair(std::string_view(phone.label), alphabet), *std::move(labels));
  }
  Script script;
  const TimedLabel* before = nullptr;
  for (const TimedLabel& phone : raw) {
    if (const auto error = check_times(phone)) return *error;
    if (before != nullptr) {
      if (const auto error = check_order(*before, phone)) return *error;
    }
    const double reached = script.duration();
    double start = phone.start;
    if (start - reached > kTimeTolerance) {
      append(script.phones, {reached, start, std::string(kSilence), {}});
    } else if (before == nullptr) {
      start = 0;
    } else {
      move_end(script.phones, start);
    }
    append(script.phones, phone, start, mapped[{phone.label, alphabet_of(phone)}]);
    before = &phone;
  }
  return script;
}

}  // namespace animeme::dam

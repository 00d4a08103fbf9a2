// Phone sets that are neither ARPAbet nor IPA: pinyin with tones, Japanese as Julius and Open JTalk
// write it.
#include <algorithm>
#include <iterator>

#include "dam/script/phones.h"
#include "dam/script/script_readers_internal.h"

namespace animeme::dam {
namespace {

struct SetPhone {
  std::string_view label, ipa;
};

constexpr SetPhone kPinyin[] = {
    {"b", "p"},     {"p", "pʰ"},     {"m", "m"},      {"f", "f"},     {"d", "t"},
    {"t", "tʰ"},    {"n", "n"},      {"l", "l"},      {"g", "k"},     {"k", "kʰ"},
    {"h", "x"},     {"j", "tɕ"},     {"q", "tɕʰ"},    {"x", "ɕ"},     {"zh", "tʂ"},
    {"ch", "tʂʰ"},  {"sh", "ʂ"},     {"r", "ɻ"},      {"z", "ts"},    {"c", "tsʰ"},
    {"s", "s"},     {"y", "j"},      {"w", "w"},      {"a", "a"},     {"o", "o"},
    {"e", "ɤ"},     {"i", "i"},      {"u", "u"},      {"v", "y"},     {"ii", "ɨ"},
    {"iii", "ɨ"},   {"ai", "aɪ"},    {"ei", "eɪ"},    {"ao", "aʊ"},   {"ou", "oʊ"},
    {"an", "an"},   {"en", "ən"},    {"ang", "aŋ"},   {"eng", "əŋ"},  {"ong", "ʊŋ"},
    {"er", "ɚ"},    {"rr", "ɚ"},     {"ia", "ja"},    {"ie", "je"},   {"iao", "jaʊ"},
    {"iu", "joʊ"},  {"iou", "joʊ"},  {"ian", "jɛn"},  {"in", "in"},   {"iang", "jaŋ"},
    {"ing", "iŋ"},  {"iong", "jʊŋ"}, {"io", "jo"},    {"ua", "wa"},   {"uo", "wo"},
    {"uai", "waɪ"}, {"ui", "weɪ"},   {"uei", "weɪ"},  {"uan", "wan"}, {"un", "wən"},
    {"uen", "wən"}, {"uang", "waŋ"}, {"ueng", "wəŋ"}, {"ve", "ɥe"},   {"ue", "ɥe"},
    {"van", "ɥɛn"}, {"vn", "yn"},    {"ng", "ŋ"},     {"ê", "ɛ"},     {"ü", "y"},
    {"üe", "ɥe"},   {"ün", "yn"},    {"üan", "ɥɛn"}};

constexpr SetPhone kJapanese[] = {
    {"a", "a"},   {"i", "i"},   {"u", "ɯ"},   {"e", "e"},   {"o", "o"},   {"a:", "aː"},
    {"i:", "iː"}, {"u:", "ɯː"}, {"e:", "eː"}, {"o:", "oː"}, {"A", "a"},   {"I", "i"},
    {"U", "ɯ"},   {"E", "e"},   {"O", "o"},   {"k", "k"},   {"ky", "kʲ"}, {"kw", "kʷ"},
    {"g", "ɡ"},   {"gy", "ɡʲ"}, {"gw", "ɡʷ"}, {"s", "s"},   {"sh", "ɕ"},  {"sy", "ɕ"},
    {"z", "z"},   {"j", "dʑ"},  {"zy", "dʑ"}, {"jy", "dʑ"}, {"t", "t"},   {"ts", "ts"},
    {"ch", "tɕ"}, {"ty", "tʲ"}, {"cy", "tɕ"}, {"d", "d"},   {"dy", "dʲ"}, {"dz", "dz"},
    {"n", "n"},   {"ny", "ɲ"},  {"h", "h"},   {"hy", "ç"},  {"f", "ɸ"},   {"fy", "ɸʲ"},
    {"b", "b"},   {"by", "bʲ"}, {"p", "p"},   {"py", "pʲ"}, {"m", "m"},   {"my", "mʲ"},
    {"r", "ɾ"},   {"ry", "ɾʲ"}, {"w", "w"},   {"y", "j"},   {"v", "b"},   {"N", "ŋ"},
    {"q", "cl"},  {"Q", "cl"},  {"cl", "cl"}};

// Without tone and without Kaldi's place in the word.
std::string_view base_of(std::string_view label) {
  if (label.size() > 2 && label[label.size() - 2] == '_') label.remove_suffix(2);
  if (label.size() > 1 && label.back() >= '0' && label.back() <= '5') label.remove_suffix(1);
  return label;
}

bool has_tone(std::string_view label) { return base_of(label).size() < label.size(); }

const SetPhone* find_in_set(std::span<const SetPhone> set, std::string_view label) {
  const auto found = std::find_if(set.begin(), set.end(),
                                  [&](const SetPhone& phone) { return phone.label == label; });
  return found == set.end() ? nullptr : &*found;
}

bool is_arpabet(std::string_view label) { return !arpabet_label(label).empty(); }

// Every label is of the set, and ARPAbet would not do.
bool is_pinyin(const std::vector<TimedLabel>& labels) {
  bool needed = false;
  for (const TimedLabel& label : labels) {
    if (is_silence_spelling(label.label)) continue;
    if (find_in_set(kPinyin, base_of(label.label)) == nullptr) return false;
    needed = needed || (has_tone(label.label) && !is_arpabet(label.label));
  }
  return needed;
}

bool is_japanese(const std::vector<TimedLabel>& labels) {
  bool vowels = false, needed = false;
  for (const TimedLabel& label : labels) {
    const std::string_view name = label.label;
    needed = needed || name == "silB" || name == "silE" || name == "cl";
    if (is_silence_spelling(name)) continue;
    if (find_in_set(kJapanese, name) == nullptr) return false;
    vowels = vowels || name == "a" || name == "o" || name == "u" || name == "i" || name == "e";
    needed = needed || (name.size() == 2 && name[1] == 'y') || name == "sh" || name == "ch";
  }
  return vowels && needed;
}

bool closes_lips(std::string_view label) {
  return label.starts_with('b') || label.starts_with('p') || label.starts_with('m');
}

}  // namespace

bool is_phone_of_a_set(std::string_view label) {
  return has_tone(label) && find_in_set(kPinyin, base_of(label)) != nullptr;
}

void phones_of_sets_to_ipa(std::vector<TimedLabel>& labels) {
  const bool pinyin = is_pinyin(labels);
  if (!pinyin && !is_japanese(labels)) return;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    TimedLabel& label = labels[i];
    const bool moraic = !pinyin && label.label == "N" && i + 1 < labels.size();
    const SetPhone* phone =
        pinyin ? find_in_set(kPinyin, base_of(label.label)) : find_in_set(kJapanese, label.label);
    if (phone == nullptr) continue;
    // The n that is a beat of its own is said where the next consonant is.
    label.label = moraic && closes_lips(labels[i + 1].label) ? "m" : phone->ipa;
    label.alphabet = Alphabet::ipa;
  }
}

}  // namespace animeme::dam

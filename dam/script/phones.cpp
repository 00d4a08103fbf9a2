#include "dam/script/phones.h"

#include <algorithm>
#include <string>
#include <vector>

#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

using enum PhoneClass;

// label, IPA, viseme at start and end, class, vowel, bilabial, labiodental, rounded.
constexpr std::array<PhoneInfo, kPhoneCount> kPhones = {{
    {"SIL", "", 0, 0, silence, false, false, false, false},
    {"AA", "ɑ", 10, 10, open_vowel, true, false, false, false},
    {"AE", "æ", 11, 11, mid_vowel, true, false, false, false},
    {"AH", "ʌ", 10, 10, open_vowel, true, false, false, false},
    {"AO", "ɔ", 13, 13, open_vowel, true, false, false, true},
    {"AW", "aʊ", 10, 14, open_vowel, true, false, false, true},
    {"AX", "ə", 11, 11, mid_vowel, true, false, false, false},
    {"AY", "aɪ", 10, 12, open_vowel, true, false, false, false},
    {"B", "b", 1, 1, bilabial, false, true, false, false},
    {"CH", "tʃ", 6, 6, postalveolar, false, false, false, true},
    {"D", "d", 4, 4, alveolar, false, false, false, false},
    {"DH", "ð", 3, 3, dental, false, false, false, false},
    {"EH", "ɛ", 11, 11, mid_vowel, true, false, false, false},
    {"ER", "ɝ", 9, 9, rounded_glide, true, false, false, true},
    {"EY", "eɪ", 11, 12, mid_vowel, true, false, false, false},
    {"F", "f", 2, 2, labiodental, false, false, true, false},
    {"G", "ɡ", 5, 5, velar, false, false, false, false},
    {"HH", "h", 0, 0, velar, false, false, false, false},
    {"IH", "ɪ", 12, 12, close_front, true, false, false, false},
    {"IY", "i", 12, 12, close_front, true, false, false, false},
    {"JH", "dʒ", 6, 6, postalveolar, false, false, false, true},
    {"K", "k", 5, 5, velar, false, false, false, false},
    {"L", "l", 8, 8, alveolar, false, false, false, false},
    {"M", "m", 1, 1, bilabial, false, true, false, false},
    {"N", "n", 8, 8, alveolar, false, false, false, false},
    {"NG", "ŋ", 5, 5, velar, false, false, false, false},
    {"OW", "oʊ", 13, 14, rounded_vowel, true, false, false, true},
    {"OY", "ɔɪ", 13, 12, rounded_vowel, true, false, false, true},
    {"P", "p", 1, 1, bilabial, false, true, false, false},
    {"R", "ɹ", 9, 9, rounded_glide, false, false, false, true},
    {"S", "s", 7, 7, alveolar, false, false, false, false},
    {"SH", "ʃ", 6, 6, postalveolar, false, false, false, true},
    {"T", "t", 4, 4, alveolar, false, false, false, false},
    {"TH", "θ", 3, 3, dental, false, false, false, false},
    {"UH", "ʊ", 14, 14, rounded_vowel, true, false, false, true},
    {"UW", "u", 14, 14, rounded_vowel, true, false, false, true},
    {"V", "v", 2, 2, labiodental, false, false, true, false},
    {"W", "w", 14, 14, rounded_glide, false, false, false, true},
    {"Y", "j", 12, 12, velar, false, false, false, false},
    {"Z", "z", 7, 7, alveolar, false, false, false, false},
    {"ZH", "ʒ", 6, 6, postalveolar, false, false, false, true},
}};

constexpr std::array<std::string_view, kPhoneClassCount> kClassNames = {
    "silence",      "bilabial",      "labiodental", "dental",    "alveolar",    "velar",
    "postalveolar", "rounded_glide", "open_vowel",  "mid_vowel", "close_front", "rounded_vowel"};

// Pauses, breaths and noises as the common aligners write them, in lower case.
constexpr std::string_view kSilences[] = {
    "",      "sil",  "silence", "sp",      "spn",   "nsn",  "pau",    "h#",     "#h",
    "#",     "_",    "__",      "_:",      "epi",   "brth", "<sil>",  "<s>",    "</s>",
    "<p>",   "<p:>", "<eps>",   "<sp>",    "<spn>", "{sl}", "{sp}",   "xxx>",   "silb",
    "sile",  "silp", "<p:",     "<pause>", "<#>",   "(.)",  "(..)",   "[sil]",  "{sil}",
    "<pau>", "+",    "##",      "vcl",     "[sp]",  "cl",   "<silb>", "<sile>", "(sil)"};

struct Alias {
  std::string_view spelling, label;
};

// Allophones of TIMIT and of older ARPAbet dictionaries.
constexpr Alias kAliases[] = {{"AXR", "ER"}, {"IX", "IH"}, {"UX", "UW"},   {"DX", "D"},
                              {"NX", "N"},   {"EL", "L"},  {"EM", "M"},    {"EN", "N"},
                              {"ENG", "NG"}, {"HV", "HH"}, {"AX-H", "AX"}, {"OH", "AO"},
                              {"Q", "HH"},   {"BCL", "B"}, {"PCL", "P"},   {"DCL", "D"},
                              {"TCL", "T"},  {"GCL", "G"}, {"KCL", "K"}};

char upper(char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; }

// Kaldi says where in a word a phone stands: hh_B, ih1_I, t_E, ax_S.
bool is_placed(std::string_view spelling) {
  return spelling.size() > 2 && spelling[spelling.size() - 2] == '_' &&
         std::string_view("BIES").find(spelling.back()) != std::string_view::npos;
}

}  // namespace

std::span<const PhoneInfo, kPhoneCount> phones() { return kPhones; }

const PhoneInfo* find_phone(std::string_view label) {
  // By alphabet behind silence.
  const auto found =
      std::partition_point(kPhones.begin() + 1, kPhones.end(),
                           [&](const PhoneInfo& phone) { return phone.label < label; });
  if (found != kPhones.end() && found->label == label) return &*found;
  return label == kPhones[0].label ? &kPhones[0] : nullptr;
}

std::string_view phone_class_name(PhoneClass phone_class) {
  const auto index = std::size_t(phone_class);
  return index < kClassNames.size() ? kClassNames[index] : std::string_view();
}

bool is_silence_spelling(std::string_view spelling) {
  if (spelling.size() > 10) return false;
  std::string text = lower_case(spelling);
  if (is_placed(spelling)) text.resize(text.size() - 2);
  return std::find(std::begin(kSilences), std::end(kSilences), text) != std::end(kSilences);
}

std::string_view arpabet_label(std::string_view spelling) {
  if (is_placed(spelling)) spelling.remove_suffix(2);
  if (is_silence_spelling(spelling)) return kPhones[0].label;
  if (spelling.size() > 5) return {};
  std::string text(spelling);
  std::transform(text.begin(), text.end(), text.begin(), upper);
  const bool stressed = text.size() > 2 && text.back() >= '0' && text.back() <= '3';
  if (stressed) text.pop_back();
  for (const Alias& alias : kAliases) {
    if (alias.spelling == text) return alias.label;
  }
  const PhoneInfo* phone = find_phone(text);
  if (phone == nullptr || (stressed && !phone->vowel)) return {};
  return phone->label;
}

std::string_view nearest_label(std::string_view spelling) {
  std::string text(spelling.substr(0, 8));
  std::transform(text.begin(), text.end(), text.begin(), upper);
  const auto cost = [&](const PhoneInfo& phone) {
    const bool same_start = !text.empty() && text[0] == phone.label[0];
    return 2 * edit_distance(text, phone.label) + (same_start ? 0 : 1);
  };
  const PhoneInfo* best = &kPhones[0];
  for (const PhoneInfo& phone : kPhones) {
    if (cost(phone) < cost(*best)) best = &phone;
  }
  return best->label;
}

}  // namespace animeme::dam

#include "dam/script/ipa.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "dam/script/ipa_table_internal.h"
#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

constexpr char32_t kRaised = 0x31D;       // r with it is the Czech fricative
constexpr char32_t kCedilla = 0x327;      // c with it is a letter
constexpr char32_t kNonSyllabic = 0x32F;  // a vowel with it is a glide
constexpr char32_t kLabialised = U'ʷ';

bool is_combining(char32_t code) { return code >= 0x300 && code <= 0x36F; }
bool is_digit(char32_t code) { return code >= U'0' && code <= U'9'; }
bool is_ignored(char32_t code) {
  return is_combining(code) || kIpaIgnored.find(code) != std::u32string_view::npos;
}

char32_t decompose(char32_t code) {
  const auto found =
      std::find_if(std::begin(kComposedLetters), std::end(kComposedLetters),
                   [&](const ComposedLetter& candidate) { return candidate.letter == code; });
  return found == std::end(kComposedLetters) ? code : found->base;
}

// Code points with ç composed; X-SAMPA diacritics and tone digits are gone.
std::u32string prepare(std::string_view text) {
  std::u32string out;
  bool has_letter = false;
  while (!text.empty()) {
    const char32_t code = decompose(take_code_point(text));
    if (code == kCedilla && !out.empty() && out.back() == U'c') {
      out.back() = U'ç';
    } else if (code == U'_') {  // an X-SAMPA diacritic: the sign and the one behind it
      if (!text.empty()) take_code_point(text);
    } else if (!(is_digit(code) && has_letter)) {  // a digit behind a letter is a tone
      out += code;
      has_letter = has_letter || !is_ignored(code);
    }
  }
  return out;
}

struct WideEntry {
  std::u32string letters;
  const IpaEntry* entry;
};

const std::vector<WideEntry>& wide_entries() {
  static const std::vector<WideEntry> entries = [] {
    std::vector<WideEntry> all;
    for (const IpaEntry& entry : kIpaEntries) {
      std::string_view rest = entry.letters;
      WideEntry& wide = all.emplace_back(WideEntry{{}, &entry});
      while (!rest.empty()) wide.letters += take_code_point(rest);
    }
    return all;
  }();
  return entries;
}

// How many code points from `at` the letters cover, marks between them skipped; 0: no fit.
std::size_t match(std::u32string_view text, std::size_t at, std::u32string_view letters) {
  std::size_t i = at;
  for (const char32_t letter : letters) {
    while (i > at && i < text.size() && text[i] != letter && is_ignored(text[i])) ++i;
    if (i >= text.size() || text[i] != letter) return 0;
    ++i;
  }
  return i - at;
}

struct Match {
  const IpaEntry* entry = nullptr;
  std::size_t letters = 0, length = 0;
};

Match longest_match(std::u32string_view text, std::size_t at) {
  Match best;
  for (const WideEntry& wide : wide_entries()) {
    if (wide.letters.size() <= best.letters) continue;
    const std::size_t length = match(text, at, wide.letters);
    if (length > 0) best = {wide.entry, wide.letters.size(), length};
  }
  return best;
}

bool has_mark(std::u32string_view text, std::size_t at, char32_t mark) {
  for (; at < text.size() && is_ignored(text[at]); ++at) {
    if (text[at] == mark) return true;
  }
  return false;
}

// The label of a match, changed by the marks that follow it.
std::string_view label_of(const Match& found, std::u32string_view text, std::size_t after) {
  const std::string_view label = found.entry->label;
  if (label == "R" && has_mark(text, after, kRaised)) return "ZH";
  if (has_mark(text, after, kNonSyllabic)) {
    if (label == "IY" || label == "IH") return "Y";
    if (label == "UW" || label == "UH") return "W";
  }
  return label;
}

bool can_be_aspirated(std::string_view label) {
  constexpr std::string_view kStops[] = {"P", "B", "T", "D", "K", "G", "CH", "JH"};
  return std::find(std::begin(kStops), std::end(kStops), label) != std::end(kStops);
}

Error unknown_letter(char32_t code) {
  constexpr char kHex[] = "0123456789ABCDEF";
  std::string number;
  for (int shift = code > 0xFFFF ? 20 : 12; shift >= 0; shift -= 4) {
    number += kHex[code >> shift & 0xF];
  }
  std::string letter;
  if (code >= 0x20 && code != 0x7F) append_utf8(letter, code);
  return make_error(Code::not_found, "the letter \"" + letter + "\" (U+" + number +
                                         ") is neither IPA nor X-SAMPA; write the sound with the "
                                         "letters of the IPA chart");
}

void add(std::vector<std::string_view>& labels, std::string_view label) {
  if (label.empty()) return;
  if (labels.empty() || labels.back() != label) labels.push_back(label);
}

}  // namespace

Result<std::vector<IpaPhone>> parse_ipa(std::string_view text, std::size_t most_bytes) {
  if (text.size() > most_bytes) {
    return make_error(Code::out_of_range,
                      "more than " + std::to_string(most_bytes) +
                          " bytes of IPA for one sound; give one label a sound");
  }
  const std::u32string codes = prepare(text);
  std::vector<std::string_view> labels;
  std::size_t at = 0;
  while (at < codes.size()) {
    const Match found = longest_match(codes, at);
    if (found.entry == nullptr) {
      if (!is_ignored(codes[at])) return unknown_letter(codes[at]);
      ++at;
      continue;
    }
    at += found.length;
    add(labels, label_of(found, codes, at));
    add(labels, found.entry->second);
    const PhoneInfo* phone = find_phone(labels.back());
    if (!phone->vowel && has_mark(codes, at, kLabialised)) add(labels, "W");
    if (at < codes.size() && codes[at] == U'h' && can_be_aspirated(phone->label)) ++at;
  }
  std::vector<IpaPhone> phones;
  for (const std::string_view label : labels) {
    phones.push_back({label, 1.0 / double(labels.size())});
  }
  return phones;
}

}  // namespace animeme::dam

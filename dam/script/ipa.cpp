#include "dam/script/ipa.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "dam/script/ipa_letters_internal.h"
#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"

namespace animeme::dam {
namespace {

constexpr char32_t kCedilla = 0x327;  // c with it is a letter

// A letter with its marks.
struct ParsedLetter {
  char32_t letter = 0;
  Features features;
  bool lengthened = false;
  bool changed = false;    // a mark says that the letter is not what it is by itself
  std::string_view after;  // what the end of the sound adds: W, R, nothing
};

std::u32string code_points(std::string_view text) {
  std::u32string codes;
  while (!text.empty()) {
    const char32_t code = without_accent(take_code_point(text));
    if (code == kCedilla && !codes.empty() && codes.back() == U'c') {
      codes.back() = U'ç';
    } else if (code == U'ʦ' || code == U'ʣ') {  // ligatures that ARPAbet has no phone for
      codes += code == U'ʦ' ? U"ts" : U"dz";
    } else {
      codes += code;
    }
  }
  return codes;
}

const XSampa* longest_x_sampa(std::u32string_view rest) {
  const XSampa* best = nullptr;
  for (const XSampa& row : x_sampa()) {
    if (rest.starts_with(row.text) && (best == nullptr || row.text.size() > best->text.size())) {
      best = &row;
    }
  }
  return best;
}

// IPA alone; tone digits are gone.
std::u32string prepare(std::string_view text) {
  const std::u32string codes = code_points(text);
  std::u32string out;
  bool has_letter = false;
  for (std::size_t at = 0; at < codes.size();) {
    const char32_t code = codes[at];
    if (has_letter && code >= U'0' && code <= U'9') {  // a digit behind a letter is a tone
      ++at;
      continue;
    }
    const XSampa* row = longest_x_sampa(std::u32string_view(codes).substr(at));
    if (row == nullptr && code == U'_') {  // a diacritic that lips do not show: two characters
      at += 2;
      continue;
    }
    out += row != nullptr ? row->ipa : code;
    at += row != nullptr ? row->text.size() : 1;
    has_letter = has_letter || find_ipa_letter(out.back()) != nullptr;
  }
  return out;
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

void round_end(ParsedLetter& heard) {
  if (heard.features.manner == Manner::vowel) {
    heard.features.rounding = 1;
    heard.changed = true;
  } else if (heard.features.rounding < 0.5) {
    heard.after = "W";
  }
}

// The vowel of "bird" is one sound with its r, others are followed by one.
void colour(ParsedLetter& heard) {
  Features& f = heard.features;
  if (f.manner != Manner::vowel || f.rhotic) return;
  const bool like_bird = f.height > 0.3 && f.height < 0.6 && f.backness == 0.5 && f.rounding == 0;
  heard.changed = true;
  if (like_bird) {
    f = find_ipa_letter(U'ɝ')->features;
  } else {
    heard.after = "R";
  }
}

void make_glide(ParsedLetter& heard) {
  const Features& f = heard.features;
  if (f.manner != Manner::vowel || f.height < 0.8) return;
  const char32_t letter = f.rounding < 0.5 ? U'j' : f.backness < 0.36 ? U'ɥ' : U'w';
  heard.letter = letter;
  heard.features = find_ipa_letter(letter)->features;
}

// Raised as in Czech ř, an r becomes a fricative.
void raise(ParsedLetter& heard, double by) {
  Features& f = heard.features;
  heard.changed = true;
  if (f.manner == Manner::vowel) f.height = std::clamp(f.height + by, 0.0, 1.0);
  if (f.manner != Manner::vowel && f.rhotic && by > 0) {
    const bool voiced = f.voiced;
    f = find_ipa_letter(U'ʒ')->features;
    f.voiced = voiced;
  }
}

void change(ParsedLetter& heard, IpaMark mark) {
  constexpr double kStep = 0.1, kLipStep = 0.3;
  Features& f = heard.features;
  const Features before = f;
  const double drawn = f.manner == Manner::vowel ? 0.15 : 0;
  if (mark == IpaMark::lengthened) heard.lengthened = true;
  if (mark == IpaMark::labialised) round_end(heard);
  if (mark == IpaMark::more_rounded) f.rounding = std::min(f.rounding + kLipStep, 1.0);
  if (mark == IpaMark::less_rounded) f.rounding = std::max(f.rounding - kLipStep, 0.0);
  if (mark == IpaMark::raised) raise(heard, kStep);
  if (mark == IpaMark::lowered) raise(heard, -kStep);
  if (mark == IpaMark::advanced) f.backness = std::max(f.backness - drawn, 0.0);
  if (mark == IpaMark::retracted) f.backness = std::min(f.backness + drawn, 1.0);
  if (mark == IpaMark::centralised && drawn > 0) f.backness = (f.backness + 0.5) / 2;
  if (mark == IpaMark::voiceless) f.voiced = false;
  if (mark == IpaMark::voiced) f.voiced = true;
  if (mark == IpaMark::non_syllabic) make_glide(heard);
  if (mark == IpaMark::rhotic) colour(heard);
  heard.changed = heard.changed || !(f == before);
}

// A raised nasal behind a letter is how that one ends.
bool is_release(char32_t code) { return code == U'ⁿ' || code == U'ᵐ' || code == U'ᵑ'; }

Result<std::vector<ParsedLetter>> hear(std::u32string_view codes) {
  std::vector<ParsedLetter> heard;
  for (const char32_t code : codes) {
    if (const IpaLetter* letter = find_ipa_letter(code)) {
      if (is_release(code) && !heard.empty()) continue;
      heard.push_back({code, letter->features, false, false, {}});
    } else if (const IpaMark* mark = find_ipa_mark(code)) {
      if (!heard.empty()) change(heard.back(), *mark);
    } else {
      return unknown_letter(code);
    }
  }
  return heard;
}

struct EnglishSpelling {
  std::u32string_view letters;  // ː asks for a long vowel
  std::string_view label, second;
};

// Vowels of English that dictionaries write otherwise than PhoneInfo::ipa.
constexpr EnglishSpelling kEnglish[] = {{U"ɜː", "ER", {}},
                                        {U"ɜːɹ", "ER", {}},
                                        {U"əɹ", "ER", {}},
                                        {U"əʊ", "OW", {}},
                                        {U"oːɹ", "AO", "R"}};

using Letters = std::span<const ParsedLetter>;

// How many letters of `heard` the spelling takes; 0: it is another one.
std::size_t spelled(Letters heard, std::u32string_view letters) {
  std::size_t count = 0;
  for (const char32_t letter : letters) {
    if (letter == U'ː') {
      if (!heard[count - 1].lengthened) return 0;
    } else if (count == heard.size() || heard[count].letter != letter || heard[count].changed) {
      return 0;
    } else {
      ++count;
    }
  }
  return count;
}

struct Match {
  std::size_t letters = 0;
  std::string_view label, second;
};

Match match_spelling(Letters heard) {
  Match best;
  const auto offer = [&](std::u32string_view letters, std::string_view label,
                         std::string_view second) {
    const std::size_t count = spelled(heard, letters);
    if (count > best.letters) best = {count, label, second};
  };
  for (const EnglishSpelling& row : kEnglish) offer(row.letters, row.label, row.second);
  for (const PhoneInfo& phone : phones()) {
    if (phone.ipa.empty()) continue;
    const std::u32string letters = code_points(phone.ipa);
    offer(letters, phone.label, {});
    if (letters == U"ɡ") offer(U"g", phone.label, {});
  }
  return best;
}

bool is_stop(const Features& f) { return f.manner == Manner::stop; }
bool is_affricate_end(const Features& f) {
  return f.manner == Manner::fricative && f.place > Place::alveolar && f.place < Place::palatal;
}

// A stop of the tip of the tongue and a hushing fricative are CH or JH.
std::string_view affricate_of(const Features& stop, const Features& end) {
  const bool tip = stop.place >= Place::dental && stop.place < Place::palatal;
  if (!is_stop(stop) || !tip || !is_affricate_end(end)) return {};
  return end.voiced ? "JH" : "CH";
}

// Two vowels that are one movement of ARPAbet, seen from the front: where the first is, and that
// the second is a close one. Lips distinguish u from i, but hardly show backness.
std::string_view diphthong_of(const ParsedLetter& first, const ParsedLetter& second) {
  constexpr double kNear = 0.52, kNearEnd = 0.4, kOfSide = 0.3, kOpen = 0.2;
  const auto gap = [](const Features& a, const Features& b) {
    return 2 * std::abs(std::max(a.rounding, 0.0) - b.rounding) +
           1.5 * std::abs(a.height - b.height) + kOfSide * std::abs(a.backness - b.backness);
  };
  const bool glide = second.letter == U'j' || second.letter == U'w';
  const bool closing = second.features.height > first.features.height + 0.05;
  if (first.features.manner != Manner::vowel || first.features.rhotic || second.lengthened ||
      !closing || (second.features.manner != Manner::vowel && !glide)) {
    return {};
  }
  std::string_view best;
  double least = kNear;
  for (const std::string_view label : {"AW", "AY", "EY", "OW", "OY"}) {
    const auto parts = phone_features(label);
    const Features& from = first.features;
    const bool alike = parts[0].height < kOpen ? from.height <= kOpen
                                               : std::abs(parts[0].backness - from.backness) < 0.5;
    const double start = gap(from, parts[0]);
    if (alike && start < least && gap(second.features, parts[1]) < kNearEnd) {
      best = label;
      least = start;
    }
  }
  return best;
}

void add(std::vector<IpaSound>& sounds, IpaSound sound) {
  if (sound.label.empty()) return;
  if (sounds.empty() || sounds.back().label != sound.label) sounds.push_back(std::move(sound));
}

std::vector<Features> features_of(Letters heard) {
  std::vector<Features> features;
  for (const ParsedLetter& one : heard) features.push_back(one.features);
  return features;
}

// Adds the sound that `heard` begins with; how many letters it has.
std::size_t add_sound(Letters heard, std::vector<IpaSound>& sounds) {
  const Match found = match_spelling(heard);
  if (found.letters < 2 && heard.size() > 1) {
    std::string_view label = affricate_of(heard[0].features, heard[1].features);
    if (label.empty()) label = diphthong_of(heard[0], heard[1]);
    if (!label.empty()) {
      add(sounds, {label, false, features_of(heard.first(2))});
      return 2;
    }
  }
  if (found.letters == 0) {
    add(sounds, {nearest_phone(heard[0].features), false, features_of(heard.first(1))});
    return 1;
  }
  const Letters said = heard.first(found.letters);
  add(sounds, {found.label, true, features_of(found.second.empty() ? said : said.first(1))});
  add(sounds, {found.second, true, features_of(said.last(1))});
  return found.letters;
}

bool can_be_aspirated(const Features& f) {
  return f.manner == Manner::stop || f.manner == Manner::affricate;
}

}  // namespace

std::string x_sampa_to_ipa(std::string_view text) {
  constexpr std::pair<std::u32string_view, char32_t> kMarks[] = {
      {U"\"", U'ˈ'},      {U"%", U'ˌ'},       {U":\\", U'ˑ'},     {U":", U'ː'}, {U"~", U'\u0303'},
      {U"=", U'\u0329'},  {U"_h", U'ʰ'},      {U"_j", U'ʲ'},      {U"'", U'ʲ'}, {U"g", U'ɡ'},
      {U"_~", U'\u0303'}, {U"_=", U'\u0329'}, {U"_}", U'\u031A'}, {U"`", U'˞'}, {U"_d", U'\u032A'}};
  constexpr std::u32string_view kOtherMarks = U"AaBceFGHklLMmNnqRTtXx?<>/";
  const std::u32string codes = code_points(text);
  std::string out;
  for (std::size_t at = 0; at < codes.size();) {
    const std::u32string_view rest = std::u32string_view(codes).substr(at);
    const auto mark = std::find_if(std::begin(kMarks), std::end(kMarks),
                                   [&](const auto& row) { return rest.starts_with(row.first); });
    const XSampa* letter = longest_x_sampa(rest);
    if (letter != nullptr) {
      append_utf8(out, letter->ipa);
      at += letter->text.size();
    } else if (mark != std::end(kMarks)) {
      append_utf8(out, mark->second);
      at += mark->first.size();
    } else if (rest[0] == U'_') {  // a mark that nobody hears, or a tie
      at += rest.size() > 1 && kOtherMarks.find(rest[1]) != kOtherMarks.npos ? 2 : 1;
    } else {
      if (rest[0] != U'-') append_utf8(out, rest[0]);
      ++at;
    }
  }
  return out;
}

Result<std::vector<IpaSound>> parse_ipa_sounds(std::string_view text, std::size_t most_bytes) {
  if (text.size() > most_bytes) {
    return make_error(Code::out_of_range,
                      "more than " + std::to_string(most_bytes) +
                          " bytes of IPA for one sound; use one label per sound");
  }
  const auto heard = hear(prepare(text));
  if (!heard) return heard.error();
  std::vector<IpaSound> sounds;
  for (std::size_t at = 0; at < heard->size();) {
    const std::size_t first = at;
    at += add_sound(Letters(*heard).subspan(at), sounds);
    const ParsedLetter& last = (*heard)[at - 1];
    if (last.after == "W") add(sounds, {"W", false, {find_ipa_letter(U'w')->features}});
    if (last.after == "R") add(sounds, {"R", false, {find_ipa_letter(U'ɹ')->features}});
    // "ph", "tʃh", "tsh": breath behind a stop.
    const bool stopped = can_be_aspirated((*heard)[first].features) ||
                         (first > 0 && last.features.manner == Manner::fricative &&
                          can_be_aspirated((*heard)[first - 1].features));
    if (at < heard->size() && (*heard)[at].letter == U'h' && stopped) ++at;
  }
  return sounds;
}

Result<std::vector<IpaPhone>> parse_ipa(std::string_view text, std::size_t most_bytes) {
  const auto sounds = parse_ipa_sounds(text, most_bytes);
  if (!sounds) return sounds.error();
  std::vector<IpaPhone> phones;
  for (const IpaSound& sound : *sounds) {
    phones.push_back({sound.label, 1.0 / double(sounds->size())});
  }
  return phones;
}

}  // namespace animeme::dam

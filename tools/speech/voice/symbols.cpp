#include "tools/speech/voice/symbols.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <span>

#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"
#include "tools/speech/voice/phoneme_table.h"
#include "tools/speech/voice/voice_job.h"

namespace animeme::voice {
namespace {

using dam::IpaSound;

Result<std::string> read_data(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || bytes.empty()) {
    return make_error(Code::not_found, "no " + path +
                                           "; install the Debian package espeak-ng-data or set the "
                                           "data path to the folder that contains espeak-ng-data");
  }
  return bytes;
}

// What the voice says for one symbol: no pauses, no changes of language.
std::string joined(const RawSpeech& raw) {
  std::string ipa;
  for (const VoiceEvent& event : raw.events) {
    const bool sound = event.kind == EventKind::phoneme && !event.ipa.starts_with('_') &&
                       !event.ipa.starts_with('(');
    if (sound) ipa += event.ipa;
  }
  return ipa;
}

bool is_vowel(const dam::Features& f) { return f.manner == dam::Manner::vowel; }
bool is_round(const dam::Features& f) { return is_vowel(f) && f.rounding > 0.5; }
bool is_flat(const dam::Features& f) {
  return is_vowel(f) && f.rounding == 0 && f.height == 1 && f.backness >= 0.5;
}

template <class Test>
bool hears(const VoiceSymbol& symbol, Test test) {
  return std::any_of(symbol.sounds.begin(), symbol.sounds.end(), [&](const IpaSound& sound) {
    return std::any_of(sound.heard.begin(), sound.heard.end(), test);
  });
}

template <class Test>
bool says(const VoiceSymbol& symbol, Test test) {
  return std::any_of(symbol.sounds.begin(), symbol.sounds.end(), [&](const IpaSound& sound) {
    const dam::PhoneInfo* phone = dam::find_phone(sound.label);
    return phone != nullptr && test(*phone);
  });
}

// Phonemes that are changed at the end of a word are looked at in front of these.
struct Behind {
  std::string_view mnemonic, ipa;
};
constexpr Behind kBehind[] = {{"@", "ə"}, {"t", "t"}};

std::vector<std::string_view> phones_named(std::string_view ipa) {
  std::vector<std::string_view> labels;
  const auto sounds = dam::parse_ipa_sounds(ipa);
  for (std::size_t i = 0; sounds && i < sounds->size(); ++i) labels.push_back((*sounds)[i].label);
  return labels;
}

// Of what a voice says for a phoneme, that which has the name of it: "b" of German is p by itself.
std::string as_named(const std::string& mnemonic, std::string alone,
                     std::span<const RawSpeech> in_front) {
  const auto name = phones_named(mnemonic);
  if (name.empty() || phones_named(alone) == name) return alone;
  for (std::size_t i = 0; i < in_front.size(); ++i) {
    std::string ipa = joined(in_front[i]);
    if (!ipa.ends_with(kBehind[i].ipa)) continue;
    ipa.resize(ipa.size() - kBehind[i].ipa.size());
    if (phones_named(ipa) == name) return ipa;
  }
  return alone;
}

// How different two sounds are for the ear.
double sound_distance(const dam::Features& a, const dam::Features& b) {
  constexpr double kOtherKind = 10, kManner = 1, kPlace = 0.3, kVoice = 0.6, kRhotic = 0.7;
  if (is_vowel(a) != is_vowel(b)) return kOtherKind;
  double distance = std::abs(a.rounding - b.rounding) + (a.rhotic != b.rhotic ? kRhotic : 0);
  if (is_vowel(a)) {
    return distance + 2 * std::abs(a.height - b.height) + 1.5 * std::abs(a.backness - b.backness);
  }
  distance += (a.manner != b.manner ? kManner : 0) + (a.voiced != b.voiced ? kVoice : 0);
  return distance + kPlace * std::abs(double(a.place) - double(b.place));
}

const VoiceSymbol* nearest_symbol(const std::vector<VoiceSymbol>& symbols,
                                  const dam::Features& sound) {
  const VoiceSymbol* best = nullptr;
  double least = 0;
  for (const VoiceSymbol& symbol : symbols) {
    if (symbol.sounds.size() != 1 || symbol.sounds[0].heard.size() != 1) continue;
    // Of those that sound alike the plain one: "r" and not "r/2".
    const double distance =
        sound_distance(symbol.sounds[0].heard[0], sound) + 0.001 * double(symbol.mnemonic.size());
    if (best == nullptr || distance < least) {
      best = &symbol;
      least = distance;
    }
  }
  return best;
}

// A letter with the marks behind it.
std::string_view letter_with_marks(std::string_view ipa) {
  std::string_view rest = ipa;
  dam::take_code_point(rest);
  while (!rest.empty()) {
    std::string_view ahead = rest;
    const char32_t code = dam::take_code_point(ahead);
    if ((code < 0x2B0 || code > 0x36F) || code == U'ˈ' || code == U'ˌ' || code == U'ː') break;
    rest = ahead;
  }
  return ipa.substr(0, ipa.size() - rest.size());
}

bool closes(const dam::PhoneInfo& phone) { return phone.bilabial; }
bool rounds(const dam::PhoneInfo& phone) { return phone.rounded; }

}  // namespace

Result<std::vector<VoiceSymbol>> voice_symbols(const VoiceOptions& options) {
  const auto voice = find_voice(options);
  if (!voice) return voice.error();
  const auto voice_file = read_data(voice->data_path + "/lang/" + voice->file);
  if (!voice_file) return voice_file.error();
  const auto phontab = read_data(voice->data_path + "/phontab");
  if (!phontab) return phontab.error();
  const auto phonemes = read_phoneme_table(*phontab, phoneme_table_name(*voice_file));
  if (!phonemes) return phonemes.error();

  EspeakJob job;
  job.voice = voice->identifier;
  job.options = options;
  job.mnemonics = true;
  for (const PhonemeName& phoneme : *phonemes) {
    job.texts.push_back("[[" + phoneme.mnemonic + "]]");
    for (const Behind& behind : kBehind) {
      job.texts.push_back("[[" + phoneme.mnemonic + "|" + std::string(behind.mnemonic) + "]]");
    }
  }
  const auto spoken = run_voice(job);
  if (!spoken) return spoken.error();
  std::vector<VoiceSymbol> symbols;
  for (std::size_t i = 0; i < phonemes->size(); ++i) {
    const PhonemeName& phoneme = (*phonemes)[i];
    const std::span<const RawSpeech> speech(spoken->speech);
    constexpr std::size_t kTexts = 1 + std::size(kBehind);
    const auto in_front = speech.subspan(i * kTexts + 1, std::size(kBehind));
    VoiceSymbol symbol{phoneme.mnemonic,
                       as_named(phoneme.mnemonic, joined(speech[i * kTexts]), in_front),
                       phoneme.bilabial,
                       true,
                       {}};
    auto sounds = dam::parse_ipa_sounds(symbol.ipa);
    symbol.known = sounds.has_value();
    if (sounds) symbol.sounds = *std::move(sounds);
    symbols.push_back(std::move(symbol));
  }
  return symbols;
}

std::string mnemonics_of(const std::string& voice, std::string_view ipa,
                         const VoiceOptions& options, std::vector<std::string>* replaced) {
  VoiceOptions wanted = options;
  wanted.language = voice;
  const auto symbols = voice_symbols(wanted);
  if (!symbols) return {};
  std::string out;
  bool any = false;
  while (!ipa.empty()) {
    std::string_view best, name;
    const auto consider = [&](std::string_view text, std::string_view mnemonic) {
      if (!text.empty() && text.size() > best.size() && ipa.starts_with(text)) {
        best = text;
        name = mnemonic;
      }
    };
    for (const VoiceSymbol& symbol : *symbols) consider(symbol.ipa, symbol.mnemonic);
    // Marks of IPA that espeak-ng writes otherwise, and letters that are written in two ways.
    constexpr std::pair<std::string_view, std::string_view> kMarks[] = {
        {"ˈ", "'"}, {"ˌ", ","},  {".", ""}, {"ː", ":"},    {"g", "g"},
        {"r", "r"}, {" ", "||"}, {"‿", ""}, {"\u0361", ""}};
    for (const auto& [text, mnemonic] : kMarks) consider(text, mnemonic);
    if (!best.empty()) {
      out += name;
      any = any || !name.empty();
      ipa.remove_prefix(best.size());
      continue;
    }
    const std::string_view letter = letter_with_marks(ipa);
    ipa.remove_prefix(letter.size());
    const auto sounds = dam::parse_ipa_sounds(letter);
    std::string instead;
    for (std::size_t i = 0; sounds && i < sounds->size(); ++i) {
      for (const dam::Features& heard : (*sounds)[i].heard) {
        const VoiceSymbol* nearest = nearest_symbol(*symbols, heard);
        if (nearest == nullptr) continue;
        out += nearest->mnemonic;
        instead += nearest->ipa;
      }
    }
    any = any || !instead.empty();
    // What is only a mark, such as a tone, says nothing.
    if (replaced != nullptr && !(sounds && sounds->empty())) {
      replaced->push_back(std::string(letter) + " as " + (instead.empty() ? "nothing" : instead));
    }
  }
  return any ? out : std::string();
}

void add_counts(const SymbolCounts& more, SymbolCounts& all) {
  all.exact += more.exact;
  all.features += more.features;
  all.marks += more.marks;
  all.unknown += more.unknown;
  all.bilabial += more.bilabial;
  all.closed += more.closed;
  all.round += more.round;
  all.rounded += more.rounded;
  all.flat += more.flat;
  all.unrounded += more.unrounded;
}

SymbolCounts count_symbols(const std::vector<VoiceSymbol>& symbols) {
  SymbolCounts counts;
  for (const VoiceSymbol& symbol : symbols) {
    const bool exact = std::all_of(symbol.sounds.begin(), symbol.sounds.end(),
                                   [](const IpaSound& sound) { return sound.exact; });
    ++(!symbol.known           ? counts.unknown
       : symbol.sounds.empty() ? counts.marks
       : exact                 ? counts.exact
                               : counts.features);
    // espeak-ng has phonemes that it says nothing for.
    const bool bilabial = symbol.bilabial && !(symbol.known && symbol.sounds.empty());
    counts.bilabial += bilabial;
    counts.closed += bilabial && says(symbol, closes);
    const bool round = hears(symbol, is_round), flat = hears(symbol, is_flat);
    counts.round += round;
    counts.rounded += round && says(symbol, rounds);
    counts.flat += flat && !round;
    counts.unrounded += flat && !round && !says(symbol, rounds);
  }
  return counts;
}

}  // namespace animeme::voice

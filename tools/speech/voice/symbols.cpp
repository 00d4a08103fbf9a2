#include "tools/speech/voice/symbols.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "dam/script/phones.h"
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
  for (const PhonemeName& phoneme : *phonemes) job.texts.push_back("[[" + phoneme.mnemonic + "]]");
  const auto spoken = run_voice(job);
  if (!spoken) return spoken.error();
  std::vector<VoiceSymbol> symbols;
  for (std::size_t i = 0; i < phonemes->size(); ++i) {
    const PhonemeName& phoneme = (*phonemes)[i];
    VoiceSymbol symbol{phoneme.mnemonic, joined(spoken->speech[i]), phoneme.bilabial, true, {}};
    auto sounds = dam::parse_ipa_sounds(symbol.ipa);
    symbol.known = sounds.has_value();
    if (sounds) symbol.sounds = *std::move(sounds);
    symbols.push_back(std::move(symbol));
  }
  return symbols;
}

std::string mnemonics_of(const std::string& voice, std::string_view ipa,
                         const VoiceOptions& options) {
  VoiceOptions wanted = options;
  wanted.language = voice;
  const auto symbols = voice_symbols(wanted);
  if (!symbols) return {};
  std::string out;
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
    if (best.empty()) return {};
    out += name;
    ipa.remove_prefix(best.size());
  }
  return out;
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

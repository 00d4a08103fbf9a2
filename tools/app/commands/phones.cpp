#include <algorithm>
#include <cstdio>

#include "tools/app/commands/common.h"
#include "tools/app/commands/head_options.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/speech/talking/spoken.h"
#include "tools/speech/voice/letters.h"
#include "tools/speech/voice/symbols.h"
#include "tools/view/plot/curves.h"
#include "tools/view/studio/vowel_chart.h"

namespace animeme::tools {

namespace {

struct PhonesOptions {
  std::string language = "en";
  bool all = false;
  bool json = false;
  std::string sheet;  // empty: none
  std::string model;  // empty: the built-in one
  studio::HeadChoice head;
};

std::string_view match_name(const voice::VoiceSymbol& symbol) {
  if (!symbol.known) return "unknown";
  if (symbol.sounds.empty()) return "mark";
  for (const dam::IpaSound& sound : symbol.sounds) {
    if (!sound.exact) return "features";
  }
  return "exact";
}

std::string labels_of(const voice::VoiceSymbol& symbol) {
  std::string text;
  for (const dam::IpaSound& sound : symbol.sounds) {
    text += (text.empty() ? "" : " ") + std::string(sound.label);
  }
  return text;
}

std::string features_of(const voice::VoiceSymbol& symbol) {
  std::string text;
  for (const dam::IpaSound& sound : symbol.sounds) {
    for (const dam::Features& features : sound.heard) {
      text += (text.empty() ? "" : ", ") + dam::describe(features);
    }
  }
  return text;
}

Json json_of(const voice::VoiceSymbol& symbol) {
  Json phones = Json::array(), features = Json::array();
  for (const dam::IpaSound& sound : symbol.sounds) {
    phones.push_back(sound.label);
    for (const dam::Features& heard : sound.heard) features.push_back(dam::describe(heard));
  }
  return {{"symbol", symbol.mnemonic},
          {"ipa", symbol.ipa},
          {"phones", std::move(phones)},
          {"match", match_name(symbol)},
          {"features", std::move(features)}};
}

Json json_of(const voice::SymbolCounts& counts) {
  return {{"exact", counts.exact},
          {"features", counts.features},
          {"marks", counts.marks},
          {"unknown", counts.unknown},
          {"bilabial", counts.bilabial},
          {"bilabial_closed", counts.closed},
          {"round_vowels", counts.round},
          {"round_vowels_rounded", counts.rounded},
          {"close_unrounded_vowels", counts.flat},
          {"close_unrounded_vowels_unrounded", counts.unrounded}};
}

void print(const Json& json) { std::printf("%s\n", pretty(json).c_str()); }

// Columns count characters, not bytes.
std::string padded(std::string text, std::size_t width) {
  std::size_t characters = 0;
  for (const char c : text) characters += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  if (characters < width) text.append(width - characters, ' ');
  return text;
}

// Letters that are not spoken in the language of the voice, the first of them.
std::string foreign_letters(const voice::LetterCounts& letters) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(letters.foreign.size(), kShown); ++i) {
    text += " " + letters.foreign[i];
  }
  return letters.foreign.size() > kShown ? text + " ..." : text;
}

void print_row(const std::string& name, const voice::SymbolCounts& c,
               const voice::LetterCounts& letters) {
  const std::string own =
      letters.letters == 0 ? "-" : format("%zu/%zu", letters.spoken, letters.letters);
  std::printf("%s %5zu %8zu %5zu %7zu %9s %9s %9s %9s%s\n", padded(name, 24).c_str(), c.exact,
              c.features, c.marks, c.unknown, format("%zu/%zu", c.closed, c.bilabial).c_str(),
              format("%zu/%zu", c.rounded, c.round).c_str(),
              format("%zu/%zu", c.unrounded, c.flat).c_str(), own.c_str(),
              foreign_letters(letters).c_str());
}

Json json_of(const voice::LetterCounts& letters) {
  return {{"letters", letters.letters}, {"spoken", letters.spoken}, {"foreign", letters.foreign}};
}

Result<int> run_one(const PhonesOptions& options) {
  voice::VoiceOptions voice;
  voice.language = options.language;
  const auto symbols = voice::voice_symbols(voice);
  if (!symbols) return symbols.error();
  const voice::SymbolCounts counts = voice::count_symbols(*symbols);
  if (options.json) {
    Json list = Json::array();
    for (const voice::VoiceSymbol& symbol : *symbols) list.push_back(json_of(symbol));
    print({{"language", options.language}, {"counts", json_of(counts)}, {"symbols", list}});
    return kOk;
  }
  for (const voice::VoiceSymbol& symbol : *symbols) {
    std::printf("%s %s %s %s %s\n", padded(symbol.mnemonic, 6).c_str(),
                padded(symbol.ipa, 8).c_str(), padded(labels_of(symbol), 9).c_str(),
                padded(std::string(match_name(symbol)), 8).c_str(), features_of(symbol).c_str());
  }
  say(
      format("%zu symbols: %zu are phones of the models, %zu are mapped by features, %zu are marks "
             "without a sound, %zu are unknown",
             symbols->size(), counts.exact, counts.features, counts.marks, counts.unknown));
  return kOk;
}

Result<int> run_all(const PhonesOptions& options) {
  const auto voices = voice::list_voices();
  if (!voices) return voices.error();
  if (!options.json) {
    std::printf("%s %5s %8s %5s %7s %9s %9s %9s %9s\n", padded("voice", 24).c_str(), "exact",
                "features", "marks", "unknown", "bilabials", "u o y", "flat", "letters");
  }
  Json list = Json::array();
  voice::SymbolCounts all;
  voice::LetterCounts all_letters;
  for (const voice::VoiceInfo& info : *voices) {
    voice::VoiceOptions voice;
    voice.language = info.identifier;
    const auto symbols = voice::voice_symbols(voice);
    if (!symbols) return symbols.error();
    const voice::SymbolCounts counts = voice::count_symbols(*symbols);
    voice::add_counts(counts, all);
    const auto letters = voice::count_letters(voice);
    if (!letters) return letters.error();
    all_letters.letters += letters->letters;
    all_letters.spoken += letters->spoken;
    if (options.json) {
      list.push_back({{"voice", info.identifier},
                      {"counts", json_of(counts)},
                      {"letters", json_of(*letters)}});
    } else {
      print_row(info.identifier, counts, *letters);
    }
  }
  if (options.json) {
    print({{"counts", json_of(all)}, {"letters", json_of(all_letters)}, {"voices", list}});
  } else {
    print_row(format("all %zu", voices->size()), all, all_letters);
  }
  return kOk;
}

constexpr int kPhonePictureSize = 150;

// The vowels of the chart: a sheet of pictures, and their figures as a table or as JSON.
Result<int> run_sheet(const PhonesOptions& options) {
  const auto model = speech::read_model(options.model);
  if (!model) return model.error();
  const auto vowels = studio::chart_vowels(*model);
  if (!vowels) return vowels.error();
  const studio::HeadLook look{
      .head = options.head, .zoom = 2.4, .width = kPhonePictureSize, .height = kPhonePictureSize};
  const auto svg = studio::vowel_chart_svg(look, *vowels, terminal_log());
  if (!svg) return svg.error();
  const auto file = plot::drawing_bytes(options.sheet, *svg);
  if (!file) return file.error();
  if (auto written = write_file(options.sheet, *file); !written) return written.error();
  Json list = Json::array();
  for (const studio::ChartVowel& vowel : *vowels) {
    if (options.json) {
      list.push_back({{"ipa", vowel.ipa},
                      {"name", vowel.name},
                      {"phones", vowel.phones},
                      {"gap", vowel.gap},
                      {"width", vowel.width},
                      {"forward", vowel.forward}});
    } else {
      std::printf("%s %s gap %4.0f  width %+4.0f  forward %4.0f  %s\n",
                  padded(vowel.ipa, 2).c_str(), padded(vowel.phones, 6).c_str(), vowel.gap,
                  vowel.width, vowel.forward, vowel.name.c_str());
    }
  }
  if (options.json) print({{"vowels", list}});
  return kOk;
}

Result<int> run(const PhonesOptions& options) {
  if (!options.sheet.empty()) return run_sheet(options);
  return options.all ? run_all(options) : run_one(options);
}

void add_options(OptionTable& cli, PhonesOptions& options) {
  cli.add("--lang", options.language, "Language or voice of espeak-ng: de, pt-br ...")
      ->show_default();
  cli.add("--all-languages", options.all,
          "Print a row per voice: how many symbols are phones of the models, mapped by "
          "features, marks or unknown; how many bilabials close the lips, how many rounded "
          "vowels are rounded, how many close unrounded ones (flat) are not; how many "
          "letters of its language it reads")
      ->excludes("--lang");
  cli.add("--sheet", options.sheet,
          "Draw the vowels of the IPA chart as a model speaks them, on a head, and print their "
          "inner gap, width and protrusion in FAP units")
      ->output(".png .svg")
      ->excludes("--lang --all-languages");
  cli.add("--model", options.model,
          "Model file of a character for --sheet; default: the built-in model")
      ->needs("--sheet");
  add_head_options(cli, options.head);
  cli.add("--json", options.json, "Print a machine-readable table");
}

}  // namespace

const Command kPhones{
    "phones", "List the sounds of a voice: IPA, features, and the phones that are used for them",
    "  animeme phones --lang ru\n"
    "  animeme phones --lang sv --json\n"
    "  animeme phones --all-languages\n"
    "  animeme phones --sheet vowels.png --head man",
    set_up<PhonesOptions>};

}  // namespace animeme::tools

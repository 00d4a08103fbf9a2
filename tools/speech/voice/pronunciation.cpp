#include "tools/speech/voice/pronunciation.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {
namespace {

using Dictionary = std::map<std::string, std::vector<Labels>, std::less<>>;

constexpr std::size_t kMaxVariants = 8;
const std::string kLetterA = "a.";  // the dictionary's "a" is the article
const std::string kWeakTo = "to.";

std::string_view take_field(std::string_view& line) {
  line = dam::trimmed(line);
  const std::string_view field = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(field.size());
  return field;
}

// One line, if it is about a word of `wanted`. "read(2) R EH D" is a further way to say "read".
void read_line(std::string_view line, const std::set<std::string, std::less<>>& wanted,
               Dictionary& dictionary) {
  std::string_view name = take_field(line);
  const std::size_t bracket = name.find('(');
  if (bracket != std::string_view::npos && bracket > 0) name = name.substr(0, bracket);
  const std::string word = dam::lower_case(name);
  if (!wanted.contains(word)) return;
  Labels labels;
  for (std::string_view field = take_field(line); !field.empty(); field = take_field(line)) {
    const std::string_view label = dam::arpabet_label(field);
    if (label.empty() || label == dam::kSilence) return;
    labels.emplace_back(label);
  }
  if (labels.empty()) return;
  std::vector<Labels>& variants = dictionary[word];
  if (variants.size() < kMaxVariants) variants.push_back(std::move(labels));
}

Result<Dictionary> read_dictionary(const std::string& path,
                                   const std::set<std::string, std::less<>>& wanted) {
  std::ifstream file(path);
  if (!file) {
    return make_error(Code::not_found, "no pronunciation dictionary at " + path +
                                           "; install the Debian package pocketsphinx-en-us or "
                                           "set the path");
  }
  Dictionary dictionary;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    read_line(line, wanted, dictionary);
  }
  return dictionary;
}

// The model has the 39 phones of the dictionary; AX is its AH.
Labels for_recogniser(Labels labels) {
  std::replace(labels.begin(), labels.end(), std::string("AX"), std::string("AH"));
  return labels;
}

// Pictures and signs have no sound that all people agree on, and nor have, to an English voice,
// letters of other scripts than Latin: espeak-ng reads out their names.
bool can_be_said(std::string_view word, bool english) {
  constexpr char32_t kLatinEnds = 0x250, kArrows = 0x2190, kLettersAgain = 0x2C00,
                     kPictures = 0x1F000, kIdeographsAgain = 0x20000;
  while (!word.empty()) {
    const char32_t code = dam::take_code_point(word);
    if (english && code >= kLatinEnds) continue;
    if (code >= kArrows && code < kLettersAgain) continue;
    if (code >= kPictures && code < kIdeographsAgain) continue;
    return true;
  }
  return false;
}

// The words of a reading, if the dictionary may have all of them; else none, and a voice says the
// whole.
std::vector<std::string> words_of(std::string_view reading) {
  std::vector<std::string> words(1);
  for (const char c : reading) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '\'';
    if (letter) {
      words.back() += c;
    } else if (c == ' ' || c == '-') {
      if (!words.back().empty()) words.emplace_back();
    } else {
      return {};
    }
  }
  if (words.back().empty()) words.pop_back();
  // The letter a, as in "three a m"; alone it is the article.
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (i > 0 && words[i] == "to") words[i] = kWeakTo;
    if (words[i].size() == 1 && dam::lower_case(words[i]) == "a" && words[i + 1].size() == 1) {
      words[i] = kLetterA;
    }
  }
  return words;
}

// The ways to say a word, from those to say its readings; empty if nobody knows one.
void add_variants(const text::Token& token, bool english, const Dictionary& dictionary,
                  SpokenWord& spoken) {
  std::vector<Labels>& variants = spoken.variants;
  const auto add = [&](Labels labels) {
    if (labels.empty() || variants.size() >= kMostVariants) return;
    if (std::find(variants.begin(), variants.end(), labels) != variants.end()) return;
    variants.push_back(std::move(labels));
  };
  for (std::size_t i = 0; i < token.readings.size(); ++i) {
    const std::string& reading = token.readings[i];
    if (i == token.complete && !variants.empty()) spoken.complete = variants.size();
    const auto words = english ? words_of(reading) : std::vector<std::string>();
    if (words.empty()) {
      const auto whole = dictionary.find(dam::lower_case(reading));
      if (whole != dictionary.end()) add(whole->second.front());
      continue;
    }
    Labels labels;
    bool all = true;
    for (const std::string& word : words) {
      const auto known = dictionary.find(dam::lower_case(word));
      if (known == dictionary.end()) {
        all = false;
        break;
      }
      if (!labels.empty()) labels.emplace_back(dam::kSilence);
      labels.insert(labels.end(), known->second.front().begin(), known->second.front().end());
      if (words.size() > 1) continue;
      for (const Labels& variant : known->second) add(variant);
    }
    if (all) add(std::move(labels));
  }
}

// A voice says no more than an hour at a time.
constexpr std::size_t kMostSpokenBytes = 20000;

Result<void> add_spoken(const std::vector<std::string>& missing, const AlignOptions& options,
                        Dictionary& dictionary) {
  VoiceOptions voice;
  voice.language = options.language;
  for (std::size_t at = 0; at < missing.size();) {
    std::vector<std::string> some;
    for (std::size_t bytes = 0; at < missing.size() && bytes < kMostSpokenBytes; ++at) {
      bytes += missing[at].size();
      some.push_back(missing[at]);
    }
    auto spoken = pronounce(some, voice, true);
    if (!spoken && spoken.error().code == Code::unsupported) {
      return make_error(Code::not_found,
                        "no pronunciation for \"" + some.front() +
                            "\"; add it to the dictionary, or build with espeak-ng (Debian package "
                            "libespeak-ng-dev), which can guess it");
    }
    if (!spoken) return spoken.error();
    for (std::size_t i = 0; i < some.size(); ++i) {
      Labels labels = for_recogniser((*spoken)[i]);
      if (!labels.empty()) dictionary[dam::lower_case(some[i])] = {std::move(labels)};
    }
  }
  return {};
}

}  // namespace

bool is_english(std::string_view language) {
  const std::string lower = dam::lower_case(language);
  return lower == "en" || lower.starts_with("en-") || lower.starts_with("en_") ||
         lower.starts_with("english");
}

Result<std::vector<SpokenWord>> find_pronunciations(const std::vector<text::Token>& words,
                                                    const AlignOptions& options,
                                                    std::vector<std::string>& warnings) {
  Dictionary dictionary;
  const bool english = is_english(options.language);
  // What is said: words, and readings in parts or whole.
  std::set<std::string, std::less<>> wanted;
  for (const text::Token& word : words) {
    if (word.readings.empty()) wanted.insert(word.text);
    for (const std::string& reading : word.readings) {
      const auto parts = english ? words_of(reading) : std::vector<std::string>();
      if (parts.empty()) wanted.insert(reading);
      wanted.insert(parts.begin(), parts.end());
    }
  }
  if (english) {
    std::set<std::string, std::less<>> names;
    for (const std::string& word : wanted) names.insert(dam::lower_case(word));
    auto read = read_dictionary(options.dictionary_path, names);
    if (!read) return read.error();
    dictionary = *std::move(read);
    dictionary[kLetterA] = {{"EY"}};
    // Between numbers it is weak: "nineteen ninety to nineteen ninety-five".
    dictionary[kWeakTo] = {{"T", "AH"}};
  }
  std::set<std::string> missing;
  for (const std::string& word : wanted) {
    if (dictionary.contains(dam::lower_case(word)) || !can_be_said(word, english)) continue;
    missing.insert(word);
  }
  if (!missing.empty()) {
    const auto added = add_spoken({missing.begin(), missing.end()}, options, dictionary);
    if (!added) return added.error();
  }
  std::vector<SpokenWord> spoken;
  for (const text::Token& word : words) {
    SpokenWord one;
    one.text = word.text;
    one.guessed = english && (!word.readings.empty() || missing.contains(word.text));
    if (word.readings.empty()) {
      const auto known = dictionary.find(dam::lower_case(word.text));
      if (known != dictionary.end()) one.variants = known->second;
      for (Labels& variant : one.variants) std::erase(variant, dam::kSilence);
    } else {
      add_variants(word, english, dictionary, one);
    }
    if (one.variants.empty()) {
      warnings.push_back("no pronunciation for \"" + word.text +
                         "\"; it gets the recognised phones");
      one.guessed = true;
    }
    spoken.push_back(std::move(one));
  }
  return spoken;
}

}  // namespace animeme::voice

#include "tools/speech/text/chinese.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <unordered_map>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

constexpr std::size_t kLongestWord = 8;  // characters
constexpr std::size_t kMostLine = 400;   // bytes of a line that is believed
constexpr double kUnknown = -20;         // log of how often a character is seen that no list has
constexpr double kAllCounts = 9.5e7;     // sum of the counts of pinyin_simp

struct Reading {
  std::string syllables;  // "yin hang", "yin2 hang2"
  double weight = 1;
};
// UTF-8 to readings.
using WordList = std::unordered_map<std::string, std::vector<Reading>>;

// What the lists say of the words that may be in a text.
struct Dictionary {
  WordList words;  // simplified, without tones, weights are counts
  WordList tones;  // mostly traditional; weights are percents
};

// The file as it is, read once.
const std::string& bytes_of(const std::string& path) {
  static std::mutex mutex;
  static std::map<std::string, std::string> cache;
  const std::lock_guard lock(mutex);
  const auto [at, fresh] = cache.try_emplace(path);
  if (fresh) {
    std::ifstream file(path, std::ios::binary);
    at->second.assign(std::istreambuf_iterator<char>(file), {});
  }
  return at->second;
}

std::string_view first_character(std::string_view line) {
  std::string_view rest = line;
  dam::take_code_point(rest);
  return line.substr(0, line.size() - rest.size());
}

// "word<TAB>syllables<TAB>weight" a line, after a head that ends with "...". Of a hundred thousand
// lines only those are read whose word begins with a character of the text.
WordList read_list(const std::string& path, const std::set<std::string, std::less<>>& begins) {
  WordList list;
  std::string_view rest = bytes_of(path);
  rest.remove_prefix(std::min(rest.find("\n...\n"), rest.size()));
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (line.empty() || line.size() > kMostLine || !begins.contains(first_character(line)))
      continue;
    const std::size_t tab = line.find('\t');
    if (tab == std::string_view::npos) continue;
    const std::size_t end = std::min(line.find('\t', tab + 1), line.size());
    Reading reading{std::string(line.substr(tab + 1, end - tab - 1)), 100};
    if (end < line.size()) {
      reading.weight = std::strtod(std::string(line.substr(end + 1)).c_str(), nullptr);
    }
    list[std::string(line.substr(0, tab))].push_back(std::move(reading));
  }
  return list;
}

std::vector<std::string> syllables_of(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t blank = std::min(text.find(' '), text.size());
    if (blank > 0) out.emplace_back(text.substr(0, blank));
    text.remove_prefix(std::min(blank + 1, text.size()));
  }
  return out;
}

std::string without_tone(std::string syllable) {
  if (!syllable.empty() && syllable.back() >= '1' && syllable.back() <= '5') syllable.pop_back();
  return syllable;
}

const std::vector<Reading>* find(const WordList& list, std::u32string_view word) {
  const auto at = list.find(utf8(word));
  return at == list.end() ? nullptr : &at->second;
}

bool is_han(char32_t c) {
  return (c >= 0x4E00 && c <= 0x9FFF) || (c >= 0x3400 && c <= 0x4DBF) || c == 0x3007 ||
         (c >= 0xF900 && c <= 0xFAFF) || (c >= 0x20000 && c <= 0x3FFFF);
}

// The tone of a syllable as this character has it. `base` empty: its most usual syllable.
std::string with_tone(char32_t written, const std::string& base, const Dictionary& dictionary) {
  const Reading* best = nullptr;
  const std::vector<Reading>* readings = find(dictionary.tones, std::u32string(1, written));
  for (std::size_t i = 0; readings != nullptr && i < readings->size(); ++i) {
    const Reading& reading = (*readings)[i];
    const bool fits = base.empty() || without_tone(reading.syllables) == base;
    if (fits && (best == nullptr || reading.weight > best->weight)) best = &reading;
  }
  return best == nullptr ? std::string() : best->syllables;
}

bool ends_in_word(const SpokenText& said) {
  return !said.text.empty() && is_letter_or_digit(said.text.back());
}

// A text as it was written, and by simplified and traditional characters.
struct Forms {
  std::u32string written, simple, traditional;
};

std::string read_character(const Forms& forms, std::size_t at, const std::string& base,
                           const Dictionary& dictionary) {
  const std::string own = pinyin_of(forms.written[at]);
  // ICU knows one reading of each character, with its tone.
  if (!own.empty() && (base.empty() || without_tone(own) == base)) return own;
  for (const char32_t form : {forms.written[at], forms.traditional[at], forms.simple[at]}) {
    std::string toned = with_tone(form, base, dictionary);
    if (!toned.empty()) return toned;
  }
  return base;
}

std::string read_word(const Forms& forms, std::size_t first, std::size_t last,
                      const Dictionary& dictionary) {
  const std::size_t count = last - first;
  const auto simple = std::u32string_view(forms.simple).substr(first, count);
  const auto written = std::u32string_view(forms.written).substr(first, count);
  const auto traditional = std::u32string_view(forms.traditional).substr(first, count);
  std::vector<std::string> bases;
  if (const auto* readings = find(dictionary.words, simple)) {
    bases = syllables_of(readings->front().syllables);
  }
  if (bases.size() != count) bases.assign(count, {});
  // Tones of the word as a whole: 了解 liao3 jie3, 一样 yi2 yang4.
  if (count > 1) {
    for (const std::u32string_view form : {written, traditional, simple}) {
      const auto* toned = find(dictionary.tones, form);
      for (std::size_t i = 0; toned != nullptr && i < toned->size(); ++i) {
        const auto syllables = syllables_of((*toned)[i].syllables);
        bool same = syllables.size() == count;
        for (std::size_t k = 0; same && k < count; ++k) {
          same = bases[k].empty() || without_tone(syllables[k]) == bases[k];
        }
        std::string all;
        for (const std::string& syllable : syllables) all += syllable;
        if (same) return all;
      }
    }
  }
  std::string all;
  for (std::size_t k = 0; k < count; ++k) {
    const std::string syllable = read_character(forms, first + k, bases[k], dictionary);
    if (syllable.empty()) return {};
    all += syllable == without_tone(syllable) ? syllable + "5" : syllable;
  }
  return all;
}

// The most probable words of a row of Chinese characters.
void part_words(const Forms& forms, std::size_t first, std::size_t last,
                const Dictionary& dictionary, std::vector<ChineseWord>& out) {
  const std::size_t count = last - first;
  std::vector<double> best(count + 1, -1e300);
  std::vector<std::size_t> from(count + 1, 0);
  best[0] = 0;
  for (std::size_t end = 1; end <= count; ++end) {
    for (std::size_t length = 1; length <= std::min(end, kLongestWord); ++length) {
      const auto word = std::u32string_view(forms.simple).substr(first + end - length, length);
      const auto* readings = find(dictionary.words, word);
      if (readings == nullptr && length > 1) continue;
      const double score =
          best[end - length] +
          (readings == nullptr ? kUnknown : std::log((readings->front().weight + 1) / kAllCounts));
      if (score > best[end]) {
        best[end] = score;
        from[end] = end - length;
      }
    }
  }
  std::vector<std::size_t> ends;
  for (std::size_t end = count; end > 0; end = from[end]) ends.push_back(end);
  std::reverse(ends.begin(), ends.end());
  for (const std::size_t end : ends) {
    const std::size_t a = first + from[end], b = first + end;
    out.push_back({a, b, read_word(forms, a, b, dictionary)});
  }
}

}  // namespace

bool has_chinese_words(const std::string& folder) {
  return !bytes_of(folder + "/pinyin_simp.dict.yaml").empty();
}

std::vector<ChineseWord> chinese_words(std::u32string_view text, const std::string& folder) {
  Forms forms{std::u32string(text), {}, {}};
  std::set<std::string, std::less<>> begins;
  for (const char32_t c : text) {
    forms.simple += is_han(c) ? simplified(c) : c;
    forms.traditional += is_han(c) ? traditional(c) : c;
    for (const char32_t form : {c, forms.simple.back(), forms.traditional.back()}) {
      if (is_han(form)) begins.insert(utf8(std::u32string(1, form)));
    }
  }
  Dictionary all{read_list(folder + "/pinyin_simp.dict.yaml", begins),
                 read_list(folder + "/terra_pinyin.dict.yaml", begins)};
  for (auto& [word, readings] : all.words) {
    std::stable_sort(readings.begin(), readings.end(),
                     [](const Reading& a, const Reading& b) { return a.weight > b.weight; });
  }
  std::vector<ChineseWord> words;
  for (std::size_t i = 0; i < text.size();) {
    const bool han = is_han(text[i]);
    std::size_t end = i;
    while (end < text.size() && is_han(text[end]) == han) ++end;
    if (han) {
      part_words(forms, i, end, all, words);
    } else {
      words.push_back({i, end, {}});
    }
    i = end;
  }
  return words;
}

SpokenText read_chinese(const SpokenText& said, std::u32string& unread, const std::string& folder) {
  SpokenText out;
  for (const ChineseWord& word : chinese_words(said.text, folder)) {
    const Place place = said.place(word.first, word.last);
    if (!is_han(said.text[word.first])) {
      const bool apart = ends_in_word(out) && is_letter_or_digit(said.text[word.first]);
      if (apart) out.add(U" ", {place.first, place.first});
      out.add(said, word.first, word.last);
    } else if (word.pinyin.empty()) {
      unread.append(said.text, word.first, word.last - word.first);
    } else {
      // A blank parts words, but belongs to none.
      if (ends_in_word(out)) out.add(U" ", {place.first, place.first});
      out.add(code_points(word.pinyin), place);
    }
  }
  return out;
}

}  // namespace animeme::text

#include "tools/characters/capture/folds.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

namespace animeme::tools {

namespace {

constexpr std::size_t kFewest = 20;  // sentences for words to be held out
constexpr double kLeast = 0.15;      // of the sentences
constexpr double kMost = 0.30;       // likewise
constexpr double kCommon = 0.15;     // words in more sentences than that stay

// FNV-1a with 64 bits: an order that has nothing to do with names.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ std::uint8_t(c)) * 1099511628211U;
  return hash;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool part = upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '\'' ||
                      (std::uint8_t(c) & 0x80) != 0;
    if (part) word += upper ? char(c - 'A' + 'a') : c;
    if (!part && !word.empty()) words.push_back(std::move(word)), word.clear();
  }
  return words;
}

std::string plain(const std::string& text) {
  std::string out;
  for (const std::string& word : words_of(text)) out += word + " ";
  return out;
}

}  // namespace

std::vector<int> split_into_folds(const std::vector<std::string>& ids,
                                  const std::vector<std::string>& texts, int folds) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::string words = plain(texts[i]);
    groups[words.empty() ? "\t" + ids[i] : words].push_back(i);
  }
  std::vector<std::pair<std::uint64_t, const std::vector<std::size_t>*>> order;
  for (const auto& [words, members] : groups) order.emplace_back(hash_of(words), &members);
  // Large groups first, so that parts come out even.
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    if (a.second->size() != b.second->size()) return a.second->size() > b.second->size();
    return a.first < b.first;
  });
  std::vector<std::size_t> counts(std::size_t(folds), 0);
  std::vector<int> out(ids.size(), 0);
  for (const auto& [hash, members] : order) {
    const auto least = std::min_element(counts.begin(), counts.end());
    for (const std::size_t i : *members) out[i] = int(least - counts.begin());
    *least += members->size();
  }
  return out;
}

std::vector<bool> hold_words_out(const std::vector<std::string>& texts) {
  if (texts.size() < kFewest) return {};
  std::map<std::string, std::set<std::size_t>> sentences;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    for (const std::string& word : words_of(texts[i])) sentences[word].insert(i);
  }
  std::vector<std::pair<std::uint64_t, const std::set<std::size_t>*>> order;
  for (const auto& [word, where] : sentences) order.emplace_back(hash_of(word), &where);
  std::sort(order.begin(), order.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  const double count = double(texts.size());
  std::set<std::size_t> held;
  for (const auto& [hash, where] : order) {
    if (double(held.size()) >= kLeast * count) break;
    if (double(where->size()) > kCommon * count) continue;
    std::set<std::size_t> more = held;
    more.insert(where->begin(), where->end());
    if (double(more.size()) <= kMost * count) held = std::move(more);
  }
  if (double(held.size()) < kLeast * count) return {};
  std::vector<bool> out(texts.size(), false);
  for (const std::size_t i : held) out[i] = true;
  return out;
}

}  // namespace animeme::tools

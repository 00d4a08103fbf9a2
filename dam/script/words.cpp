#include "dam/script/words.h"

#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

WordLink link_of(bool same_text, bool pause, bool same_word) {
  if (!same_text) return WordLink::automatic;
  if (pause) return same_word ? WordLink::continued : WordLink::automatic;
  return same_word ? WordLink::automatic : WordLink::again;
}

}  // namespace

std::vector<ScriptWord> words_of(const Script& script) {
  std::vector<ScriptWord> words;
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    const Phone& phone = script.phones[i];
    if (phone.word.empty()) continue;
    const bool same_text = !words.empty() && words.back().text == phone.word;
    const bool adjacent = !words.empty() && words.back().last == i;
    const bool goes_on = same_text && (phone.link == WordLink::continued ||
                                       (phone.link == WordLink::automatic && adjacent));
    if (!goes_on) words.push_back({phone.start, phone.end, phone.word, i, i + 1});
    words.back().end = phone.end;
    words.back().last = i + 1;
  }
  return words;
}

void link_phone(std::vector<Phone>& phones, std::size_t place, bool begins_word) {
  std::size_t before = place;
  while (before > 0 && phones[before - 1].word.empty()) --before;
  const bool same_text = before > 0 && phones[before - 1].word == phones[place].word;
  phones[place].link = link_of(same_text, before < place, !begins_word);
}

bool is_unspaced(char32_t c) {
  const auto between = [c](char32_t first, char32_t last) { return c >= first && c <= last; };
  return between(0x2E80, 0xA4CF) || between(0xF900, 0xFAFF) || between(0xFF00, 0xFF60) ||
         between(0x20000, 0x3FFFD) || between(0x0E00, 0x0EFF) || between(0x1000, 0x109F) ||
         between(0x1780, 0x17FF);
}

void attach_words(std::vector<TimedLabel>& phones, const std::vector<TimedLabel>& words) {
  auto word = words.begin(), last = words.end();  // last: that of the phone before
  bool pause = false;
  for (TimedLabel& phone : phones) {
    const double middle = 0.5 * (phone.start + phone.end);
    while (word != words.end() && word->end <= middle) ++word;
    if (word == words.end()) return;
    if (word->start > middle || word->label.empty() || is_silence_spelling(phone.label)) {
      pause = true;
      continue;
    }
    phone.word = word->label;
    const bool same_text = last != words.end() && last->label == word->label;
    phone.link = link_of(same_text, pause, last == word);
    last = word;
    pause = false;
  }
}

}  // namespace animeme::dam

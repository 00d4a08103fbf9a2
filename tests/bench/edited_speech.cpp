#include "tests/bench/edited_speech.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "dam/maths/random.h"

namespace animeme::bench {

namespace {

constexpr std::size_t kFade = 80;  // samples over which a cut is smoothed

// A word of a script: its phones, and when.
struct Word {
  std::string text;
  std::size_t first = 0, last = 0;  // phones
  double start = 0, end = 0;
};

std::vector<Word> words_of(const dam::Script& script) {
  std::vector<Word> words;
  std::size_t before = script.phones.size();
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    const dam::Phone& phone = script.phones[i];
    if (phone.word.empty()) continue;
    if (words.empty() || before + 1 != i || words.back().text != phone.word) {
      words.push_back({phone.word, i, i, phone.start, phone.end});
    }
    words.back().last = i;
    words.back().end = phone.end;
    before = i;
  }
  return words;
}

std::size_t sample_at(double seconds) { return std::size_t(std::lround(seconds * kSpeechRate)); }

// Behind each other, with a short fade from one to the other.
void join(std::vector<float>& sound, std::vector<float> more) {
  const std::size_t fade = std::min({kFade, sound.size(), more.size()});
  for (std::size_t i = 0; i < fade; ++i) {
    sound[sound.size() - 1 - i] *= float(i) / float(kFade);
    more[i] *= float(i) / float(kFade);
  }
  sound.insert(sound.end(), more.begin(), more.end());
}

std::vector<float> part(const std::vector<float>& sound, double start, double end) {
  const std::size_t first = std::min(sample_at(start), sound.size());
  const std::size_t last = std::clamp(sample_at(end), first, sound.size());
  return {sound.begin() + std::ptrdiff_t(first), sound.begin() + std::ptrdiff_t(last)};
}

void move_phones(dam::Script& script, std::size_t from, double seconds) {
  for (std::size_t i = from; i < script.phones.size(); ++i) {
    script.phones[i].start += seconds;
    script.phones[i].end += seconds;
  }
}

void cut_word(EditedSpeech& speech, const Word& word) {
  auto sound = part(speech.sound, 0, word.start);
  join(sound, part(speech.sound, word.end, 1e6));
  speech.sound = std::move(sound);
  auto& phones = speech.labels.phones;
  phones.erase(phones.begin() + std::ptrdiff_t(word.first),
               phones.begin() + std::ptrdiff_t(word.last) + 1);
  move_phones(speech.labels, word.first, word.start - word.end);
}

void splice_word(EditedSpeech& speech, const Word& before, const Sentence& other,
                 const Word& word) {
  const double at = before.end, length = word.end - word.start;
  auto sound = part(speech.sound, 0, at);
  join(sound, part(other.sound, word.start, word.end));
  join(sound, part(speech.sound, at, 1e6));
  speech.sound = std::move(sound);
  move_phones(speech.labels, before.last + 1, length);
  auto& phones = speech.labels.phones;
  std::vector<dam::Phone> more(other.labels.phones.begin() + std::ptrdiff_t(word.first),
                               other.labels.phones.begin() + std::ptrdiff_t(word.last) + 1);
  for (dam::Phone& phone : more) {
    phone.start += at - word.start;
    phone.end += at - word.start;
    phone.word = "*";
  }
  phones.insert(phones.begin() + std::ptrdiff_t(before.last) + 1, more.begin(), more.end());
  speech.start = at;
  speech.end = at + length;
}

}  // namespace

std::string_view name_of(Edit edit) {
  constexpr std::string_view kNames[] = {"right text", "a word too many in the text",
                                         "a word cut out of the sound",
                                         "a word missing in the text", "a word put into the sound"};
  return kNames[std::size_t(edit)];
}

std::string EditedSpeech::text() const {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

EditedSpeech edit_speech(const Sentence& one, const Sentence& two, const Sentence& other, Edit edit,
                         std::uint64_t seed) {
  dam::Random random(seed);
  EditedSpeech speech;
  speech.edit = edit;
  speech.sound = one.sound;
  speech.sound.insert(speech.sound.end(), two.sound.begin(), two.sound.end());
  speech.labels = one.labels;
  const std::size_t behind = speech.labels.phones.size();
  speech.labels.phones.insert(speech.labels.phones.end(), two.labels.phones.begin(),
                              two.labels.phones.end());
  move_phones(speech.labels, behind, double(one.sound.size()) / kSpeechRate);
  const auto words = words_of(speech.labels);
  for (const Word& word : words) speech.words.push_back(word.text);
  const std::size_t which = random.below(words.size());
  const auto others = words_of(other.labels);
  const Word& stranger = others[random.below(others.size())];
  const auto at = speech.words.begin() + std::ptrdiff_t(which);
  switch (edit) {
    case Edit::none:
      break;
    case Edit::text_more:
      speech.missing = which + 1;
      speech.start = speech.end = words[which].end;
      speech.words.insert(at + 1, stranger.text);
      break;
    case Edit::cut_out:
      speech.missing = which;
      speech.start = speech.end = words[which].start;
      cut_word(speech, words[which]);
      break;
    case Edit::text_less:
      speech.start = words[which].start;
      speech.end = words[which].end;
      for (std::size_t i = words[which].first; i <= words[which].last; ++i) {
        speech.labels.phones[i].word = "*";
      }
      speech.words.erase(at);
      break;
    case Edit::spliced_in:
      splice_word(speech, words[which], other, stranger);
      break;
  }
  return speech;
}

void EditScore::add(const EditedSpeech& speech, const Result<voice::Alignment>& alignment) {
  ++recordings;
  const bool less = speech.edit == Edit::text_more || speech.edit == Edit::cut_out;
  const bool more = speech.edit == Edit::text_less || speech.edit == Edit::spliced_in;
  if (!alignment || alignment->approximate) {
    ++refused;
    return;
  }
  bool noticed = false;
  for (std::size_t i = 0; i < alignment->words.size(); ++i) {
    const voice::AlignedWord& word = alignment->words[i];
    // Of two words that are spelled alike either may be the one.
    const bool wanted =
        less && (i == speech.missing ||
                 (i + 1 == speech.missing && speech.words[i] == speech.words[i + 1]) ||
                 (i == speech.missing + 1 && speech.words[i] == speech.words[i - 1]));
    words += less && i == speech.missing ? 0 : 1;
    if (word.said) continue;
    if (wanted) {
      noticed = true;
    } else {
      ++false_out;
    }
  }
  for (const voice::Insertion& one : alignment->inserted) {
    const double shared = std::min(one.end, speech.end) - std::max(one.start, speech.start);
    if (more && shared > 0.3 * (speech.end - speech.start)) {
      noticed = true;
    } else if (!more || shared <= 0) {
      ++false_in;
    }
  }
  found += noticed ? 1 : 0;
  times.add(speech.labels, alignment->script);
}

}  // namespace animeme::bench

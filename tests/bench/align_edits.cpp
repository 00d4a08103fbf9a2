#include "tests/bench/align_edits.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "tests/bench/edited_speech.h"
#include "tests/bench/noises.h"
#include "tools/speech/voice/align.h"

namespace animeme::bench {

namespace {

constexpr std::size_t kUnwritten = 30;  // one word of so many is not in the text
constexpr double kStrangeSeconds = 60;

// What is said, and when.
struct LongSpeech {
  std::vector<float> sound;
  std::string text;
  struct Word {
    std::string text;
    double start = 0;
    bool written = true;
  };
  std::vector<Word> words;
  double strange_start = 0, strange_end = 0;

  void say(const Sentence& sentence, std::size_t& count, bool written) {
    const double at = double(sound.size()) / kSpeechRate;
    std::string before;
    for (const dam::Phone& phone : sentence.labels.phones) {
      if (!phone.word.empty() && phone.word != before) {
        const bool here = written && ++count % kUnwritten != 0;
        if (written) words.push_back({phone.word, at + phone.start, here});
        if (here) text += (text.empty() ? "" : " ") + phone.word;
      }
      before = phone.word;
    }
    sound.insert(sound.end(), sentence.sound.begin(), sentence.sound.end());
  }
};

LongSpeech make_long(const std::vector<Sentence>& sentences, double minutes, bool noise) {
  LongSpeech speech;
  const auto length = std::size_t(minutes * 60 * kSpeechRate);
  const auto strange = std::size_t(kStrangeSeconds * kSpeechRate);
  std::size_t count = 0, next = 0;
  while (speech.sound.size() < length) {
    if (speech.strange_end == 0 && speech.sound.size() >= length / 2) {
      speech.strange_start = double(speech.sound.size()) / kSpeechRate;
      const std::size_t end = speech.sound.size() + strange;
      if (noise) {
        for (const float sample : make_noise(Noise::white, strange, 1, voices_of(sentences))) {
          speech.sound.push_back(0.03f * sample);
        }
      } else {
        for (std::size_t i = sentences.size(); speech.sound.size() < end; i -= 7) {
          speech.say(sentences[(i - 1) % sentences.size()], count, false);
          if (i <= 7) i += sentences.size();
        }
      }
      speech.strange_end = double(speech.sound.size()) / kSpeechRate;
    }
    speech.say(sentences[next++ % sentences.size()], count, true);
  }
  return speech;
}

void print_long(const std::string& what, const LongSpeech& speech) {
  voice::AlignOptions options;
  options.least_confidence = 0;
  const auto begin = std::chrono::steady_clock::now();
  const auto found = voice::align({int(kSpeechRate), speech.sound}, speech.text, options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  if (!found) {
    std::printf("| %s | %s |\n", what.c_str(), found.error().describe().c_str());
    return;
  }
  std::vector<double> distances;
  std::size_t far = 0, unsaid = 0, number = 0;
  double again = -1;  // seconds from the strange minute to the first of five words in place
  std::size_t in_place = 0;
  for (const LongSpeech::Word& word : speech.words) {
    if (!word.written) continue;
    if (number >= found->words.size()) break;
    const voice::AlignedWord& one = found->words[number++];
    const double distance = 1000 * std::abs(one.start - word.start);
    unsaid += one.said ? 0 : 1;
    if (one.said) distances.push_back(distance);
    far += one.said && distance > 300 ? 1 : 0;
    if (word.start < speech.strange_end || again >= 0) continue;
    in_place = one.said && distance <= 300 ? in_place + 1 : 0;
    if (in_place == 5) again = word.start - speech.strange_end;
  }
  std::size_t missing = 0, noticed = 0, in_vain = 0;
  std::vector<bool> used(found->inserted.size());
  for (std::size_t i = 0; i < speech.words.size(); ++i) {
    if (speech.words[i].written) continue;
    ++missing;
    const double from = speech.words[i].start;
    const double to = i + 1 < speech.words.size() ? speech.words[i + 1].start : from + 0.5;
    bool seen = false;
    for (std::size_t k = 0; k < used.size(); ++k) {
      const voice::Insertion& one = found->inserted[k];
      if (one.start >= to || one.end <= from) continue;
      seen = used[k] = true;
    }
    noticed += seen ? 1 : 0;
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    const voice::Insertion& one = found->inserted[k];
    const bool strange = one.start < speech.strange_end && one.end > speech.strange_start;
    in_vain += used[k] || strange ? 0 : 1;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("| %s | %zu | %.1f | %.0f | %zu | %zu | %zu of %zu | %zu | %.1f | %.0f | %ld |\n",
              what.c_str(), number, percentile(distances, 0.5), percentile(distances, 0.9), far,
              unsaid, noticed, missing, in_vain, again, took.count(), usage.ru_maxrss / 1024);
  std::fflush(stdout);
}

}  // namespace

void score_edits(const std::vector<Sentence>& sentences, const std::vector<double>& levels) {
  const auto voices = voices_of(sentences);
  std::printf(
      "| what | noise | noticed | of | refused | said words taken for left out | of | speech in "
      "vain | median ms |\n|---|---|---|---|---|---|---|---|---|\n");
  const std::size_t count = sentences.size();
  for (const Edit edit : kEdits) {
    for (std::size_t level = 0; level <= levels.size(); ++level) {
      EditScore score;
      for (std::size_t i = 0; i < count; ++i) {
        auto speech = edit_speech(sentences[i], sentences[(i + 1) % count],
                                  sentences[(i + count / 2) % count], edit, i + 1);
        if (level > 0) {
          speech.sound =
              in_noise(speech.sound, sentences[i].first_sample(), speech.sound.size(),
                       kNoises[i % std::size(kNoises)], levels[level - 1], i + 1, voices);
        }
        score.add(speech, voice::align({int(kSpeechRate), speech.sound}, speech.text()));
      }
      const std::string noise =
          level == 0 ? "clean" : std::to_string(int(levels[level - 1])) + " dB";
      std::printf("| %s | %s | %zu | %zu | %zu | %zu | %zu | %zu | %.1f |\n",
                  std::string(name_of(edit)).c_str(), noise.c_str(), score.found, score.recordings,
                  score.refused, score.false_out, score.words, score.false_in,
                  score.times.median());
      std::fflush(stdout);
    }
  }
}

void score_long(const std::vector<Sentence>& sentences, double minutes) {
  std::printf(
      "| in the middle | words | median ms | 90 %% | over 300 ms | taken for left out | unwritten "
      "words noticed | speech in vain | in place again after s | took s | MB |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  print_long("a minute of noise", make_long(sentences, minutes, true));
  print_long("a minute of other sentences", make_long(sentences, minutes, false));
}

}  // namespace animeme::bench

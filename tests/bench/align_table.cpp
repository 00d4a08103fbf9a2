// Prints the tables of tools/speech/voice/measured.md: how far alignments are from the labels of a
// corpus (grid_s1), clean and in noise.
//   build/release/bin/align_table CORPUS [--every 4] [--from 2] [--levels 15,10,5] [--texts |
//   --edits | --long 30]
//   build/release/bin/align_table FOLDER --lang it             # made by festival_corpus.sh
//   build/release/bin/align_table FOLDER --lang it --lines LIST    # recordings, list of their
//   texts
#include <CLI/CLI.hpp>
#include <cstdio>

#include "tests/bench/align_edits.h"
#include "tests/bench/align_languages.h"
#include "tests/bench/align_material.h"
#include "tests/bench/noises.h"
#include "tools/speech/voice/align.h"

namespace {

using namespace animeme;
using namespace animeme::bench;

voice::AlignOptions everything() {
  voice::AlignOptions options;
  options.least_confidence = 0;
  return options;
}

void print(const std::string& what, const Score& score) {
  std::printf("| %s | %.1f | %.1f | %.0f | %+.1f | %.0f | %.1f | %zu |\n", what.c_str(),
              score.median(), score.mean(), score.ninety(), score.bias(),
              100 * score.shortest_share(), score.false_pause_seconds, score.none);
  std::fflush(stdout);
}

void score_noises(const std::vector<Sentence>& sentences, const std::vector<double>& levels) {
  std::printf(
      "| noise | median ms | mean | 90 %% within | bias | phones of minimum length %% | false "
      "pauses s | not aligned |\n"
      "|---|---|---|---|---|---|---|---|\n");
  const auto voices = voices_of(sentences);
  const auto all = [&](const std::string& what, auto make) {
    Score score;
    for (std::size_t i = 0; i < sentences.size(); ++i) {
      const auto found =
          voice::align({16000, make(sentences[i], i)}, sentences[i].text, everything());
      if (found && !found->approximate) {
        score.add(sentences[i].labels, found->script);
      } else {
        ++score.none;
      }
    }
    print(what, score);
    return score;
  };
  all("clean", [](const Sentence& one, std::size_t) { return one.sound; });
  for (const double db : levels) {
    Score together;
    for (const Noise noise : kNoises) {
      const auto score = all(std::string(name_of(noise)) + ", " + std::to_string(int(db)) + " dB",
                             [&](const Sentence& one, std::size_t number) {
                               return in_noise(one.sound, one.first_sample(), one.last_sample(),
                                               noise, db, number + 1, voices);
                             });
      together.errors.insert(together.errors.end(), score.errors.begin(), score.errors.end());
      together.phones += score.phones;
      together.shortest += score.shortest;
      together.false_pause_seconds += score.false_pause_seconds;
      together.none += score.none;
    }
    print("all, " + std::to_string(int(db)) + " dB", together);
  }
}

struct Trial {
  std::string name;
  std::size_t refused = 0, count = 0;
  void add(const media::Pcm& sound, const std::string& text) {
    ++count;
    refused += voice::align(sound, text) ? 0 : 1;
  }
};

// What is refused of right texts, texts of other sentences, and noise alone.
void score_texts(const std::vector<Sentence>& sentences, std::vector<double> levels) {
  const auto voices = voices_of(sentences);
  levels.insert(levels.begin(), 100);
  std::vector<Trial> trials;
  for (const double db : levels) {
    const std::string level = db < 100 ? std::to_string(int(db)) + " dB" : "clean";
    Trial right{"correct text, " + level}, wrong{"text of another sentence, " + level};
    for (std::size_t i = 0; i < sentences.size(); ++i) {
      const Sentence& one = sentences[i];
      const media::Pcm sound{16000,
                             in_noise(one.sound, one.first_sample(), one.last_sample(),
                                      db < 100 ? kNoises[i % 4] : Noise::white, db, i + 1, voices)};
      right.add(sound, one.text);
      wrong.add(sound, sentences[(i + sentences.size() / 2) % sentences.size()].text);
    }
    trials.push_back(right);
    trials.push_back(wrong);
  }
  for (const Noise kind : kNoises) {
    Trial noise{"only noise, " + std::string(name_of(kind))};
    for (std::size_t i = 0; i < sentences.size(); ++i) {
      auto sound = make_noise(kind, 48000, i + 1, voices);
      for (float& sample : sound) sample *= 0.05f;
      noise.add({16000, sound}, sentences[i].text);
    }
    trials.push_back(noise);
  }
  std::printf("| what | refused | of |\n|---|---|---|\n");
  for (const Trial& one : trials) {
    std::printf("| %s | %zu | %zu |\n", one.name.c_str(), one.refused, one.count);
  }
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{"How far alignments are from the labels of a corpus"};
  std::string corpus;
  std::size_t every = 1, first = 0;
  app.add_option("corpus", corpus, "Folder with utterances.tsv, audio/ and phonemes/")->required();
  app.add_option("--every", every, "Only every n-th sentence")->check(CLI::PositiveNumber);
  app.add_option("--from", first, "Number of the first one");
  std::vector<double> levels{15, 10, 5};
  app.add_option("--levels", levels, "Levels of the noise, dB")->delimiter(',');
  bool texts = false;
  app.add_flag("--texts", texts, "What is refused: right and wrong texts, noise");
  bool edits = false;
  app.add_flag("--edits", edits, "What is noticed of words left out and put in");
  double minutes = 0;
  app.add_option("--long", minutes, "All behind each other, so many minutes, with gaps");
  std::string language, list;
  app.add_option("--lang", language, "Of words and labels that are compared by number");
  app.add_option("--lines", list, "Recordings of the folder and their texts: ID: text");
  CLI11_PARSE(app, count, arguments);
  if (!language.empty()) {
    const LanguageRows rows{language, every, first};
    const auto scored = list.empty()            ? score_labelled(corpus, rows)
                        : corpus == "espeak-ng" ? score_spoken(list, rows)
                                                : score_recorded(corpus, list, rows);
    if (!scored) std::fprintf(stderr, "%s\n", scored.error().describe().c_str());
    return scored ? 0 : 3;
  }
  const auto sentences = read_sentences(corpus, every, first);
  if (!sentences) {
    std::fprintf(stderr, "%s\n", sentences.error().describe().c_str());
    return 3;
  }
  if (texts) {
    score_texts(*sentences, levels);
    return 0;
  }
  if (edits) {
    score_edits(*sentences, levels);
  } else if (minutes > 0) {
    score_long(*sentences, minutes);
  } else {
    score_noises(*sentences, levels);
  }
  return 0;
}

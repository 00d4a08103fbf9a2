#include "tests/bench/speech_material.h"

#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include "dam/model/builtin.h"
#include "dam/speaking/synthesise.h"
#include "tests/support/folders.h"

namespace animeme::bench {

namespace {

using Word = std::vector<dam::Phone>;

std::vector<Word> words_of(const dam::Corpus& corpus) {
  std::vector<Word> words;
  for (const dam::Utterance& u : corpus.utterances) {
    std::string last;
    for (const dam::Phone& phone : u.script.phones) {
      if (phone.label == dam::kSilence) continue;
      if (phone.word != last) words.emplace_back();
      last = phone.word;
      words.back().push_back(phone);
    }
  }
  return words;
}

class Maker {
 public:
  double uniform() { return double(engine_()) / 4294967296.0; }
  std::size_t below(std::size_t n) { return std::size_t(engine_() % n); }
  /// Near enough to a normal deviate.
  double noise() { return uniform() + uniform() + uniform() + uniform() - 2; }

 private:
  std::mt19937 engine_{1};
};

dam::Script sentence_of(const std::vector<Word>& words, Maker& maker) {
  dam::Script script;
  double t = 0.3;
  script.phones.push_back({0, t, std::string(dam::kSilence), {}});
  while (t < 2.7)
    for (dam::Phone phone : words[maker.below(words.size())]) {
      const double duration = phone.duration() * (0.8 + 0.4 * maker.uniform());
      phone.start = t;
      phone.end = t += duration;
      script.phones.push_back(phone);
    }
  script.phones.push_back({t, t + 0.3, std::string(dam::kSilence), {}});
  return script;
}

}  // namespace

dam::Corpus sample_corpus() {
  auto corpus = dam::read_corpus(std::filesystem::path(test::kSourceFolder) / "tests" / "data" /
                                 "grid_s1_sample");
  return corpus ? *corpus : dam::Corpus();
}

std::vector<dam::Utterance> made_up_speech(double seconds, std::size_t controls) {
  const auto model = dam::builtin_model();
  const std::vector<Word> words = words_of(sample_corpus());
  Maker maker;
  std::vector<std::vector<double>> mix(controls);
  for (std::size_t c = 0; c < controls; ++c)
    for (std::size_t k = 0; k < model->controls.size(); ++k)
      mix[c].push_back(c % model->controls.size() == k ? 1 : 0.2 * maker.noise());
  std::vector<dam::Utterance> sentences;
  for (double made = 0; made < seconds;) {
    dam::Utterance u;
    u.id = "s" + std::to_string(10000 + sentences.size());
    u.script = sentence_of(words, maker);
    const auto signal = dam::synthesise(*model, u.script);
    u.signal.rate = signal->rate;
    for (std::size_t c = 0; c < controls; ++c) u.signal.names.push_back("c" + std::to_string(c));
    std::vector<double> offset(controls);
    for (double& o : offset) o = 20 * maker.noise();
    for (std::size_t i = 0; i < signal->frames(); ++i)
      for (std::size_t c = 0; c < controls; ++c) {
        double value = offset[c] + 30 * maker.noise();
        for (std::size_t k = 0; k < mix[c].size(); ++k) value += mix[c][k] * signal->at(i, k);
        u.signal.values.push_back(value);
      }
    made += u.script.duration();
    sentences.push_back(std::move(u));
  }
  return sentences;
}

}  // namespace animeme::bench

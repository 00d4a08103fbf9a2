#include "tests/bench/listen_material.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "dam/model/builtin.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/train.h"
#include "tests/bench/recorded_lists.h"
#include "tools/formats/media/audio.h"
#include "tools/speech/voice/align.h"

namespace animeme::bench {

namespace {

namespace fs = std::filesystem;

constexpr double kSure = 0.6;  // alignments below are no truth

Result<media::Pcm> sound_of(const fs::path& path) {
  return media::read_audio(path.string(), {16000, 3600, nullptr});
}

// "one's" is a word; signs that recordings read as words are those words.
std::vector<std::string> words_of(const std::string& text) {
  constexpr std::string_view kSigns[][2] = {
      {"0", "zero"}, {"1", "one"},   {"2", "two"},   {"3", "three"}, {"4", "four"}, {"5", "five"},
      {"6", "six"},  {"7", "seven"}, {"8", "eight"}, {"9", "nine"},  {"*", "star"}, {"#", "pound"}};
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    for (const auto& sign : kSigns) word = word == sign[0] ? std::string(sign[1]) : word;
    if (!word.empty()) words.push_back(std::exchange(word, {}));
  };
  for (const char c : text) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0 || c == '\'' || c == '*' || c == '#') {
      word += char(std::tolower(letter));
    } else {
      end_word();
    }
  }
  end_word();
  return words;
}

}  // namespace

Result<Voices> read_corpus_voices(const std::string& folder, const Choice& choice) {
  dam::CorpusOptions all;
  all.skip_missing = true;
  const auto corpus = dam::read_corpus(folder, all);
  if (!corpus) return corpus.error();
  const auto wav = [&](const dam::Utterance& one) {
    return fs::path(folder) / "audio" / (one.id + ".wav");
  };
  std::vector<dam::Utterance> training;
  for (const auto& one : dam::select(*corpus, choice.column, "train")) {
    if (choice.rows == "test" || !fs::exists(wav(one))) training.push_back(one);
  }
  auto model = dam::train(training, {});
  if (!model) return model.error();
  Voices voices{std::move(*model), {}};
  std::size_t number = 0;
  for (const auto& one : dam::select(*corpus, choice.column, choice.rows)) {
    if (!fs::exists(wav(one)) || number++ % choice.every != choice.from) continue;
    auto sound = sound_of(wav(one));
    if (!sound) return sound.error();
    voices.rows.push_back({one, std::move(*sound)});
  }
  return voices;
}

Result<Voices> read_strangers(const std::string& folder, const Choice& choice) {
  const auto corpus = dam::read_corpus(folder, {});
  if (!corpus) return corpus.error();
  auto model = dam::builtin_model();
  if (!model) return model.error();
  Voices voices{std::move(*model), {}};
  std::size_t number = 0;
  for (const dam::Utterance& one : corpus->utterances) {
    const fs::path wav = fs::path(folder) / "audio" / (one.id + ".wav");
    if (!fs::exists(wav) || number++ % choice.every != choice.from) continue;
    auto sound = sound_of(wav);
    if (!sound) return sound.error();
    voices.rows.push_back({one, std::move(*sound)});
  }
  if (voices.rows.empty()) return make_error(Code::not_found, "no recording in " + folder);
  return voices;
}

Result<Voices> read_recordings(const std::string& folder, const std::string& list,
                               const Choice& choice) {
  auto model = dam::builtin_model();
  if (!model) return model.error();
  Voices voices{std::move(*model), {}};
  voice::AlignOptions aligning;
  aligning.language = choice.language;
  std::size_t number = 0;
  for (const Recorded& line : recorded_lines(folder, list)) {
    if (number++ % choice.every != choice.from) continue;
    auto sound = sound_of(line.file);
    if (!sound) return sound.error();
    auto aligned = voice::align(*sound, line.text, aligning);
    if (!aligned || aligned->confidence < kSure) continue;
    dam::SynthesisOptions options;
    options.rate = {25, 1};
    options.frames = std::size_t(sound->duration() * 25);
    auto motion = dam::synthesise(voices.model, aligned->script, options);
    if (!motion) return motion.error();
    dam::Utterance sentence;
    sentence.id = line.id;
    sentence.text = line.text;
    sentence.script = std::move(aligned->script);
    sentence.signal = std::move(*motion);
    voices.rows.push_back({std::move(sentence), std::move(*sound)});
  }
  if (voices.rows.empty()) return make_error(Code::not_found, "no recording in " + folder);
  return voices;
}

WordErrors count_word_errors(const std::string& said, const std::vector<std::string>& heard) {
  const auto words = words_of(said);
  std::vector<std::size_t> costs(heard.size() + 1);
  for (std::size_t k = 0; k < costs.size(); ++k) costs[k] = k;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::vector<std::size_t> next{i + 1};
    for (std::size_t k = 0; k < heard.size(); ++k) {
      next.push_back(
          std::min({costs[k] + (words[i] != heard[k] ? 1 : 0), costs[k + 1] + 1, next[k] + 1}));
    }
    costs = std::move(next);
  }
  return {costs.back(), words.size()};
}

}  // namespace animeme::bench

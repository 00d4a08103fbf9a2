// What a face loses that has the sound alone, against text and against the labels of a corpus.
//
//     build/release/bin/listen_table CORPUS             # rows whose split is "test"
//     build/release/bin/listen_table CORPUS --rows train --every 5    # to choose settings by
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>

#include "dam/corpus/corpus.h"
#include "dam/evaluation/evaluate.h"
#include "dam/signal/closure.h"
#include "dam/speaking/readings.h"
#include "dam/training/train.h"
#include "tools/media/audio.h"
#include "tools/speech/heard_face.h"
#include "tools/voice/align.h"
#include "tools/voice/listen.h"

namespace {

using namespace animeme;  // NOLINT: a program

constexpr double kNear = 0.060;  // seconds: a closure counts for a phone so far away

struct Row {
  dam::Utterance sentence;
  media::Pcm sound;
};

struct Material {
  dam::Model model;
  std::vector<Row> rows;
};

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "listen_table: %s\n", result.error().describe().c_str());
  std::exit(3);
}

// Train on rows that are not listened to: those of "train" for "test", those without sound else.
Material read(const std::string& folder, const std::string& wanted, std::size_t every,
              const std::string& column) {
  dam::CorpusOptions all;
  all.skip_missing = true;
  const dam::Corpus corpus = need(dam::read_corpus(folder, all));
  const auto wav = [&](const dam::Utterance& one) {
    return std::filesystem::path(folder) / "audio" / (one.id + ".wav");
  };
  std::vector<dam::Utterance> training;
  for (const auto& one : dam::select(corpus, column, "train")) {
    if (wanted == "test" || !std::filesystem::exists(wav(one))) training.push_back(one);
  }
  Material material{need(dam::train(training, {})), {}};
  std::size_t number = 0;
  for (const auto& one : dam::select(corpus, column, wanted)) {
    if (!std::filesystem::exists(wav(one)) || number++ % every != 0) continue;
    material.rows.push_back(
        {one, need(media::read_audio(wav(one).string(), {16000, 3600, nullptr}))});
  }
  return material;
}

struct Made {
  dam::Signal motion;
  dam::Script script;  // empty: none
};

// P, B and M of the labels with a closure of the motion near, and closures of the motion without.
struct Closures {
  bool guessed = true;  // there is a script
  std::size_t phones = 0, met = 0, heard = 0, false_heard = 0, all_heard = 0;
};

bool near_bilabial(const dam::Script& script, const dam::Phone& phone) {
  for (const dam::Phone& one : script.phones) {
    if (dam::is_bilabial(one.label) && one.start < phone.end + kNear &&
        one.end > phone.start - kNear) {
      return true;
    }
  }
  return false;
}

void count(const dam::Utterance& sentence, const Made& made, Closures& out) {
  const auto lips = dam::inner_lip_channels(made.motion.names);
  out.guessed = !made.script.phones.empty();
  for (const dam::Phone& phone : sentence.script.phones) {
    if (!dam::is_bilabial(phone.label)) continue;
    ++out.phones;
    out.heard += near_bilabial(made.script, phone) ? 1 : 0;
    bool met = false;
    for (std::size_t i = 0; lips && i < made.motion.frames(); ++i) {
      const double time = made.motion.time(i);
      if (time < phone.start - kNear || time > phone.end + kNear) continue;
      met = met || dam::inner_gap(made.motion, i, *lips) < dam::kShutGap;
    }
    out.met += met ? 1 : 0;
  }
  for (const dam::Phone& phone : made.script.phones) {
    if (!dam::is_bilabial(phone.label)) continue;
    ++out.all_heard;
    out.false_heard += near_bilabial(sentence.script, phone) ? 0 : 1;
  }
}

double percent(std::size_t part, std::size_t whole) {
  return 100 * double(part) / double(std::max<std::size_t>(whole, 1));
}

void print(const Material& material, const std::string& name,
           const std::function<std::optional<Made>(const Row&)>& make) {
  std::vector<dam::SentencePair> pairs;
  Closures closures;
  double seconds = 0;
  std::size_t refused = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (const Row& row : material.rows) {
    auto made = make(row);
    seconds += row.sound.duration();
    if (!made) {
      ++refused;
      continue;
    }
    made->motion.values.resize(row.sentence.signal.frames() * made->motion.names.size(), 0);
    count(row.sentence, *made, closures);
    pairs.push_back({row.sentence, std::move(made->motion)});
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  dam::ScoreOptions scoring;
  scoring.scale = material.model.controls;
  const auto e = need(dam::score(pairs, scoring));
  char heard[16] = "-", in_vain[32] = "-";  // of a live face no script is known
  if (closures.guessed) {
    std::snprintf(heard, sizeof heard, "%.0f", percent(closures.heard, closures.phones));
    std::snprintf(in_vain, sizeof in_vain, "%zu of %zu", closures.false_heard, closures.all_heard);
  }
  std::printf("| %s | %.3f | %.2f | %.2f | %s | %.0f | %s | %.1f | %.2f | %.0f |", name.c_str(),
              e.nrmse, e.correlation, e.gap_correlation, heard,
              percent(closures.met, closures.phones), in_vain, e.closure.false_per_minute,
              e.dynamics.velocity, seconds / taken.count());
  std::printf(refused > 0 ? " %zu refused\n" : "\n", refused);
  std::fflush(stdout);
}

dam::SynthesisOptions fitting(const Row& row) {
  dam::SynthesisOptions options;
  options.rate = row.sentence.signal.rate;
  options.frames = row.sentence.signal.frames();
  return options;
}

std::optional<Made> by_script(const dam::Model& model, const Row& row, const dam::Script& script) {
  return Made{need(dam::synthesise(model, script, fitting(row))), script};
}

std::optional<Made> by_sound(const dam::Model& model, const Row& row, const std::string& language) {
  voice::ListenOptions options;
  options.language = language;
  const auto heard = need(voice::listen(row.sound, options));
  return Made{need(dam::synthesise_readings(model, heard.readings, heard.script, fitting(row))),
              heard.script};
}

std::optional<Made> live(const dam::Model& model, const Row& row, double delay) {
  speech::HeardFaceOptions options;
  options.synthesis.rate = row.sentence.signal.rate;
  options.delay = delay;
  auto face = need(speech::HeardFace::open(model, row.sound.sample_rate, options));
  face->push(row.sound.samples);
  auto motion = need(face->pull());
  const auto rest = need(face->finish());
  motion.values.insert(motion.values.end(), rest.values.begin(), rest.values.end());
  return Made{std::move(motion), {}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Faces from sound alone, from text, and from labels"};
  std::string corpus, rows = "test", column = "split";
  std::size_t every = 1;
  app.add_option("corpus", corpus, "Folder with utterances.tsv, audio/, phonemes/, fap/")
      ->required();
  app.add_option("--rows", rows, "Value of the column: test, or train (then a model without them)");
  app.add_option("--column", column, "split, heldout_word_split");
  app.add_option("--every", every, "Only every n-th of them")->check(CLI::PositiveNumber);
  std::vector<double> delays{0.15, 0.2, 0.25, 0.3, 0.5};
  app.add_option("--delays", delays, "Of the live face, seconds")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  const Material material = read(corpus, rows, every, column);
  const dam::Model& model = material.model;
  std::printf(
      "%zu sentences\n\n| from | NRMSE | corr | gap corr | P B M heard %% | lips closed %% | P B M "
      "heard in vain | false closures a minute | velocity | x real time |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n",
      material.rows.size());
  print(material, "labels of the corpus",
        [&](const Row& row) { return by_script(model, row, row.sentence.script); });
  print(material, "text, aligned", [&](const Row& row) -> std::optional<Made> {
    const auto aligned = voice::align(row.sound, row.sentence.text);
    if (!aligned) return std::nullopt;
    return by_script(model, row, aligned->script);
  });
  print(material, "sound", [&](const Row& row) { return by_sound(model, row, "en"); });
  print(material, "sound, best guess alone", [&](const Row& row) {
    return by_script(model, row, need(voice::listen(row.sound)).script);
  });
  print(material, "sound, any language",
        [&](const Row& row) { return by_sound(model, row, "xx"); });
  for (const double delay : delays) {
    char name[64];
    std::snprintf(name, sizeof name, "sound as it comes, %.2f s late", delay);
    print(material, name, [&](const Row& row) { return live(model, row, delay); });
  }
  return 0;
}

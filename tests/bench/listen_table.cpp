// What a face loses that has the sound alone, against text and against the labels of a corpus.
//
//     build/release/bin/listen_table CORPUS             # rows whose split is "test"
//     build/release/bin/listen_table CORPUS --rows train --every 5    # to choose settings by
#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <functional>
#include <optional>

#include "dam/evaluation/evaluate.h"
#include "dam/script/phones.h"
#include "dam/signal/closure.h"
#include "dam/speaking/readings.h"
#include "tests/bench/listen_material.h"
#include "tests/bench/noises.h"
#include "tools/speech/talking/voice_driven_face.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/listen.h"

namespace {

using namespace animeme;  // NOLINT: a program
using bench::kNear;
using bench::need;
using bench::Voice;
using bench::Voices;

struct Made {
  dam::Signal motion;
  dam::Script script;  // empty: none
  std::vector<std::string> words = {};
};

// The share of the frames with speech whose mouth has the right shape.
struct Shapes {
  std::size_t frames = 0, right = 0;
};

dam::PhoneClass shape_at(const dam::Script& script, double time) {
  for (const dam::Phone& phone : script.phones) {
    if (phone.start > time || phone.end <= time) continue;
    const dam::PhoneInfo* info = dam::find_phone(phone.label);
    return info != nullptr ? info->phone_class : dam::PhoneClass::silence;
  }
  return dam::PhoneClass::silence;
}

void count(const dam::Script& labels, const dam::Script& heard, Shapes& out) {
  for (double time = 0.005; time < labels.duration(); time += 0.01) {
    const dam::PhoneClass right = shape_at(labels, time);
    if (right == dam::PhoneClass::silence) continue;
    ++out.frames;
    out.right += shape_at(heard, time) == right ? 1 : 0;
  }
}

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
      met = met || dam::inner_gap(made.motion, i, *lips) < dam::kClosedGap;
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

void print(const Voices& material, const std::string& name,
           const std::function<std::optional<Made>(const Voice&)>& make) {
  std::vector<dam::SentencePair> pairs;
  Closures closures;
  Shapes shapes;
  bench::WordErrors words;
  double seconds = 0;
  std::size_t refused = 0;
  const std::clock_t begin = std::clock();
  for (const Voice& row : material.rows) {
    auto made = make(row);
    seconds += row.sound.duration();
    if (!made) {
      ++refused;
      continue;
    }
    made->motion.values.resize(row.sentence.signal.frames() * made->motion.names.size(), 0);
    count(row.sentence, *made, closures);
    if (!made->script.phones.empty()) count(row.sentence.script, made->script, shapes);
    if (!made->words.empty()) {
      const auto wrong = bench::count_word_errors(row.sentence.text, made->words);
      words.errors += wrong.errors;
      words.words += wrong.words;
    }
    pairs.push_back({row.sentence, std::move(made->motion)});
  }
  const double taken = double(std::clock() - begin) / CLOCKS_PER_SEC;
  dam::ScoreOptions scoring;
  scoring.scale = material.model.controls;
  const auto e = need(dam::score(pairs, scoring));
  char heard[16] = "-", in_vain[32] = "-", right[16] = "-", wrong[16] = "-";
  if (words.words > 0)
    std::snprintf(wrong, sizeof wrong, "%.0f", percent(words.errors, words.words));
  if (closures.guessed) {  // of a live face no script is known
    std::snprintf(right, sizeof right, "%.0f", percent(shapes.right, shapes.frames));
    std::snprintf(heard, sizeof heard, "%.0f", percent(closures.heard, closures.phones));
    std::snprintf(in_vain, sizeof in_vain, "%zu of %zu", closures.false_heard, closures.all_heard);
  }
  std::printf("| %s | %.3f | %.2f | %s | %s | %.0f | %s | %.1f | %.2f | %s | %.0f |", name.c_str(),
              e.nrmse, e.gap_correlation, right, heard, percent(closures.met, closures.phones),
              in_vain, e.closure.false_per_minute, e.dynamics.velocity, wrong, seconds / taken);
  std::printf(refused > 0 ? " %zu refused\n" : "\n", refused);
  std::fflush(stdout);
}

dam::SynthesisOptions fitting(const Voice& row) {
  dam::SynthesisOptions options;
  options.rate = row.sentence.signal.rate;
  options.frames = row.sentence.signal.frames();
  return options;
}

std::optional<Made> by_script(const dam::Model& model, const Voice& row,
                              const dam::Script& script) {
  return Made{need(dam::synthesise(model, script, fitting(row))), script, {}};
}

std::optional<Made> by_sound(const dam::Model& model, const Voice& row,
                             const voice::ListenOptions& options) {
  const auto heard = need(voice::listen(row.sound, options));
  std::vector<std::string> words;
  for (const voice::RecognisedWord& word : heard.words) words.push_back(word.text);
  return Made{need(dam::synthesise_readings(model, heard.readings, heard.script, fitting(row))),
              heard.script, std::move(words)};
}

std::optional<Made> live(const dam::Model& model, const Voice& row, double delay) {
  speech::VoiceDrivenFaceOptions options;
  options.synthesis.rate = row.sentence.signal.rate;
  options.delay = delay;
  auto face = need(speech::VoiceDrivenFace::open(model, row.sound.sample_rate, options));
  face->push(row.sound.samples);
  auto motion = need(face->pull());
  const auto rest = need(face->finish());
  motion.values.insert(motion.values.end(), rest.values.begin(), rest.values.end());
  return Made{std::move(motion), {}, {}};
}

// The voices in the four kinds of noise, one after the other, at so many dB.
Voices in_noises(const Voices& clean, double db) {
  std::vector<std::vector<float>> others;
  for (const Voice& row : clean.rows) others.push_back(row.sound.samples);
  Voices noisy = clean;
  for (std::size_t i = 0; i < noisy.rows.size(); ++i) {
    std::vector<float>& samples = noisy.rows[i].sound.samples;
    samples =
        bench::in_noise(samples, 0, samples.size() - 1, bench::kNoises[i % 4], db, i + 1, others);
  }
  return noisy;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Faces from sound alone, from text, and from labels"};
  std::string folder, list;
  bench::Choice choice;
  app.add_option("folder", folder,
                 "A corpus: utterances.tsv, audio/, phonemes/, fap/; with --texts, recordings")
      ->required();
  app.add_option("--texts", list, "What the recordings say: lines \"ID: text\"");
  app.add_option("--lang", choice.language, "Of the recordings");
  app.add_option("--rows", choice.rows,
                 "Value of the column: test, or train (then a model without them)");
  app.add_option("--column", choice.column, "split, heldout_word_split");
  app.add_option("--every", choice.every, "Only every n-th of them")->check(CLI::PositiveNumber);
  app.add_option("--from", choice.from, "Number of the first, below n");
  std::vector<double> delays{0.15, 0.2, 0.25, 0.3, 0.5};
  app.add_option("--delays", delays, "Of the live face, seconds")->delimiter(',');
  std::vector<double> levels;
  app.add_option("--levels", levels, "Of noise in which the voices are heard, too, dB")
      ->delimiter(',');
  bool brief = false;
  app.add_flag("--brief", brief, "Sound alone, nothing else");
  CLI11_PARSE(app, argc, argv);
  const Voices material = need(list.empty() ? bench::read_corpus_voices(folder, choice)
                                            : bench::read_recordings(folder, list, choice));
  const dam::Model& model = material.model;
  const std::string& language = choice.language;
  std::printf(
      "%zu sentences\n\n| from | NRMSE | gap corr | mouth shape correct %% | P B M recognised %% | "
      "lips closed "
      "%% "
      "| false P B M | false closures a minute | velocity | words wrong %% | x real time "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      material.rows.size());
  voice::ListenOptions own, phones, other;
  own.language = phones.language = language;
  phones.words = false;
  other.language = "xx";
  const auto sound = [&](const char* name, const voice::ListenOptions& options) {
    print(material, name, [&](const Voice& row) { return by_sound(model, row, options); });
  };
  if (!brief && list.empty()) {
    print(material, "labels of the corpus",
          [&](const Voice& row) { return by_script(model, row, row.sentence.script); });
    print(material, "text, aligned", [&](const Voice& row) -> std::optional<Made> {
      const auto aligned = voice::align(row.sound, row.sentence.text);
      if (!aligned) return std::nullopt;
      return by_script(model, row, aligned->script);
    });
  }
  sound("sound", own);
  for (const double db : levels) {
    char name[64];
    std::snprintf(name, sizeof name, "sound, in noise of %.0f dB", db);
    print(in_noises(material, db), name,
          [&](const Voice& row) { return by_sound(model, row, own); });
  }
  if (brief) return 0;
  print(material, "sound, best hypothesis", [&](const Voice& row) {
    return by_script(model, row, need(voice::listen(row.sound, own)).script);
  });
  if (language == "en") sound("sound, without words", phones);
  if (language == "en") sound("sound, without a language", other);
  for (const double delay : delays) {
    char name[64];
    std::snprintf(name, sizeof name, "live sound, delay %.2f s", delay);
    print(material, name, [&](const Voice& row) { return live(model, row, delay); });
  }
  return 0;
}

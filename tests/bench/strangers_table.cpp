// What alignment and sound alone are worth on voices that nothing was built with, in rooms, noise,
// silence and at levels that people record at.
//
//     build/release/bin/strangers_table CORPUS                      # audio/, phonemes/, fap/
//     build/release/bin/strangers_table FOLDER --texts LIST [--lang es] [--every 8]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <numbers>

#include "dam/evaluation/evaluate.h"
#include "dam/maths/random.h"
#include "dam/script/phones.h"
#include "dam/speaking/readings.h"
#include "tests/bench/listen_material.h"
#include "tests/bench/noises.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/listen.h"

namespace {

using namespace animeme;  // NOLINT: a program
using bench::kNear;
using bench::need;
using bench::Voice;
using bench::Voices;

constexpr double kRate = 16000;

// A recording as somebody else would have made it; `lead` seconds of it are before the original.
struct Heard {
  std::vector<float> samples;
  double lead = 0;
};

struct Condition {
  std::string name;
  std::function<Heard(const Voices&, std::size_t)> make;
};

std::vector<float> scaled(std::vector<float> samples, double gain) {
  for (float& one : samples) one = float(std::lround(gain * double(one) * 32768)) / 32768;
  return samples;
}

double power(const std::vector<float>& samples) {
  double sum = 0;
  for (const float one : samples) sum += double(one) * double(one);
  return sum / double(std::max<std::size_t>(samples.size(), 1));
}

// `times` the length, before and behind; noise so many dB below the whole, or zeros.
Heard padded(const std::vector<float>& samples, double times, double db, std::uint64_t seed) {
  const double lead = std::floor(0.3 * times * double(samples.size()) / kRate / 0.04) * 0.04;
  const auto before = std::size_t(std::lround(lead * kRate));
  const auto all = std::size_t((1 + times) * double(samples.size()));
  Heard heard{std::vector<float>(all), lead};
  if (db > 0) {
    heard.samples = bench::make_noise(bench::Noise::hum, all, seed, {});
    const double level = std::sqrt(power(samples) * std::pow(10.0, -db / 10));
    for (float& one : heard.samples) one = float(level * double(one));
  }
  for (std::size_t i = 0; i < samples.size(); ++i) heard.samples[before + i] += samples[i];
  return heard;
}

// A telephone: first-order filters, four of each, at 300 and 3400 Hz.
std::vector<float> telephone(std::vector<float> samples) {
  const double low = 1 - std::exp(-2 * std::numbers::pi * 3400 / kRate);
  const double high = 1 - std::exp(-2 * std::numbers::pi * 300 / kRate);
  for (int pass = 0; pass < 4; ++pass) {
    double slow = 0, smooth = 0;
    for (float& one : samples) {
      smooth += low * (double(one) - smooth);
      slow += high * (smooth - slow);
      one = float(smooth - slow);
    }
  }
  return samples;
}

// Chords of a plucked kind with a beat, at a level below the voice.
std::vector<float> with_music(std::vector<float> samples, double db, std::uint64_t seed) {
  dam::Random random(seed);
  std::vector<double> music(samples.size());
  for (std::size_t at = 0; at < music.size(); at += 6000) {
    for (int note = 0; note < 4; ++note) {
      const double hertz = 110 * std::pow(2.0, double(random.below(30)) / 12);
      for (std::size_t i = at; i < std::min(at + 12000, music.size()); ++i) {
        const double t = double(i - at) / kRate;
        for (int k = 1; k <= 6; ++k) {
          music[i] += std::exp(-4 * t) / k * std::sin(2 * std::numbers::pi * hertz * k * t);
        }
      }
    }
  }
  double sum = 1e-12;
  for (const double one : music) sum += one * one;
  const double gain =
      std::sqrt(power(samples) * std::pow(10.0, -db / 10) * double(music.size()) / sum);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += float(gain * music[i]);
  return samples;
}

Heard noisy(const Voices& all, std::size_t i, bench::Noise noise, double db) {
  std::vector<std::vector<float>> others;
  for (std::size_t k = 0; k < all.rows.size(); ++k) {
    if (k != i || all.rows.size() == 1) others.push_back(all.rows[k].sound.samples);
  }
  const auto& samples = all.rows[i].sound.samples;
  return {bench::in_noise(samples, 0, samples.size(), noise, db, i + 1, others), 0};
}

std::vector<Condition> conditions() {
  const auto of = [](const Voices& all, std::size_t i) -> const std::vector<float>& {
    return all.rows[i].sound.samples;
  };
  std::vector<Condition> list{
      {"clean", [of](const Voices& all, std::size_t i) { return Heard{of(all, i)}; }},
      {"-50 dB", [of](const Voices& all,
                      std::size_t i) { return Heard{scaled(of(all, i), std::pow(10.0, -2.5))}; }},
      {"zeros, 1 times its length",
       [of](const Voices& all, std::size_t i) { return padded(of(all, i), 1, 0, i); }},
      {"zeros, 10 times",
       [of](const Voices& all, std::size_t i) { return padded(of(all, i), 10, 0, i); }},
      {"room noise of 40 dB, 10 times",
       [of](const Voices& all, std::size_t i) { return padded(of(all, i), 10, 40, i + 1); }},
      {"room noise of 20 dB",
       [of](const Voices& all, std::size_t i) { return padded(of(all, i), 0, 20, i + 1); }},
      {"the same, 10 times",
       [of](const Voices& all, std::size_t i) { return padded(of(all, i), 10, 20, i + 1); }},
      {"telephone",
       [of](const Voices& all, std::size_t i) { return Heard{telephone(of(all, i))}; }},
      {"a room with echo",
       [](const Voices& all, std::size_t i) { return noisy(all, i, bench::Noise::room, 30); }},
  };
  for (const int db : {20, 10, 5}) {
    for (const bench::Noise noise : {bench::Noise::white, bench::Noise::babble}) {
      list.push_back({std::string(bench::name_of(noise)) + ", " + std::to_string(db) + " dB",
                      [=](const Voices& all, std::size_t i) { return noisy(all, i, noise, db); }});
    }
    list.push_back({"music, " + std::to_string(db) + " dB", [=](const Voices& all, std::size_t i) {
                      return Heard{with_music(of(all, i), db, i + 1)};
                    }});
  }
  return list;
}

// The script without the first `lead` seconds, and without what is behind `seconds` of the rest.
dam::Script cut(const dam::Script& script, double lead, double seconds) {
  dam::Script out;
  for (dam::Phone phone : script.phones) {
    phone.start = std::clamp(phone.start - lead, 0.0, seconds);
    phone.end = std::clamp(phone.end - lead, 0.0, seconds);
    if (phone.end > phone.start) out.phones.push_back(phone);
  }
  return out;
}

bool has_bilabial(const dam::Script& script, const dam::Phone& phone) {
  return std::any_of(script.phones.begin(), script.phones.end(), [&](const dam::Phone& one) {
    return dam::is_bilabial(one.label) && one.start < phone.end + kNear &&
           one.end > phone.start - kNear;
  });
}

struct Share {
  std::size_t part = 0, whole = 0;
  void add(bool yes) {
    part += yes ? 1 : 0;
    ++whole;
  }
  double percent() const { return 100 * double(part) / double(std::max<std::size_t>(whole, 1)); }
};

// Phones of both that have one of the other near.
void count_closures(const dam::Script& truth, const dam::Script& heard, Share& found,
                    Share& in_vain) {
  for (const dam::Phone& phone : truth.phones) {
    if (dam::is_bilabial(phone.label)) found.add(has_bilabial(heard, phone));
  }
  for (const dam::Phone& phone : heard.phones) {
    if (dam::is_bilabial(phone.label)) in_vain.add(!has_bilabial(truth, phone));
  }
}

dam::PhoneClass shape_at(const dam::Script& script, double time) {
  for (const dam::Phone& phone : script.phones) {
    if (phone.start > time || phone.end <= time) continue;
    const dam::PhoneInfo* info = dam::find_phone(phone.label);
    return info != nullptr ? info->phone_class : dam::PhoneClass::silence;
  }
  return dam::PhoneClass::silence;
}

// Frames with speech whose mouth has the right shape.
Share shapes_of(const dam::Script& truth, const dam::Script& heard) {
  Share share;
  for (double time = 0.005; time < truth.duration(); time += 0.01) {
    const dam::PhoneClass right = shape_at(truth, time);
    if (right != dam::PhoneClass::silence) share.add(shape_at(heard, time) == right);
  }
  return share;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// What a recording was worth, by its confidence in tenths.
struct Calibration {
  double confidence[10] = {}, right[10] = {};
  std::size_t count[10] = {};
  void add(double told, double truth) {
    const auto at = std::size_t(std::clamp(told * 10, 0.0, 9.0));
    confidence[at] += told;
    right[at] += truth;
    ++count[at];
  }
};

void print_alone(const Voices& all, const Condition& condition, const voice::ListenOptions& options,
                 Calibration& calibration) {
  Share found, in_vain, shapes;
  std::vector<dam::SentencePair> pairs;
  double seconds = 0, confidence = 0;
  std::size_t warned = 0;
  const std::clock_t begin = std::clock();
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const Voice& row = all.rows[i];
    const Heard sound = condition.make(all, i);
    const media::Pcm pcm{int(kRate), sound.samples};
    const auto heard = need(voice::listen(pcm, options));
    const double length = row.sound.duration();
    seconds += pcm.duration();
    confidence += heard.confidence;
    warned += heard.warnings.empty() ? 0 : 1;
    const dam::Script script = cut(heard.script, sound.lead, length);
    count_closures(row.sentence.script, script, found, in_vain);
    const Share right = shapes_of(row.sentence.script, script);
    shapes.part += right.part;
    shapes.whole += right.whole;
    calibration.add(heard.confidence, right.percent() / 100);
    dam::SynthesisOptions motion;
    motion.rate = row.sentence.signal.rate;
    const double a_second = motion.rate.frames_per_second();
    const auto lead = std::size_t(std::lround(sound.lead * a_second));
    motion.frames = lead + row.sentence.signal.frames();
    auto made = need(dam::synthesise_readings(all.model, heard.readings, heard.script, motion));
    made.values.erase(made.values.begin(),
                      made.values.begin() + std::ptrdiff_t(lead * made.names.size()));
    pairs.push_back({row.sentence, std::move(made)});
  }
  const double taken = double(std::clock() - begin) / CLOCKS_PER_SEC;
  dam::ScoreOptions scoring;
  scoring.scale = all.model.controls;
  const auto e = need(dam::score(pairs, scoring));
  const auto n = double(all.rows.size());
  std::printf(
      "| %s | %.2f | %.3f | %.0f | %zu of %zu (%.0f %%) | %zu of %zu (%.0f %%) | %.2f | %zu | %.0f "
      "|\n",
      condition.name.c_str(), e.gap_correlation, e.nrmse, shapes.percent(), found.part, found.whole,
      found.percent(), in_vain.part, in_vain.whole, in_vain.percent(), confidence / n, warned,
      seconds / taken);
  std::fflush(stdout);
}

// Starts of the phones that both have, in order, ms apart.
std::vector<double> distances(const dam::Script& truth, const dam::Script& found) {
  std::vector<double> all;
  std::size_t from = 0;
  for (const dam::Phone& phone : truth.phones) {
    if (phone.label == dam::kSilence) continue;
    for (std::size_t i = from; i < std::min(from + 6, found.phones.size()); ++i) {
      if (found.phones[i].label != phone.label) continue;
      all.push_back(1000 * std::abs(found.phones[i].start - phone.start));
      from = i + 1;
      break;
    }
  }
  return all;
}

void print_aligned(const Voices& all, const Condition& condition,
                   const voice::AlignOptions& options) {
  Share refused, warned, wrong_refused, wrong_noticed;
  std::vector<double> errors;
  double confidence = 0;
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const Voice& row = all.rows[i];
    const Heard sound = condition.make(all, i);
    const media::Pcm pcm{int(kRate), sound.samples};
    const auto right = voice::align(pcm, row.sentence.text, options);
    refused.add(!right);
    if (right) {
      warned.add(!right->warnings.empty());
      confidence += right->confidence;
      const auto some =
          distances(row.sentence.script, cut(right->script, sound.lead, row.sound.duration()));
      errors.insert(errors.end(), some.begin(), some.end());
    }
    const auto& text = all.rows[(i + all.rows.size() / 2) % all.rows.size()].sentence.text;
    const auto wrong = voice::align(pcm, text, options);
    wrong_refused.add(!wrong);
    wrong_noticed.add(!wrong || !wrong->warnings.empty());
  }
  const std::size_t aligned = refused.whole - refused.part;
  std::printf("| %s | %zu of %zu | %zu | %.2f | %.1f | %zu of %zu | %zu |\n",
              condition.name.c_str(), refused.part, refused.whole, warned.part,
              confidence / double(std::max<std::size_t>(aligned, 1)), median(errors),
              wrong_refused.part, wrong_refused.whole, wrong_noticed.part);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Voices of strangers: alignment and sound alone, in many conditions"};
  std::string folder, list, only;
  bench::Choice choice;
  choice.rows.clear();
  app.add_option("folder", folder,
                 "A corpus: utterances.tsv, audio/, phonemes/, fap/; with --texts, recordings")
      ->required();
  app.add_option("--texts", list, "What the recordings say: lines \"ID: text\"");
  app.add_option("--lang", choice.language, "Of the recordings");
  app.add_option("--every", choice.every, "Only every n-th of them")->check(CLI::PositiveNumber);
  app.add_option("--from", choice.from, "Number of the first, below n");
  app.add_option("--only", only, "Only conditions whose name has this");
  bool no_sound = false, no_text = false, no_words = false;
  app.add_flag("--no-sound", no_sound, "Only alignment");
  app.add_flag("--no-text", no_text, "Only sound alone");
  app.add_flag("--no-words", no_words, "Phones without a word model");
  CLI11_PARSE(app, argc, argv);
  const Voices all = need(list.empty() ? bench::read_strangers(folder, choice)
                                       : bench::read_recordings(folder, list, choice));
  std::printf("%zu recordings\n\n", all.rows.size());
  auto some = conditions();
  std::erase_if(some,
                [&](const Condition& one) { return one.name.find(only) == std::string::npos; });
  if (!no_sound) {
    voice::ListenOptions options;
    options.language = choice.language;
    options.words = !no_words;
    Calibration calibration;
    std::printf(
        "| sound alone | gap corr | NRMSE | mouth right %% | P B M found | in vain | confidence | "
        "warned | x real time |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const Condition& one : some) print_alone(all, one, options, calibration);
    std::printf("\n| confidence | mouth right | recordings |\n|---|---|---|\n");
    for (std::size_t i = 0; i < 10; ++i) {
      const auto count = double(calibration.count[i]);
      if (count == 0) continue;
      std::printf("| %.2f | %.2f | %zu |\n", calibration.confidence[i] / count,
                  calibration.right[i] / count, calibration.count[i]);
    }
    std::printf("\n");
  }
  if (no_text) return 0;
  voice::AlignOptions options;
  options.language = choice.language;
  std::printf(
      "| aligned | right texts refused | warned of | confidence | median ms | wrong texts refused "
      "| noticed |\n|---|---|---|---|---|---|---|\n");
  for (const Condition& one : some) print_aligned(all, one, options);
  return 0;
}

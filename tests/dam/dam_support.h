// Made-up sentences for the tests of training and synthesis.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/animeme.h"
#include "dam/script/timeline_internal.h"

namespace animeme::test {

/// Uniform numbers that are the same with every standard library.
class Uniform {
 public:
  explicit Uniform(std::uint32_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (double(engine_()) / 4294967296.0);
  }
  std::size_t below(std::size_t n) { return std::size_t(engine_() % n); }

 private:
  std::mt19937 engine_;
};

/// Phones and their seconds.
using Sounds = std::vector<std::pair<std::string, double>>;

/// A script of sounds, one behind the other.
inline dam::Script script_of(const Sounds& sounds) {
  dam::Script script;
  double at = 0;
  for (const auto& [label, seconds] : sounds) {
    script.phones.push_back({at, at + seconds, label, ""});
    at += seconds;
  }
  return script;
}

/// SIL, then phones of the alphabet at random with random durations, then SIL.
inline dam::Script random_script(Uniform& random, const std::vector<std::string>& alphabet,
                                 std::size_t phones) {
  dam::Script script;
  double t = random(0.5, 0.9);
  script.phones.push_back({0, t, "SIL", ""});
  for (std::size_t i = 0; i < phones; ++i) {
    const double end = t + random(0.06, 0.2);
    script.phones.push_back({t, end, alphabet[random.below(alphabet.size())], "word"});
    t = end;
  }
  script.phones.push_back({t, t + random(0.5, 0.9), "SIL", ""});
  return script;
}

/// The parameters that a synthetic signal is made of: one polynomial and one width a phone.
struct Planted {
  std::vector<std::string> labels;
  std::vector<double> sigma;
  /// [phone][control][power]
  std::vector<std::vector<std::vector<double>>> coefficients;
};

inline Planted plant(Uniform& random, std::vector<std::string> labels, std::size_t controls,
                     std::size_t terms) {
  Planted planted{std::move(labels), {}, {}};
  for (std::size_t p = 0; p < planted.labels.size(); ++p) {
    planted.sigma.push_back(random(0.4, 1.2));
    planted.coefficients.emplace_back();
    for (std::size_t c = 0; c < controls; ++c) {
      planted.coefficients[p].emplace_back();
      for (std::size_t m = 0; m < terms; ++m) planted.coefficients[p][c].push_back(random(-1, 1));
    }
  }
  return planted;
}

/// Eq. 2 for a script, as a plain sum or normalised, sampled at 50 frames per second.
inline dam::Signal planted_signal(const Planted& planted, const dam::Script& script,
                                  double pause_edge, double time_margin, bool normalised) {
  dam::Signal signal;
  signal.rate = {50, 1};
  const std::size_t controls = planted.coefficients[0].size();
  for (std::size_t c = 0; c < controls; ++c) signal.names.push_back("c" + std::to_string(c));
  const auto frames = std::size_t(std::ceil(script.duration() * 50));
  signal.values.assign(frames * controls, 0.0);
  std::vector<double> sums(frames, 0.0);
  for (const dam::Occurrence& o : dam::make_timeline(script, pause_edge))
    for (std::size_t p = 0; p < planted.labels.size(); ++p) {
      if (planted.labels[p] != o.label) continue;
      for (std::size_t i = 0; i < frames; ++i) {
        const double u = (double(i) / 50 - o.start) / o.duration;
        const double d = dam::dominance(u, planted.sigma[p]);
        sums[i] += d;
        for (std::size_t c = 0; c < controls; ++c)
          signal.at(i, c) += d * dam::polynomial(planted.coefficients[p][c],
                                                 dam::clamp_local_time(u, time_margin));
      }
    }
  for (std::size_t i = 0; normalised && i < frames; ++i)
    for (std::size_t c = 0; c < controls; ++c) signal.at(i, c) /= std::max(sums[i], 1e-12);
  return signal;
}

/// `count` sentences whose signal is exactly Eq. 2.
inline std::vector<dam::Utterance> planted_sentences(Uniform& random, const Planted& planted,
                                                     std::size_t count, double time_margin = 0.5,
                                                     bool normalised = true) {
  std::vector<std::string> spoken;
  for (const std::string& label : planted.labels)
    if (label != "SIL") spoken.push_back(label);
  std::vector<dam::Utterance> list(count);
  for (std::size_t i = 0; i < count; ++i) {
    list[i].id = "s" + std::to_string(100 + i);
    list[i].script = random_script(random, spoken, 8);
    list[i].signal = planted_signal(planted, list[i].script, 0.3, time_margin, normalised);
  }
  return list;
}

inline std::vector<dam::Utterance> planted(std::size_t count, std::uint32_t seed = 5,
                                           std::vector<std::string> labels = {"SIL", "AA", "B",
                                                                              "IY"}) {
  Uniform random(seed);
  const auto truth = plant(random, std::move(labels), 2, 2);
  return planted_sentences(random, truth, count);
}

}  // namespace animeme::test

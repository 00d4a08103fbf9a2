// Captured lips, made of the measured FAPs of tests/data/grid_s1_sample: where the feature points
// of a face of known size would be. So the whole way can be gone, and what comes out held against
// what went in.
#pragma once

#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/signal/fap_signal.h"
#include "fap/fapu.h"
#include "fap/tables.h"
#include "tests/support/shared.h"

namespace animeme::test {

/// Millimetres; x to the left, y up.
struct LipPoint {
  const char* id;
  double x, y;
};
inline constexpr LipPoint kLipPoints[] = {
    {"2.1", 0, -42},  {"2.2", 0, 0.2},   {"2.3", 0, -0.2},  {"2.4", 24, 0},     {"2.5", -24, 0},
    {"2.6", 12, 0.2}, {"2.7", -12, 0.2}, {"2.8", 12, -0.2}, {"2.9", -12, -0.2}, {"8.1", 0, 9},
    {"8.2", 0, -11},  {"8.3", 25, 0},    {"8.4", -25, 0},   {"8.5", 13, 7},     {"8.6", -13, 7},
    {"8.7", 13, -8},  {"8.8", -13, -8}};
inline constexpr fap::Fapu kLipFapu = {10, 60, 48, 24, 50};  // IRISD, ES, ENS, MNS, MW

/// A table of these points for the curves of one sentence, x and y, under names such as "8.1_x".
inline std::string lip_table(const dam::Signal& faps) {
  std::string out = "time_s";
  for (const LipPoint& point : kLipPoints) {
    out += "," + std::string(point.id) + "_x," + std::string(point.id) + "_y";
  }
  out += "\n";
  char number[40];
  for (std::size_t i = 0; i < faps.frames(); ++i) {
    std::snprintf(number, sizeof number, "%.4f", faps.time(i));
    out += number;
    for (const LipPoint& point : kLipPoints) {
      double at[2] = {point.x, point.y};
      for (std::size_t c = 0; c < faps.names.size(); ++c) {
        const int fap = dam::fap_of_channel(faps.names[c]);
        if (fap < fap::kFirstLowLevel || fap::info(fap).feature_point != point.id) continue;
        const fap::Move move = fap::move_of(fap);
        const double way = fap::displacement(fap, faps.at(i, c), kLipFapu);
        for (std::size_t k = 0; k < 2; ++k) at[k] += move.axis[k] * way;
      }
      std::snprintf(number, sizeof number, ",%.5f,%.5f", at[0], at[1]);
      out += number;
    }
    out += "\n";
  }
  return out;
}

/// The neutral shape of these points and its FAP units, as --neutral takes it.
inline std::string lip_neutral() {
  std::string out = "{\"neutral_mm\": {";
  for (const LipPoint& point : kLipPoints) {
    char text[80];
    std::snprintf(text, sizeof text, "%s\"%s\": [%g, %g]", out.ends_with('{') ? "" : ", ", point.id,
                  point.x, point.y);
    out += text;
  }
  return out + "}, \"fapu_mm\": {\"IRISD\": 10, \"ES\": 60, \"ENS\": 48, \"MNS\": 24, \"MW\": 50}}";
}

/// The sentences that the points are made of.
inline std::vector<dam::Utterance> lip_sentences() {
  auto corpus = dam::read_corpus(data_dir() / "grid_s1_sample");
  EXPECT_TRUE(corpus) << (corpus ? "" : corpus.error().describe());
  return corpus ? std::move(corpus->utterances) : std::vector<dam::Utterance>();
}

}  // namespace animeme::test

// The table of viseme shapes is what a model of the corpus says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dam/corpus/corpus.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"
#include "dam/training/train.h"
#include "fap/tables.h"
#include "fap/viseme.h"
#include "tests/support/shared.h"

namespace animeme {
namespace viseme_table_test {

// Sums of the poses of the phones of each viseme, by FAP, and the number of their examples.
struct Sums {
  std::array<std::array<double, fap::kFapCount + 1>, fap::kVisemeCount> pose{};
  std::array<double, fap::kVisemeCount> examples{};
};

Sums sums_of(const dam::Model& model) {
  const auto& poses = std::get<dam::VisemeParameters>(model.parameters).poses;
  Sums sums;
  for (std::size_t p = 0; p < model.phones.size(); ++p) {
    const dam::PhoneInfo* phone = dam::find_phone(model.phones[p].label);
    if (phone == nullptr || phone->viseme_start != phone->viseme_end || phone->label == "HH" ||
        phone->label == dam::kSilence) {
      continue;
    }
    const double examples = model.phones[p].examples;
    sums.examples[phone->viseme_start] += examples;
    for (std::size_t c = 0; c < model.controls.size(); ++c) {
      const int fap = dam::fap_of_channel(model.controls[c].name);
      sums.pose[phone->viseme_start][std::size_t(fap)] +=
          examples * model.controls[c].sd * poses[p * model.controls.size() + c];
    }
  }
  return sums;
}

TEST(VisemeTable, IsMeasured) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "the reference data are not here";
  dam::CorpusOptions options;
  options.split_value = "train";
  for (int fap = 3; fap <= 60; ++fap) {
    if (fap <= 13 || fap >= 51) options.controls.push_back(dam::fap_channel(fap));
  }
  const auto corpus = dam::read_corpus(test::shared_dir() / "data" / "grid_s1", options);
  ASSERT_TRUE(corpus) << corpus.error().describe();
  dam::TrainOptions training;
  training.method = dam::Method::viseme;
  const auto model = dam::train(corpus->utterances, training);
  ASSERT_TRUE(model) << model.error().describe();
  const Sums sums = sums_of(*model);
  for (int viseme = 1; viseme < fap::kVisemeCount; ++viseme) {
    const std::size_t v = std::size_t(viseme);
    ASSERT_GT(sums.examples[v], 50) << fap::kVisemes[v].name;
    std::string row;
    bool same = true;
    for (int fap = 3; fap <= 60; ++fap) {
      if (fap > 13 && fap < 51) continue;
      const int mirror = fap::info(fap).mirror != 0 ? fap::info(fap).mirror : fap;
      const double want = (sums.pose[v][std::size_t(fap)] + sums.pose[v][std::size_t(mirror)]) / 2 /
                          sums.examples[v];
      same = same && std::abs(fap::viseme_shape(viseme).value[std::size_t(fap)] - want) <= 0.501;
      if (mirror >= fap) row += std::to_string(std::lround(want)) + ", ";
    }
    EXPECT_TRUE(same) << fap::kVisemes[v].name << ": {" << row << "}";
  }
}

// What the lips of the test sentences (not those of the table) show in the middle of each sound.
// Sounds that are made behind the lips look alike: only those of the lips are asked for.
TEST(VisemeTable, LipsAreRead) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "the reference data are not here";
  dam::CorpusOptions options;
  options.split_value = "test";
  const auto corpus = dam::read_corpus(test::shared_dir() / "data" / "grid_s1", options);
  ASSERT_TRUE(corpus) << corpus.error().describe();
  std::array<int, fap::kVisemeCount> sounds{};
  std::array<int, fap::kVisemeCount> read{};
  for (const dam::Utterance& utterance : corpus->utterances) {
    const auto clip = dam::to_sequence(utterance.signal);
    ASSERT_TRUE(clip);
    fap::VisemeFitter fitter;
    std::vector<std::size_t> strongest;
    for (const fap::Frame& frame : clip->frames) {
      const fap::VisemeWeights weights = fitter.fit(frame);
      strongest.push_back(
          std::size_t(std::max_element(weights.begin(), weights.end()) - weights.begin()));
    }
    for (const dam::Phone& phone : utterance.script.phones) {
      const dam::PhoneInfo* info = dam::find_phone(phone.label);
      const double middle = (phone.start + phone.end) / 2 * clip->rate.frames_per_second();
      const std::size_t at = std::min(strongest.size() - 1, std::size_t(middle + 0.5));
      if (info == nullptr || info->viseme_start != info->viseme_end) continue;
      ++sounds[info->viseme_start];
      read[info->viseme_start] += strongest[at] == info->viseme_start ? 1 : 0;
    }
  }
  for (int viseme = 0; viseme < fap::kVisemeCount; ++viseme) {
    const std::size_t v = std::size_t(viseme);
    std::printf("%-4s %4d sounds, strongest in %.2f\n", std::string(fap::kVisemes[v].name).c_str(),
                sounds[v], sounds[v] > 0 ? double(read[v]) / sounds[v] : 0.0);
  }
  for (const std::size_t v : {0U, 1U, 2U, 7U, 11U, 13U}) {  // chance is 1 in 15
    EXPECT_GT(2 * read[v], sounds[v]) << fap::kVisemes[v].name;
  }
}

}  // namespace viseme_table_test
}  // namespace animeme

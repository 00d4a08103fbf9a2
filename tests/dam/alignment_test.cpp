// Do scripts and motion belong together?
#include "dam/training/alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/dam/dam_support.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace alignment_test {

std::vector<Utterance> sample(std::size_t count = 24) {
  auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
  if (!corpus) return {};
  std::vector<Utterance> some;
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(corpus->utterances[i * corpus->utterances.size() / count]);
  return some;
}

Alignment check(const std::vector<Utterance>& sentences, int threads = 0) {
  std::vector<const Utterance*> list;
  for (const Utterance& u : sentences) list.push_back(&u);
  const auto alignment = check_alignment(list, threads);
  EXPECT_TRUE(alignment);
  return alignment ? *alignment : Alignment{};
}

std::vector<Utterance> moved(std::vector<Utterance> sentences, double seconds) {
  for (Utterance& u : sentences) u.script = shifted_script(u.script, seconds);
  return sentences;
}

/// The same scripts with motion in other controls: of a rig, of which one is noise.
std::vector<Utterance> of_a_rig(std::vector<Utterance> sentences) {
  test::Uniform random(1);
  for (Utterance& u : sentences) {
    Signal rig;
    rig.rate = u.signal.rate;
    rig.names = {"open", "wide", "twitch"};
    for (std::size_t i = 0; i < u.signal.frames(); ++i) {
      rig.values.push_back(0.3 - 0.001 * (u.signal.at(i, 1) + u.signal.at(i, 2)));
      rig.values.push_back(0.002 * u.signal.at(i, 3) + 0.001 * u.signal.at(i, 0));
      rig.values.push_back(random(0, 1));
    }
    u.signal = rig;
  }
  return sentences;
}

TEST(Alignment, OfGoodMaterialThereIsNothingToSay) {
  for (const std::size_t count : {5u, 7u, 12u, 24u}) {
    const Alignment a = check(sample(count));
    EXPECT_FALSE(a.unrelated) << count;
    EXPECT_TRUE(a.doubts.empty()) << count;
    ASSERT_TRUE(a.lag) << count;
    EXPECT_FALSE(a.lag->notable()) << count;
    EXPECT_LT(std::abs(a.lag->seconds), 0.02) << count;
    EXPECT_FALSE(check(of_a_rig(sample(count))).unrelated) << count;
  }
}

TEST(Alignment, LagsAreToldWithTheirSign) {
  for (const bool rig : {false, true}) {
    for (const std::size_t count : {7u, 24u}) {
      const auto sentences = rig ? of_a_rig(sample(count)) : sample(count);
      const Alignment in_time = check(sentences);
      ASSERT_TRUE(in_time.lag);
      for (const double late : {-0.2, -0.16, -0.08, 0.08, 0.16, 0.2}) {
        const Alignment a = check(moved(sentences, -late));  // the script early: the motion late
        ASSERT_TRUE(a.lag) << late;
        EXPECT_NEAR(a.lag->seconds - in_time.lag->seconds, late, 0.015) << count;
        EXPECT_LE(a.lag->low, a.lag->seconds);
        EXPECT_GE(a.lag->high, a.lag->seconds);
        EXPECT_LT(a.lag->high - a.lag->low, 0.08);
        EXPECT_TRUE(a.lag->notable()) << late;
        EXPECT_TRUE(a.doubts.empty()) << late;
      }
    }
  }
}

TEST(Alignment, OneShortSentenceTellsNothing) {
  const Alignment one = check(sample(1)), two = check(moved(sample(2), 0.1));
  EXPECT_FALSE(one.lag);
  EXPECT_FALSE(two.lag);
  EXPECT_FALSE(one.unrelated);
  EXPECT_TRUE(one.doubts.empty());
  EXPECT_EQ(check({}).sentences, 0u);
}

TEST(Alignment, ScriptsOfOtherSentencesAreNoticed) {
  for (const std::size_t count : {7u, 12u, 24u}) {
    auto sentences = sample(count);
    std::vector<Script> scripts;
    for (const Utterance& u : sentences) scripts.push_back(u.script);
    std::rotate(scripts.begin(), scripts.begin() + 3, scripts.end());
    for (std::size_t i = 0; i < count; ++i) sentences[i].script = scripts[i];
    const Alignment a = check(sentences);
    EXPECT_TRUE(a.unrelated) << count << ": " << a.fit << " against " << a.chance;
    EXPECT_FALSE(a.lag);
  }
}

TEST(Alignment, WrongSentencesAmongRightOnesAreNamed) {
  auto sentences = sample();
  std::swap(sentences[3].script, sentences[16].script);
  sentences[9].script = shifted_script(sentences[9].script, -0.2);
  const Alignment a = check(sentences);
  EXPECT_FALSE(a.unrelated);
  std::vector<std::string> others;
  for (const ScriptDoubt& doubt : a.doubts) {
    if (doubt.id == sentences[9].id) {
      ASSERT_TRUE(doubt.shift);
      EXPECT_NEAR(*doubt.shift, 0.2, 0.04);
    } else {
      others.push_back(doubt.id);
    }
  }
  EXPECT_EQ(a.doubts.size(), others.size() + 1);
  EXPECT_THAT(others, testing::UnorderedElementsAre(sentences[3].id, sentences[16].id));
}

TEST(Alignment, IsTheSameForAnyThreadsAndOrder) {
  auto sentences = moved(sample(9), 0.1);
  const Alignment a = check(sentences, 1);
  std::reverse(sentences.begin(), sentences.end());
  const Alignment b = check(sentences, 3);
  ASSERT_TRUE(a.lag && b.lag);
  EXPECT_EQ(a.lag->seconds, b.lag->seconds);
  EXPECT_EQ(a.lag->low, b.lag->low);
  EXPECT_EQ(a.fit, b.fit);
  EXPECT_EQ(a.chance, b.chance);
}

TEST(Alignment, ShiftedScriptsBeginAtZero) {
  const Script script{{{0, 0.5, "SIL", ""}, {0.5, 0.7, "AA", "a"}, {0.7, 1, "SIL", ""}}};
  const Script later = shifted_script(script, 0.1), earlier = shifted_script(script, -0.6);
  ASSERT_EQ(later.phones.size(), 3u);
  EXPECT_EQ(later.phones[0].start, 0);
  EXPECT_NEAR(later.phones[1].start, 0.6, 1e-12);
  ASSERT_EQ(earlier.phones.size(), 2u);
  EXPECT_EQ(earlier.phones[0].start, 0);
  EXPECT_NEAR(earlier.phones[0].end, 0.1, 1e-12);
  EXPECT_TRUE(check_script(later));
  EXPECT_TRUE(check_script(earlier));
}

}  // namespace alignment_test
}  // namespace animeme::dam

// Pictures of evaluations, and the strip below a face.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tools/view/plot/curves.h"
#include "tools/view/plot/sentences.h"
#include "tools/view/plot/strip.h"

namespace animeme {
namespace plot_test {

using testing::HasSubstr;
using testing::Not;

dam::Signal signal_of(std::vector<std::string> names, std::vector<double> values) {
  dam::Signal signal;
  signal.rate = {25, 1};
  signal.names = std::move(names);
  signal.values = std::move(values);
  return signal;
}

// Sentences that differ in their score alone.
struct Scored {
  std::vector<dam::SentencePair> pairs;
  dam::Evaluation evaluation;

  void add(const std::string& id, double nrmse, const dam::Signal& signal) {
    dam::SentencePair pair;
    pair.recorded.id = id;
    pair.recorded.text = "text of " + id;
    pair.recorded.signal = signal;
    pair.synthesised = signal;
    pairs.push_back(std::move(pair));
    dam::UtteranceScore score;
    score.id = id;
    score.nrmse = nrmse;
    evaluation.per_utterance.push_back(std::move(score));
  }
};

TEST(PlotSentences, BestMedianAndWorstOfMany) {
  Scored scored;
  const dam::Signal jaw = signal_of({"fap3_open_jaw"}, {1, 2, 3});
  scored.add("bad", 0.9, jaw);
  scored.add("good", 0.1, jaw);
  scored.add("other", 0.8, jaw);
  scored.add("middle", 0.5, jaw);
  const auto svg = plot::sentences_svg(scored.pairs, scored.evaluation);
  ASSERT_TRUE(svg) << svg.error().describe();
  EXPECT_THAT(*svg, HasSubstr("best: good &quot;text of good&quot;  (NRMSE 0.100)"));
  EXPECT_THAT(*svg, HasSubstr("median: other"));
  EXPECT_THAT(*svg, HasSubstr("worst: bad"));
  EXPECT_THAT(*svg, Not(HasSubstr("middle &quot;")));
  EXPECT_THAT(*svg, HasSubstr(">jaw<"));
}

TEST(PlotSentences, FewSentencesHaveFewPanels) {
  Scored scored;
  const dam::Signal shapes = signal_of({"smile"}, {0, 1});
  scored.add("one", 0.2, shapes);
  const auto one = plot::sentences_svg(scored.pairs, scored.evaluation);
  ASSERT_TRUE(one);
  EXPECT_THAT(*one, HasSubstr("best: one"));
  EXPECT_THAT(*one, Not(HasSubstr("worst: ")));
  EXPECT_THAT(*one, HasSubstr(">smile<"));  // no FAP of the mouth: the controls themselves
  scored.add("two", 0.3, shapes);
  const auto two = plot::sentences_svg(scored.pairs, scored.evaluation);
  ASSERT_TRUE(two);
  EXPECT_THAT(*two, HasSubstr("worst: two"));
  EXPECT_THAT(*two, Not(HasSubstr("median: ")));
}

TEST(PlotSentences, BarsTellWhenTheLipsAreShut) {
  // Gaps of 90, 40, 20, 40, 90: below 45 from 0.9 frames on, for 2.2.
  Scored scored;
  scored.add("b", 0.2,
             signal_of({"fap4_lower_t_midlip", "fap5_raise_b_midlip"},
                       {-90, 0, -40, 0, -20, 0, -40, 0, -90, 0}));
  const auto plain = plot::sentences_svg(scored.pairs, scored.evaluation);
  scored.pairs[0].recorded.script.phones = {{0.04, 0.12, "B", {}}};
  for (double& value : scored.pairs[0].synthesised.values) value -= 30;  // 60 at least: never shut
  const auto svg = plot::sentences_svg(scored.pairs, scored.evaluation);
  ASSERT_TRUE(plain && svg);
  EXPECT_THAT(*plain, Not(HasSubstr("fill=\"#0072b2\"")));
  EXPECT_THAT(*svg, HasSubstr("fill=\"#0072b2\""));
  EXPECT_THAT(*svg, Not(HasSubstr("fill=\"#d55e00\"")));
  // 600 pixels for 0.2 s from 150 on, and frame 0.9 is at 0.036 s.
  EXPECT_THAT(*svg, HasSubstr("<rect x=\"258"));
}

TEST(PlotSentences, MoreThanTenMinutesAreNotDrawn) {
  Scored scored;
  scored.add("long", 0.2, signal_of({"smile"}, std::vector<double>(25 * 601)));
  const auto svg = plot::sentences_svg(scored.pairs, scored.evaluation);
  ASSERT_FALSE(svg);
  EXPECT_EQ(svg.error().code, Code::out_of_range);
}

TEST(PlotStrip, CoversTheLowestRowsAndMarksTheTime) {
  fap::Sequence clip{{25, 1}, {}, "clip"};
  for (int i = 0; i < 50; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, i);
    clip.frames.push_back(frame);
  }
  plot::StripOptions options;
  options.width = 40;
  options.height = 16;
  options.faps = {3};
  options.page = 2;
  plot::Strip strip(clip, options);
  const auto pixel = [](const std::vector<std::uint8_t>& rgba, int x, int y) {
    return rgba[std::size_t((y * 40 + x) * 4)];
  };
  std::vector<std::uint8_t> picture(40 * 48 * 4, 7);
  const auto drawn = strip.draw(1.0, 48, picture);
  if (!drawn && drawn.error().code == Code::unsupported) GTEST_SKIP() << "no SVG renderer";
  ASSERT_TRUE(drawn) << drawn.error().describe();
  EXPECT_TRUE(std::all_of(picture.begin(), picture.begin() + 40 * 32 * 4,
                          [](std::uint8_t value) { return value == 7; }));
  EXPECT_EQ(pixel(picture, 0, 32), 0x14);  // the background of the strip
  for (int y = 32; y < 48; ++y) EXPECT_EQ(pixel(picture, 20, y), 255) << y;  // half of the page
  ASSERT_TRUE(strip.draw(2.5, 48, picture));                                 // the next page
  EXPECT_EQ(pixel(picture, 20, 32), 0x14);
  EXPECT_EQ(pixel(picture, 10, 32), 255);
}

}  // namespace plot_test
}  // namespace animeme

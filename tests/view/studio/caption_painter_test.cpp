#include <gtest/gtest.h>

#include <algorithm>

#include "tools/view/studio/captions.h"

namespace animeme::studio {
namespace caption_painter_test {

constexpr int kWidth = 320, kHeight = 240;

// A word each half second.
dam::Script said(const std::vector<std::string>& words) {
  dam::Script script;
  double at = 0.5;
  for (const std::string& word : words) {
    script.phones.push_back({.start = at, .end = at + 0.5, .label = "AA", .word = word});
    at += 0.5;
  }
  return script;
}

struct Counts {
  int white = 0, yellow = 0, other = 0;
  int highest = kHeight, lowest = -1, leftmost = kWidth, rightmost = -1;
};

// What is drawn on a blue picture at a time; nothing: no librsvg.
std::optional<Counts> drawn_at(CaptionPainter& painter, double seconds) {
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < kWidth * kHeight; ++i) rgba.insert(rgba.end(), {0, 0, 200, 255});
  const auto done = painter.draw(seconds, rgba);
  if (!done && done.error().code == Code::unsupported) return std::nullopt;
  EXPECT_TRUE(done) << done.error().describe();
  Counts counts;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint8_t* p = &rgba[std::size_t(y * kWidth + x) * 4];
      EXPECT_EQ(p[3], 255);
      if (p[0] == 0 && p[1] == 0 && p[2] == 200) continue;
      counts.white += p[0] > 240 && p[1] > 240 && p[2] > 240;
      counts.yellow += p[0] > 240 && p[1] > 200 && p[2] < 100;
      ++counts.other;
      counts.highest = std::min(counts.highest, y);
      counts.lowest = std::max(counts.lowest, y);
      counts.leftmost = std::min(counts.leftmost, x);
      counts.rightmost = std::max(counts.rightmost, x);
    }
  }
  return counts;
}

TEST(CaptionPainter, TheWordThatIsSaidHasAnotherColour) {
  CaptionPainter painter(said({"MMMM", "illi", "WWWW"}), kWidth, kHeight);
  EXPECT_FALSE(painter.empty());
  const auto first = drawn_at(painter, 0.6);
  if (!first) GTEST_SKIP() << "this FFmpeg has no librsvg";
  const auto second = *drawn_at(painter, 1.2), third = *drawn_at(painter, 1.7);
  EXPECT_GT(first->yellow, 50);
  EXPECT_GT(first->white, 50);
  EXPECT_LT(second.yellow, first->yellow / 2) << "a narrow word";
  EXPECT_GT(third.yellow, 2 * second.yellow);
  // The line stays where it is, in the middle of the lower part.
  EXPECT_EQ(first->leftmost, second.leftmost);
  EXPECT_EQ(first->rightmost, third.rightmost);
  EXPECT_NEAR(first->leftmost, kWidth - 1 - first->rightmost, 6);
  EXPECT_GT(first->highest, kHeight / 2);
  EXPECT_LT(first->lowest, kHeight - 4);
  // Before and after the speech there is none.
  EXPECT_EQ(drawn_at(painter, 0.0)->other, 0);
  EXPECT_EQ(drawn_at(painter, 60.0)->other, 0);
}

TEST(CaptionPainter, LongLinesStayInThePicture) {
  CaptionPainter painter(
      said({"Incomprehensibilities", "counterrevolutionaries", "WWWWWW", "electroencephalograms"}),
      kWidth, kHeight);
  for (double at = 0.6; at < 2.5; at += 0.5) {
    const auto counts = drawn_at(painter, at);
    if (!counts) GTEST_SKIP() << "this FFmpeg has no librsvg";
    ASSERT_GT(counts->other, 100);
    EXPECT_GT(counts->leftmost, 0) << at;
    EXPECT_LT(counts->rightmost, kWidth - 1) << at;
    EXPECT_LT(counts->lowest, kHeight - 1) << at;
  }
}

TEST(CaptionPainter, WhatIsNoLetterIsNoMarkup) {
  CaptionPainter painter(said({"<b>", "&", "\"x\"", "]]>", "שלום", "日本"}), kWidth, kHeight);
  for (double at = 0.6; at < 3.5; at += 0.5) {
    const auto counts = drawn_at(painter, at);
    if (!counts) GTEST_SKIP() << "this FFmpeg has no librsvg";
    EXPECT_GT(counts->other, 20) << at;
  }
  EXPECT_TRUE(CaptionPainter(dam::Script(), kWidth, kHeight).empty());
}

// Pictures without a background get alpha where the letters are.
TEST(CaptionPainter, LettersHaveAlpha) {
  CaptionPainter painter(said({"WWWW"}), kWidth, kHeight);
  std::vector<std::uint8_t> rgba(std::size_t(kWidth * kHeight) * 4, 0);
  const auto done = painter.draw(0.7, rgba);
  if (!done && done.error().code == Code::unsupported) GTEST_SKIP() << "no librsvg";
  ASSERT_TRUE(done);
  int full = 0, soft = 0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    full += rgba[i + 3] == 255;
    soft += rgba[i + 3] > 0 && rgba[i + 3] < 255;
    // The colours are not multiplied with alpha: the outline is dark, the letters are not.
    if (rgba[i + 3] == 0) {
      EXPECT_EQ(rgba[i], 0);
    }
  }
  EXPECT_GT(full, 100);
  EXPECT_GT(soft, 50);
}

}  // namespace caption_painter_test
}  // namespace animeme::studio

#include "tools/speech/talking/lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace animeme::speech {
namespace lines_test {

class Lines : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::pipe(ends), 0);
    auto maker = voice_lines({});
    if (!maker && maker.error().code == Code::unsupported) {
      GTEST_SKIP() << maker.error().message;
    }
    ASSERT_TRUE(maker) << maker.error().describe();
    auto opened = VoiceLines::open(ends[0], std::move(*maker), media::steady_clock());
    ASSERT_TRUE(opened) << opened.error().describe();
    lines = std::move(*opened);
  }
  void TearDown() override {
    lines.reset();
    close_input();
    ::close(ends[0]);
  }
  void type(const std::string& text) {
    ASSERT_EQ(::write(ends[1], text.data(), text.size()), ssize_t(text.size()));
  }
  void close_input() {
    if (ends[1] >= 0) ::close(ends[1]);
    ends[1] = -1;
  }
  // Until there are `count` lines or all is over.
  std::vector<SpokenLine> take(std::size_t count) {
    std::vector<SpokenLine> all;
    for (int i = 0; i < 3000 && all.size() < count && !lines->ended(); ++i) {
      while (auto line = lines->take(false)) all.push_back(std::move(*line));
      (void)lines->take_news();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return all;
  }

  int ends[2] = {-1, -1};
  std::unique_ptr<VoiceLines> lines;
};

TEST_F(Lines, AreSpokenAsTheyComeInTheirOrder) {
  type("Good mor");
  EXPECT_FALSE(lines->take(false));
  type("ning.\n\n   \nHow are you?\r\n");
  auto all = take(2);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].text, "Good morning.");
  EXPECT_EQ(all[1].text, "How are you?");
  for (const SpokenLine& line : all) {
    EXPECT_GT(line.speech.audio.duration(), 0.5);
    EXPECT_EQ(line.speech.audio.sample_rate, lines->sample_rate());
    EXPECT_GE(line.spoken, line.arrived);
  }
  EXPECT_FALSE(lines->ended());
  type("The end");
  close_input();
  all = take(1);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].text, "The end");
  for (int i = 0; i < 3000 && !lines->ended(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(lines->ended());
}

TEST_F(Lines, MarksAreNotSaid) {
  type("[laughs] Hi Bob.\nHi Bob.\n");
  const auto all = take(2);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].text, "[laughs] Hi Bob.");
  EXPECT_EQ(all[0].speech.script, all[1].speech.script);
  EXPECT_EQ(all[0].doubt, "the mark \"[laughs]\" is not said (--speak-marks says such marks)");
  EXPECT_EQ(all[1].doubt, "");
}

TEST_F(Lines, WhatCannotBeSpokenIsTold) {
  type("...\nYes.\n");
  close_input();
  const auto all = take(1);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].text, "Yes.");
  EXPECT_THAT(lines->take_warnings(), testing::ElementsAre(testing::HasSubstr("left out")));
}

TEST_F(Lines, ALongLineIsCutAtABlank) {
  std::string text;
  while (text.size() < 4100) text += "word ";
  type(text + "\n");
  close_input();
  const auto all = take(2);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_LE(all[0].text.size(), 4000u);
  EXPECT_TRUE(all[0].text.ends_with("word"));
  EXPECT_TRUE(all[1].text.starts_with("word"));
}

TEST_F(Lines, ManyAtOnceWaitToBeTaken) {
  std::atomic<int> made = 0;
  LineMaker maker;
  maker.make = [&made](std::string line, const Wanted&) -> Result<SpokenLine> {
    ++made;
    SpokenLine spoken;
    spoken.text = std::move(line);
    return spoken;
  };
  auto opened = VoiceLines::open(ends[0], maker, media::steady_clock());
  ASSERT_TRUE(opened);
  lines = std::move(*opened);
  std::string text;
  for (int i = 0; i < 12; ++i) text += "Go.\n";
  type(text);
  close_input();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(made, 4);
  EXPECT_EQ(take(12).size(), 12u);
  EXPECT_EQ(made, 12);
  lines.reset();
}

TEST_F(Lines, CanBeLeftWhileLinesWait) {
  std::string text;
  for (int i = 0; i < 12; ++i) text += "Go.\n";
  type(text);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  lines.reset();
}

TEST_F(Lines, CanBeLeftWhileTheInputStaysOpen) {
  type("Hello.\n");
  lines.reset();  // does not wait for more
}

TEST(VoiceLinesOpen, AVoiceThatIsMissingIsKnownAtOnce) {
  const auto opened = voice_lines({.language = "no such voice"});
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().code, testing::AnyOf(Code::not_found, Code::unsupported));
}

}  // namespace lines_test
}  // namespace animeme::speech

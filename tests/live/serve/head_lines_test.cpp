#include "tools/live/serve/head_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace animeme::test {
namespace head_lines_test {

using serve::HeadLines;
using serve::Voices;
using testing::ElementsAre;
using testing::HasSubstr;

/// A voice that says nothing, but notes what it was asked for.
struct SilentVoice {
  std::mutex mutex;
  std::vector<std::string> said;
  std::atomic<int> makers = 0;

  Result<speech::LineMaker> maker(const voice::VoiceOptions& options) {
    ++makers;
    if (options.language == "none") return make_error(Code::not_found, "no such voice");
    speech::LineMaker maker;
    maker.make = [this](std::string line, const speech::Wanted&) -> Result<speech::SpokenLine> {
      if (line == "throw") throw std::bad_alloc();
      if (line == "bad") return make_error(Code::invalid_argument, "it is bad");
      const std::lock_guard lock(mutex);
      said.push_back(line);
      speech::SpokenLine spoken;
      spoken.text = std::move(line);
      return spoken;
    };
    maker.most_bytes = 100;
    maker.cut = false;
    return maker;
  }
};

std::vector<std::string> take(HeadLines& lines, std::size_t count) {
  std::vector<std::string> texts;
  for (int i = 0; i < 1000 && texts.size() < count; ++i) {
    while (const auto line = lines.take(false)) texts.push_back(line->text);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return texts;
}

class HeadLinesTest : public testing::Test {
 protected:
  std::shared_ptr<HeadLines> make() {
    Result<speech::LineMaker> maker = voices_.maker({});
    EXPECT_TRUE(maker);
    return std::make_shared<HeadLines>(*maker, voices_, media::steady_clock(), [this] { ++told_; });
  }
  SilentVoice voice_;
  Voices voices_{[this](const voice::VoiceOptions& options) { return voice_.maker(options); }};
  std::atomic<int> told_ = 0;
};

TEST_F(HeadLinesTest, ComeInTheirOrder) {
  const auto lines = make();
  EXPECT_TRUE(lines->idle());
  ASSERT_TRUE(lines->push({"one", "", "two"}));
  ASSERT_TRUE(lines->push({"three"}));
  EXPECT_FALSE(lines->idle());
  EXPECT_THAT(take(*lines, 3), ElementsAre("one", "two", "three"));
  (void)lines->take_news();
  EXPECT_TRUE(lines->idle());
  EXPECT_EQ(lines->given(), 3);
  lines->stop();
  EXPECT_GE(told_, 3);
}

TEST_F(HeadLinesTest, FewAreMadeAheadAndDropped) {
  const auto lines = make();
  ASSERT_TRUE(lines->push(std::vector<std::string>(50, "again")));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(lines->waiting(), 50U);
  {
    const std::lock_guard lock(voice_.mutex);
    EXPECT_EQ(voice_.said.size(), 4U);
  }
  ASSERT_TRUE(lines->push({R"({"do": "drop"})"}));
  EXPECT_EQ(lines->waiting(), 0U);
  EXPECT_FALSE(lines->idle());  // that is still to be told
  const std::vector<speech::LineNews> news = lines->take_news();
  EXPECT_EQ(news.size(), 50U + 1 + 50);
  EXPECT_TRUE(lines->idle());
}

TEST_F(HeadLinesTest, CommandsGoAmongLines) {
  const auto lines = make();
  ASSERT_TRUE(lines->push({"one", R"({"do": "say", "text": "two", "when": "next"})"}));
  EXPECT_EQ(take(*lines, 2).size(), 2U);
  EXPECT_FALSE(lines->push({R"({"do": "dance"})"}));
  const auto ids = lines->push(
      {"three", R"({"do": "mark", "id": "m"})", R"({"do": "say", "text": "four", "id": "x"})"});
  ASSERT_TRUE(ids);
  EXPECT_THAT(*ids, ElementsAre("4", "x"));
  const auto end = lines->push({R"({"do": "end"})"});
  ASSERT_FALSE(end);
  EXPECT_THAT(end.error().message, HasSubstr("DELETE"));
}

TEST_F(HeadLinesTest, HeadsTakeTurns) {
  const auto first = make(), second = make();
  ASSERT_TRUE(first->push(std::vector<std::string>(20, "first")));
  ASSERT_TRUE(second->push({"second"}));
  EXPECT_THAT(take(*second, 1), ElementsAre("second"));
  EXPECT_EQ(voice_.makers, 1);  // of one voice
}

TEST_F(HeadLinesTest, OnesThatCannotBeSpokenAreToldAndLeftOut) {
  const auto lines = make();
  ASSERT_TRUE(lines->push({"bad", "good"}));
  EXPECT_THAT(take(*lines, 1), ElementsAre("good"));
  EXPECT_THAT(lines->last_warning(), HasSubstr("\"bad\", is left out: it is bad"));
  ASSERT_TRUE(lines->push({"throw", "good"}));
  EXPECT_THAT(take(*lines, 1), ElementsAre("good"));
  EXPECT_THAT(lines->last_warning(), HasSubstr("\"throw\""));
}

TEST_F(HeadLinesTest, LimitsTakeAllOrNothing) {
  const auto lines = make();
  EXPECT_FALSE(lines->push(std::vector<std::string>(HeadLines::kMostLines + 1, "x")));
  EXPECT_FALSE(lines->push(std::vector<std::string>(700, std::string(100, 'x'))));
  EXPECT_TRUE(lines->idle());
  EXPECT_TRUE(lines->push(std::vector<std::string>(HeadLines::kMostLines, "x")));
}

TEST_F(HeadLinesTest, VoicesThatAreNotThereAreErrors) {
  const Result<speech::LineMaker> none = voices_.maker({.language = "none"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::not_found);
}

}  // namespace head_lines_test
}  // namespace animeme::test

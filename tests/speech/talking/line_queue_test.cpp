// The queue between reader, voice and head, without threads.
#include "tools/speech/talking/line_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/speech/talking/line_events.h"

namespace animeme::speech {
namespace line_queue_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using What = LineNews::What;

class Queue : public testing::Test {
 protected:
  void push(const std::string& line) { ASSERT_TRUE(queue.push(line, ++now)) << line; }
  // Lets the voice make all that it may.
  void make_all() {
    while (auto job = queue.try_job()) {
      SpokenLine line;
      line.text = job->payload;
      ++made;
      queue.made(job->line, std::move(line), ++now);
    }
  }
  std::vector<std::string> taken() {
    std::vector<std::string> ids;
    for (make_all(); auto line = queue.take(false); make_all()) {
      ids.push_back((line->mark ? "mark " : "") + line->id);
    }
    return ids;
  }
  // "queued 1", "cancelled 2 dropped" ...
  std::vector<std::string> news() {
    std::vector<std::string> all;
    for (const LineNews& one : queue.take_news()) {
      const char* names[] = {"queued ", "cancelled ", "stopped ", "dropped "};
      const bool command = one.what == What::stopped || one.what == What::dropped;
      all.push_back(names[int(one.what)] + (command ? std::to_string(one.line) : one.id) +
                    (one.why.empty() ? "" : " " + one.why));
    }
    return all;
  }

  LineQueue queue{100, true, false};
  double now = 0;
  int made = 0;
};

TEST_F(Queue, GivesNumbersWhereThereAreNoNames) {
  push("One.");
  push("{\"do\":\"say\",\"text\":\"Two.\",\"id\":\"zwei\"}");
  push("Three.");
  EXPECT_THAT(news(), ElementsAre("queued 1", "queued zwei", "queued 3"));
  EXPECT_THAT(taken(), ElementsAre("1", "zwei", "3"));
  EXPECT_FALSE(queue.ended());
  queue.close();
  EXPECT_TRUE(queue.ended());
}

TEST_F(Queue, NextComesBeforeWhatWaitsAndBehindTheMarkOfWhatIsSpoken) {
  push("One.");
  push("{\"do\":\"mark\",\"id\":\"m\"}");
  push("Two.");
  push("{\"do\":\"mark\",\"id\":\"n\"}");
  make_all();
  EXPECT_EQ(queue.take(false)->id, "1");
  push("{\"do\":\"say\",\"text\":\"First\",\"when\":\"next\",\"id\":\"a\"}");
  push("{\"do\":\"say\",\"text\":\"Before\",\"when\":\"next\",\"id\":\"b\"}");
  EXPECT_THAT(taken(), ElementsAre("mark m", "b", "a", "3", "mark n"));
}

TEST_F(Queue, StopForgetsAllBeforeIt) {
  push("One.");
  push("Two.");
  push("{\"do\":\"mark\"}");
  make_all();
  push("{\"do\":\"stop\"}");
  push("Five.");
  EXPECT_THAT(news(), ElementsAre("queued 1", "queued 2", "stopped 4", "cancelled 1 stopped",
                                  "cancelled 2 stopped", "cancelled 3 stopped", "queued 5"));
  EXPECT_THAT(taken(), ElementsAre("5"));
  push("{\"do\":\"stop\"}");
  push("{\"do\":\"stop\"}");
  EXPECT_THAT(news(), ElementsAre("stopped 6", "stopped 7"));
}

TEST_F(Queue, SayNowStopsWhatWasThere) {
  push("One.");
  push("{\"do\":\"say\",\"text\":\"Now\",\"when\":\"now\",\"id\":\"x\"}");
  EXPECT_THAT(news(), ElementsAre("queued 1", "stopped 2", "cancelled 1 stopped", "queued x"));
  EXPECT_THAT(taken(), ElementsAre("x"));
}

TEST_F(Queue, DropLeavesTheRest) {
  push("One.");
  push("{\"do\":\"drop\"}");
  push("Three.");
  EXPECT_THAT(news(), ElementsAre("queued 1", "dropped 2", "cancelled 1 dropped", "queued 3"));
  EXPECT_THAT(taken(), ElementsAre("3"));
}

TEST_F(Queue, WhatTheVoiceMakesOfAForgottenLineIsThrownAway) {
  push("One.");
  const auto job = queue.try_job();
  ASSERT_TRUE(job);
  EXPECT_TRUE(queue.wanted(job->line));
  push("{\"do\":\"stop\"}");
  EXPECT_FALSE(queue.wanted(job->line));
  queue.made(job->line, SpokenLine{}, 1);
  EXPECT_THAT(taken(), IsEmpty());
  queue.close();
  EXPECT_FALSE(queue.ended());  // what became of it has not been told
  (void)queue.take_news();
  EXPECT_TRUE(queue.ended());
}

TEST_F(Queue, ALineThatCannotBeSpokenIsCancelledAndTold) {
  push("One.");
  push("Two.");
  queue.made(queue.try_job()->line, make_error(Code::not_found, "no voice"), 1);
  EXPECT_THAT(news(), ElementsAre("queued 1", "queued 2", "cancelled 1 no voice"));
  EXPECT_THAT(queue.take_warnings(), ElementsAre(HasSubstr("line 1, \"One.\", is left out")));
  EXPECT_THAT(taken(), ElementsAre("2"));
}

TEST_F(Queue, BadCommandsAreWarningsThatNameTheirLine) {
  push("One.");
  const auto refused = queue.push("{\"do\":\"jump\"}", 2);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("line 2"));
  EXPECT_THAT(queue.take_warnings(), ElementsAre(HasSubstr("line 2, \"{\"do\":\"jump\"}\"")));
  push("Three.");
  EXPECT_THAT(taken(), ElementsAre("1", "3"));
}

TEST_F(Queue, LongTextIsSpokenInPartsAndIsOneLineIfItHasAName) {
  const std::string text = "{ " + std::string(50, 'a') + " " + std::string(70, 'b');
  push(text);
  EXPECT_THAT(news(), ElementsAre("queued 1", "queued 2"));
  EXPECT_THAT(taken(), ElementsAre("1", "2"));
  const std::string named = "{\"do\":\"say\",\"id\":\"x\",\"text\":\"" + std::string(60, 'c') +
                            ". Go on. " + std::string(60, 'd') + " and " + std::string(60, 'e') +
                            "\"}";
  push(named);
  EXPECT_THAT(news(), ElementsAre("queued x"));
  make_all();
  LineEvents events;
  std::vector<std::string> texts, told;
  const auto tell = [&](double time) {
    events.tell(time);
    for (const LineEvent& event : events.take()) told.push_back(to_json(event).substr(0, 40));
  };
  double at = 1;
  while (auto line = queue.take(false)) {
    texts.push_back(line->text);
    EXPECT_EQ(line->whole, 3u);
    events.begin(*line, at, at + 1);
    ++at;
    make_all();
  }
  tell(10);
  EXPECT_EQ(texts.size(), 3u);
  EXPECT_LT(texts[1].size(), 100u);  // the whole text goes with its first part alone
  EXPECT_GT(texts[0].size(), 150u);
  EXPECT_THAT(told, ElementsAre(HasSubstr("started"), HasSubstr("done")));

  // Stopped in its first part, all of it is cancelled once.
  told.clear();
  push(named);
  (void)news();
  make_all();
  events.begin(*queue.take(false), 11, 12);
  push("{\"do\":\"stop\"}");
  for (const LineNews& one : queue.take_news()) {
    if (one.what == What::stopped) events.cut(11.5, one.line, "stopped");
    if (one.what != What::cancelled) continue;
    EXPECT_TRUE(one.part);
    events.cancel_parts(
        {.what = LineEvent::What::cancelled, .time = 11.5, .line = one.line, .id = one.id});
  }
  tell(20);
  EXPECT_THAT(told, ElementsAre(HasSubstr("started"), HasSubstr("cancelled")));
}

TEST_F(Queue, FourAreMadeAheadAndNextOnesAtOnce) {
  for (int i = 0; i < 100; ++i) push("Go.");
  make_all();
  EXPECT_EQ(made, 4);
  for (int i = 0; i < 20; ++i) push("{\"do\":\"say\",\"text\":\"x\",\"when\":\"next\"}");
  make_all();
  EXPECT_EQ(made, 8);
  EXPECT_EQ(queue.take(false)->id, "120");
  EXPECT_EQ(taken().size(), 119u);
  EXPECT_LE(made, 120 + 8);  // some were made again
}

TEST_F(Queue, TellsWhenItIsFull) {
  for (int i = 0; i < 100000; ++i) ASSERT_TRUE(queue.push("x", 0));
  EXPECT_TRUE(queue.full());
  push("{\"do\":\"drop\"}");
  EXPECT_FALSE(queue.full());
  EXPECT_EQ(queue.take_news().size(), 200001u);
}

TEST_F(Queue, UnicodeIsShownWhole) {
  std::string text;
  for (int i = 0; i < 40; ++i) text += "ü";
  push(text + "!");
  queue.made(1, make_error(Code::io, "gone"), 1);
  const auto warnings = queue.take_warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("üüü\""));
}

TEST_F(Queue, OnlyWhatJoinsIsTakenWhileSomethingIsSpoken) {
  push("One.");
  make_all();
  EXPECT_FALSE(queue.take(true));
  EXPECT_TRUE(queue.take(false));
}

}  // namespace line_queue_test
}  // namespace animeme::speech

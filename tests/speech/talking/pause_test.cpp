// Speech that is halted and goes on: nothing of its sound, its face and its events is lost or comes
// twice.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "tests/speech/talking/barge_stage.h"
#include "tools/speech/talking/line_command.h"

namespace animeme::speech {
namespace pause_test {

using namespace barge_stage;

class Pause : public Barge {};

std::vector<std::string> words_of(const std::vector<LineEvent>& events) {
  std::vector<std::string> words;
  for (const LineEvent& event : events) {
    if (event.what == What::word) words.push_back(event.text);
  }
  return words;
}

double time_of(const std::vector<LineEvent>& events, What what) {
  const auto found = std::find_if(events.begin(), events.end(),
                                  [what](const LineEvent& event) { return event.what == what; });
  return found == events.end() ? -1 : found->time;
}

// Seconds in which something is heard.
double heard(const media::Pcm& pcm) {
  double seconds = 0;
  for (double time = 0; time < pcm.duration(); time += 0.01) {
    if (level(pcm, time) > 0.01) seconds += 0.01;
  }
  return seconds;
}

// Its first letter selects the first of the voices, which says "Good morning, my old friend, ...".
constexpr const char* kText = "For whom it may concern.";

// The same line without a pause.
Stage& undisturbed() {
  static Stage stage;
  static const bool done = [] {
    stage.run(0.5);
    stage.push(kText);
    stage.end();
    return true;
  }();
  (void)done;
  return stage;
}

TEST_F(Pause, WhatWasLeftIsSaidAfterIt) {
  Stage& plain = undisturbed();
  const double whole = heard(plain.sound());
  const double length = time_of(plain.events, What::done) - time_of(plain.events, What::started);
  for (const double at : {0.7, 1.013, 1.317, 1.9, 2.4}) {
    Stage stage;
    stage.run(0.5);
    stage.push(kText);
    stage.run(at);
    stage.push(command("\"pause\""));
    stage.push(command("\"pause\""));  // it is one already
    stage.run(at + 2);
    const fap::Sequence still = stage.face();
    stage.push(command("\"resume\""));
    stage.push(command("\"resume\""));
    stage.end();
    check_events(stage.events);
    EXPECT_EQ(words_of(stage.events), words_of(plain.events)) << at;
    const double paused = time_of(stage.events, What::paused);
    const double resumed = time_of(stage.events, What::resumed);
    EXPECT_NEAR(paused, at, 0.05);
    EXPECT_NEAR(resumed, at + 2, 0.05);
    // Nothing is told of the line meanwhile, but for what was on its way to the ear.
    for (const LineEvent& event : stage.events) {
      if (event.what == What::word || event.what == What::phone || event.what == What::done) {
        EXPECT_FALSE(event.time > paused + 0.1 && event.time < resumed) << to_json(event);
      }
    }
    const double lasted = time_of(stage.events, What::done) - time_of(stage.events, What::started);
    EXPECT_NEAR(lasted, length + 2 + 0.1, 0.1) << at;
    // The mouth is at rest, and nothing is heard.
    const int rest = opening(still.frames[0]);
    for (auto i = std::size_t(std::ceil((at + 0.2) * 25)); i < still.frames.size(); ++i) {
      EXPECT_LE(std::abs(opening(still.frames[i]) - rest), 4) << at << ", frame " << i;
    }
    const media::Pcm pcm = stage.sound();
    for (double time = at + 0.12; time < at + 2; time += 0.01) {
      ASSERT_LT(level(pcm, time), kSilent) << at << ", " << time;
    }
    EXPECT_NEAR(heard(pcm), whole, 0.06) << at;
    // No mouth jumps.
    const auto usual = largest_steps(plain.face()), steps = largest_steps(stage.face());
    for (const int fap : {3, kUpper, kLower}) {
      EXPECT_LE(steps[std::size_t(fap)], usual[std::size_t(fap)] * 3 / 2) << "FAP " << fap;
    }
  }
}

// Face and sound go on together: the words begin where their sound does.
TEST_F(Pause, FaceAndSoundStayTogether) {
  Stage& plain = undisturbed();
  Stage stage;
  stage.run(0.5);
  stage.push(kText);
  stage.run(1.2);
  stage.push(command("\"pause\""));
  stage.run(2.5);
  stage.push(command("\"resume\""));
  stage.end();
  const double shift = time_of(stage.events, What::done) - time_of(plain.events, What::done);
  const media::Pcm before = plain.sound(), after = stage.sound();
  const fap::Sequence face = plain.face(), moved = stage.face();
  double common = 0, one = 0, other = 0;
  for (double time = 1.5; time < plain.sound().duration() - 0.3; time += 0.005) {
    const double a = level(before, time), b = level(after, time + shift);
    common += a * b, one += a * a, other += b * b;
  }
  EXPECT_GT(common / std::sqrt(one * other), 0.95) << "the sound is where its events say";
  double same = 0, first = 0, second = 0;
  const auto frames = int(std::lround(shift * 25));
  for (std::size_t i = 45; i + 10 < face.frames.size(); ++i) {
    const double a = opening(face.frames[i]);
    const double b = opening(moved.frames[i + std::size_t(frames)]);
    same += a * b, first += a * a, second += b * b;
  }
  EXPECT_GT(same / std::sqrt(first * second), 0.9) << "and so is the face";
}

TEST_F(Pause, NoLineBeginsUntilItEnds) {
  Stage stage;
  stage.run(0.5);
  stage.push(command("\"pause\""));  // nothing is said
  stage.push("Yes.");
  stage.push(command("\"mark\",\"id\":\"after\""));
  stage.run(3);
  EXPECT_EQ(time_of(stage.events, What::started), -1);
  EXPECT_EQ(time_of(stage.events, What::mark), -1);
  stage.push(command("\"resume\""));
  stage.end();
  check_events(stage.events);
  EXPECT_NEAR(time_of(stage.events, What::started), 3, 0.1);
  EXPECT_GE(time_of(stage.events, What::mark), time_of(stage.events, What::done));
}

TEST_F(Pause, AStopEndsIt) {
  for (const char* stop : {"\"stop\"", "\"say\",\"when\":\"now\",\"text\":\"Yes.\""}) {
    Stage stage;
    stage.run(0.5);
    stage.push(kText);
    stage.run(1.3);
    stage.push(command("\"pause\""));
    stage.run(2);
    stage.push(command(stop));
    stage.push("No.");
    stage.end();
    check_events(stage.events);
    EXPECT_EQ(time_of(stage.events, What::resumed), -1);
    const auto cancelled = std::find_if(stage.events.begin(), stage.events.end(),
                                        [](auto& event) { return event.what == What::cancelled; });
    ASSERT_NE(cancelled, stage.events.end());
    EXPECT_EQ(cancelled->line, 1u);
    EXPECT_THAT(cancelled->text, testing::StartsWith("Good morning")) << "what was heard";
    EXPECT_THAT(cancelled->text, testing::Not(testing::HasSubstr("today")));
    const auto done = std::count_if(stage.events.begin(), stage.events.end(),
                                    [](auto& event) { return event.what == What::done; });
    EXPECT_EQ(done, stop[1] == 's' && stop[2] == 't' ? 1 : 2);
  }
}

TEST_F(Pause, ADropLeavesTheLineThatWaits) {
  Stage stage;
  stage.run(0.5);
  stage.push(kText);
  stage.push("Yes.");
  stage.run(1.3);
  stage.push(command("\"pause\""));
  stage.push(command("\"drop\""));
  stage.run(2);
  stage.push(command("\"resume\""));
  stage.end();
  check_events(stage.events);
  EXPECT_EQ(words_of(stage.events), words_of(undisturbed().events));
}

TEST_F(Pause, TheEndOfTheInputEndsIt) {
  Stage stage;
  stage.run(0.5);
  stage.push(kText);
  stage.run(1.3);
  stage.push(command("\"pause\""));
  stage.run(2);
  stage.end();  // nobody can resume it any more
  check_events(stage.events);
  EXPECT_EQ(words_of(stage.events), words_of(undisturbed().events));
  EXPECT_NEAR(time_of(stage.events, What::resumed), 2, 0.1);
}

// Pauses, stops and lines at random: each line ends once, and what was not stopped is said whole.
TEST_F(Pause, AnyOrderOfCommands) {
  for (const bool joins : {false, true}) {
    Stage stage(true, 1);
    stage.joins = joins;
    std::minstd_rand random(joins ? 11 : 7);
    double now = 0.3;
    std::size_t stops = 0;
    for (int i = 0; i < 300; ++i) {
      stage.run(now);
      switch (random() % 12) {
        case 0:
        case 1:
        case 2:
          stage.push(command("\"pause\""));
          break;
        case 3:
        case 4:
        case 5:
        case 6:
          stage.push(command("\"resume\""));
          break;
        case 7:
          stage.push(command("\"stop\""));
          ++stops;
          break;
        default:
          stage.push(std::string(1, char('a' + random() % 5)));
      }
      now += 0.04 * double(random() % 25);
    }
    stage.end();
    check_events(stage.events);
    EXPECT_GT(stops, 10u);
    EXPECT_TRUE(stage.speaker->silent());
    std::size_t paused = 0, resumed = 0;
    for (const LineEvent& event : stage.events) {
      paused += event.what == What::paused ? 1 : 0;
      resumed += event.what == What::resumed ? 1 : 0;
    }
    EXPECT_GT(resumed, 10u);
    EXPECT_GE(paused, resumed);
    EXPECT_LE(paused, resumed + stops);
  }
}

TEST(PauseCommand, IsReadAndHasNoMembers) {
  const auto pause = read_line(R"({"do": "pause"})", false);
  ASSERT_TRUE(pause);
  EXPECT_EQ(pause->what, LineCommand::Do::pause);
  EXPECT_EQ(read_line(R"({"do": "resume"})", true)->what, LineCommand::Do::resume);
  EXPECT_FALSE(read_line(R"({"do": "pause", "text": "x"})", false));
  EXPECT_EQ(to_json({.what = What::paused, .time = 1}), R"({"event":"paused","time":1.0})");
}

}  // namespace pause_test
}  // namespace animeme::speech

// A head that is interrupted: on a clock of the test's own, with a voice that takes its time. What
// it sends is decoded and looked at; the plans are random and the same each time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "dam/model/builtin.h"
#include "dam/script/mood.h"
#include "dam/signal/fap_signal.h"
#include "tests/speech/talking/barge_stage.h"
#include "tools/speech/talking/line_queue.h"
#include "tools/speech/talking/live_speaker.h"

namespace animeme::speech {
namespace barge_test {

using namespace barge_stage;
using media::LiveTrack;
using What = LineEvent::What;

TEST_F(Barge, AStopClosesTheMouthIn100MsAndFadesTheSound) {
  for (const double at : {1.0, 1.317, 1.613, 2.05}) {
    Stage stage;
    stage.run(0.5);
    stage.push("Wow, how loud you shout!");
    stage.push("And more.");
    stage.run(at);
    stage.push(command("\"stop\""));
    stage.run(at + 1);
    stage.end();
    check_events(stage.events);
    const fap::Sequence clip = stage.face();
    const int rest = opening(clip.frames[0]);
    // The command is heard with the next unit that is due, the mouth closes from the next frame on.
    const auto next = std::size_t(std::ceil(at * 25));
    EXPECT_GT(std::abs(opening(clip.frames[next - 1]) - rest), 5) << at;
    for (std::size_t i = std::size_t(std::ceil((at + 0.04 + 0.1) * 25)); i < clip.frames.size();
         ++i) {
      EXPECT_LE(std::abs(opening(clip.frames[i]) - rest), 4) << at << ", frame " << i;
    }
    const media::Pcm pcm = stage.sound();
    double spoken = 0;
    for (double time = at - 0.1; time < at; time += 0.01)
      spoken = std::max(spoken, level(pcm, time));
    EXPECT_GT(spoken, 0.01);
    // What the encoder has already been given, and 20 ms.
    for (double time = at + 0.1; time < at + 0.9; time += 0.005) {
      EXPECT_LT(level(pcm, time), kSilent) << at << ", " << time;
    }
  }
}

// 200 lines, stops, looks and states at random.
fap::Sequence restless(bool life, int quant) {
  Stage stage(life, quant);
  const char* const commands[] = {R"("stop")",
                                  R"("look","target":"camera")",
                                  R"("look","target":"40,-15")",
                                  R"("look","target":[-0.4,0.1,0.7])",
                                  R"("look","target":"away")",
                                  R"("look","target":"-60,40")",
                                  R"("listen")",
                                  R"("think")",
                                  R"("idle")",
                                  R"("drop")"};
  std::minstd_rand random(5);
  double now = 0.3;
  for (int i = 0; i < 200; ++i) {
    stage.run(now);
    const auto kind = random() % 13;
    if (kind < std::size(commands))
      stage.push(command(commands[kind]));
    else
      stage.push(std::string(1, char('a' + random() % 5)));
    now += 0.05 * double(random() % 30);
  }
  stage.run(now + 2);
  stage.end();
  return stage.face();
}

TEST_F(Barge, LooksAndStopsNeverMakeTheFaceJump) {
  const fap::Sequence clip = restless(true, 1);
  ASSERT_GT(clip.frames.size(), 2000u);
  const auto steps = largest_steps(clip);
  // A frame has 40 ms: 6 degrees of the head, 4 mm of the brows, an eye from end to end, a lid.
  for (const std::size_t fap : {48, 49, 50}) EXPECT_LT(steps[fap], 6 * 1745) << fap;
  for (std::size_t fap = 31; fap <= 36; ++fap) EXPECT_LT(steps[fap], 80) << fap;
  for (const std::size_t fap : {23, 24}) EXPECT_LT(steps[fap], 70 * 1745) << fap;
  for (const std::size_t fap : {19, 20}) EXPECT_LE(steps[fap], 1250) << fap;
  double turned = 0;
  for (const fap::Frame& frame : clip.frames)
    turned = std::max(turned, std::abs(double(frame.value[49])) / 1745);
  EXPECT_GT(turned, 20) << "the head goes along with looks of 60 degrees";
}

// Lines, stops, moods, looks, states and the voice of the other, 200 times, at random times.
fap::Sequence everything_at_once(std::uint64_t seed) {
  Stage stage(true, 1, true, seed);
  const std::vector<std::string> moods = dam::mood_names();
  const char* const targets[] = {"camera", "away", "50,-20", "-60,40", "0.3,-0.2,0.4"};
  const char* const others[] = {R"("stop")", R"("drop")", R"("listen")", R"("think")", R"("idle")"};
  std::mt19937 random{std::uint32_t(seed)};
  const auto below = [&](std::size_t count) { return random() % count; };
  const auto mood = [&] {
    const std::string name = moods[below(moods.size())];
    return R"("mood":")" + name + ":" + std::to_string(0.5 * double(below(3))) + "\"";
  };
  double now = 0.3;
  for (int i = 0; i < 200; ++i) {
    stage.run(now);
    const std::string words(1, char('a' + below(5)));
    switch (below(8)) {
      case 0:
        stage.push(command(R"("mood",)" + mood()));
        break;
      case 1:
        stage.push(command(R"("look","target":")" + std::string(targets[below(5)]) + "\""));
        break;
      case 2:
        stage.push(command(below(2) == 0 ? R"("hear","voice":true)" : R"("hear","voice":false)"));
        break;
      case 3:
        stage.push(command(others[below(std::size(others))]));
        break;
      case 4:
      case 5: {
        const char* const when = below(2) == 0 ? "now" : "next";
        stage.push(command(R"("say","text":")" + words + R"(","when":")" + when + "\"," + mood()));
        break;
      }
      default:
        stage.push(words);
    }
    now += 0.04 * double(below(40));
  }
  stage.run(now + 2);
  stage.end();
  return stage.face();
}

// What people do at most in 40 ms, in units of each FAP. Jaw 200 mm/s, lips 300 (Ostry, Munhall
// 1985: half of that in speech), corners 200, brows and cheeks 120, nose 60; lids shut in 60 ms;
// head 150 degrees/s; saccades 700. For a face with mouth 50, mouth to nose 27, eye to nose 48 mm.
double most_of_people(int fap) {
  const fap::FapInfo& info = fap::info(fap);
  const auto millimetres = [&](double a_second) {
    const double size = info.unit == fap::Unit::mw ? 50 : info.unit == fap::Unit::mns ? 27 : 48;
    return a_second * 0.04 / size * 1024;
  };
  constexpr double kDegree = 1745.3;
  switch (info.group) {
    case 2:
    case 8:
      if (fap == 3 || (fap >= 14 && fap <= 18)) return millimetres(200);
      return millimetres(info.unit == fap::Unit::mw ? 200 : 300);
    case 3:
      return fap <= 22 ? 1250 : 28 * kDegree;
    case 4:
    case 5:
      return millimetres(120);
    case 7:
      return 6 * kDegree;
    case 9:
      return millimetres(60);
    default:
      return std::numeric_limits<double>::infinity();  // the tongue: below
  }
}

TEST_F(Barge, MoodsLooksAndVoicesAtRandomAskNothingThatPeopleCannotDo) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const fap::Sequence clip = everything_at_once(seed);
    ASSERT_GT(clip.frames.size(), 2000u);
    const auto steps = largest_steps(clip);
    for (int fap = int(fap::kFirstLowLevel); fap <= int(fap::kFapCount); ++fap)
      EXPECT_LE(steps[std::size_t(fap)], most_of_people(fap)) << fap << ", seed " << seed;
    // The tip goes from the floor to the ridge in two frames at least.
    for (const std::size_t fap : {44, 45, 46}) EXPECT_LE(steps[fap], 700) << fap;
  }
}

TEST_F(Barge, IdleMotionLeavesTheMouthAlone) {
  const fap::Sequence still = restless(false, 0), alive = restless(true, 0);
  ASSERT_EQ(still.frames.size(), alive.frames.size());
  for (std::size_t i = 0; i < still.frames.size(); ++i) {
    for (std::size_t fap = 3; fap <= 60; ++fap) {
      if (fap > 18 && fap < 51) continue;
      ASSERT_EQ(still.frames[i].value[fap], alive.frames[i].value[fap]) << i << ", FAP " << fap;
    }
  }
}

TEST_F(Barge, SayNowInterruptsAndIsSpoken) {
  Stage stage;
  stage.run(0.5);
  stage.push("I wonder whether all of this will fit into one sentence.");
  stage.push("More.");
  stage.run(1.7);
  stage.push(command("\"say\",\"text\":\"Yes, please?\",\"when\":\"now\",\"id\":\"x\""));
  stage.end();
  check_events(stage.events);
  std::vector<std::string> ends;
  double x = 0;
  for (const LineEvent& event : stage.events) {
    if (event.what == What::done) ends.push_back("done " + event.id);
    if (event.what == What::cancelled) ends.push_back("cancelled " + event.id);
    if (event.what == What::started && event.id == "x") x = event.time;
  }
  EXPECT_GT(x, 1.7);
  EXPECT_LT(x, 1.9);  // when the mouth is closed
  EXPECT_THAT(ends, testing::ElementsAre("cancelled 1", "cancelled 2", "done x"));
  EXPECT_EQ(stage.speaker->traces().back().waited, false);
}

TEST_F(Barge, AStopInSilenceDoesNothing) {
  Stage still, stopped;
  still.run(1);
  stopped.run(0.4);
  stopped.push(command("\"stop\""));
  stopped.push(command("\"stop\""));
  stopped.run(1);
  EXPECT_EQ(still.planes, stopped.planes);
  EXPECT_EQ(still.packets, stopped.packets);
  ASSERT_EQ(stopped.events.size(), 2u);
  EXPECT_EQ(stopped.events[0].what, What::stopped);
}

TEST_F(Barge, WhatIsBeingMadeIsThrownAwayByAStop) {
  Stage stage;
  stage.voice_seconds = 0.5;
  stage.run(0.5);
  stage.push("Hello.");
  stage.run(0.8);
  stage.push(command("\"stop\""));
  stage.run(2);
  stage.end();
  check_events(stage.events);
  for (const LineEvent& event : stage.events) EXPECT_NE(event.what, What::started);
  EXPECT_LT(level(stage.sound(), 1.5), 1e-3);
}

TEST_F(Barge, AStopJustBeforeTheEndOfTheInputEndsInGoodOrder) {
  Stage stage;
  stage.run(0.5);
  stage.push("Wow, how loud you shout!");
  stage.run(1.3);
  stage.push(command("\"stop\""));
  stage.end();
  check_events(stage.events);
  const fap::Sequence clip = stage.face();
  EXPECT_NEAR(opening(clip.frames.back()), opening(clip.frames.front()), 4);  // quantised
  EXPECT_LT(clip.duration(), 1.7);
}

TEST_F(Barge, MarksAreToldWhenAllBeforeThemIsSpoken) {
  Stage stage;
  stage.run(0.5);
  stage.push("Yes.");
  stage.push(command("\"mark\",\"id\":\"one\""));
  stage.push("Yes.");
  stage.push(command("\"mark\",\"id\":\"two\""));
  stage.push(command("\"drop\""));  // before anything was begun
  stage.push(command("\"mark\",\"id\":\"three\""));
  stage.push("Wow.");
  stage.push(command("\"mark\",\"id\":\"four\""));
  stage.end();
  check_events(stage.events);
  std::vector<std::string> seen;
  double done = 0, four = 0;
  for (const LineEvent& event : stage.events) {
    if (event.what == What::done) done = event.time;
    if (event.what == What::mark) seen.push_back(event.text);
    if (event.what == What::mark && event.text == "four") four = event.time;
    if (event.what == What::cancelled && event.line == 0) seen.push_back("no " + event.id);
  }
  EXPECT_NEAR(four, done, 0.041);
  EXPECT_THAT(seen, testing::ElementsAre("no one", "no two", "three", "four"));
}

TEST_F(Barge, TheEndOfTheStreamEndsEveryLine) {
  Stage stage;
  stage.run(0.5);
  for (int i = 0; i < 7; ++i) stage.push("Good morning.");
  stage.push(command("\"mark\""));
  stage.run(1.5);
  stage.speaker->end("the stream has ended");
  for (LineEvent& event : stage.speaker->take_events()) stage.events.push_back(std::move(event));
  check_events(stage.events);
  EXPECT_EQ(stage.events.back().why, "the stream has ended");
}

TEST_F(Barge, TextsOfEventsAreJson) {
  LineEvent event{.what = What::cancelled, .time = 1.25, .line = 3, .id = "ä\"", .text = "zwei\n"};
  event.why = "stopped";
  EXPECT_EQ(
      to_json(event),
      "{\"event\":\"cancelled\",\"time\":1.25,\"line\":3,\"id\":\"ä\\\"\",\"said\":\"zwei\\n\","
      "\"why\":\"stopped\"}");
  event.id = "\xff";  // no UTF-8
  EXPECT_THAT(to_json(event), testing::HasSubstr("\xEF\xBF\xBD"));
}

// 200 interruptions at random times, of lines and of pieces that join.
void soak(bool joins, unsigned seed) {
  std::mt19937 random(seed);
  const auto some = [&random](double low, double high) {
    return low + (high - low) * double(random()) / double(std::mt19937::max());
  };
  // What speech itself does: the same lines, at one after the other and after pauses.
  std::array<int, fap::kFapCount + 1> limits{};
  for (int round = 0; round < 6; ++round) {
    Stage speech;
    speech.joins = joins;
    double at = 0;
    for (int i = 0; i < 10; ++i) {
      speech.push(std::string(1, char('a' + (i + round) % 5)));
      if (i % 2 == round % 2) speech.run(at += some(0, 4));
    }
    speech.end();
    const auto steps = largest_steps(speech.face());
    for (std::size_t fap = 0; fap < steps.size(); ++fap) {
      limits[fap] = std::max(limits[fap], steps[fap]);
    }
  }

  Stage stage;
  stage.joins = joins;
  int interruptions = 0;
  double now = 0;
  std::vector<double> stops;  // after which nothing was said for 0.3 s
  while (interruptions < 200) {
    const int count = 1 + int(random() % 3);
    for (int i = 0; i < count; ++i) {
      const bool next = random() % 4 == 0;
      const std::string text = std::string(1, char('a' + random() % 12));
      stage.push(next ? command("\"say\",\"when\":\"next\",\"text\":\"" + text + "\"") : text);
      if (random() % 5 == 0) stage.push(command("\"mark\""));
    }
    stage.voice_seconds = random() % 3 == 0 ? some(0.1, 0.5) : some(0.005, 0.03);
    stage.run(now += some(0.02, random() % 3 == 0 ? 6 : 2));
    if (random() % 6 == 0) stage.push(command("\"drop\""));
    if (random() % 3 == 0) {
      stage.push(command("\"say\",\"when\":\"now\",\"text\":\"z\""));
    } else {
      stage.push(command("\"stop\""));
      if (random() % 4 == 0) stage.push(command("\"stop\""));
      if (random() % 2 == 0) {
        stops.push_back(now);
        stage.run(now += 0.3);
      }
    }
    ++interruptions;
    if (random() % 3 == 0) stage.run(now += some(0, 0.2));
  }
  stage.end();
  check_events(stage.events);

  const fap::Sequence clip = stage.face();
  const auto steps = largest_steps(clip);
  double worst = 0;
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    // Values are whole numbers. Brows may still come down from one question as they rise for the
    // next.
    const int most = fap >= 31 && fap <= 36 ? 2 * limits[fap] : limits[fap];
    EXPECT_LE(steps[fap], most + 1) << "FAP " << fap;
    if (limits[fap] > 0) worst = std::max(worst, double(steps[fap]) / limits[fap]);
  }
  const media::Pcm pcm = stage.sound();
  const int rest = opening(clip.frames[0]);
  double silent_after = 0, closed_after = 0, silence = 0, closing = 0, speaking = 0;
  for (const double at : stops) {
    double silent = 0, closed = 0;
    for (double time = at; time < at + 0.29; time += 0.001) {
      if (level(pcm, time) > kSilent) silent = time + 0.005 - at;
    }
    for (std::size_t i = 0; i < 7; ++i) {
      const std::size_t frame = std::size_t(std::ceil(at * 25)) + i;
      if (std::abs(opening(clip.frames[frame]) - rest) > 4) closed = double(frame + 1) / 25 - at;
    }
    silent_after = std::max(silent_after, silent);
    closed_after = std::max(closed_after, closed);
    if (closed == 0 || silent == 0) continue;  // nobody spoke
    ++speaking;
    silence += silent;
    closing += closed;
  }
  ASSERT_GT(speaking, 20);
  silence /= speaking;
  closing /= speaking;
  // A frame until it is followed, 0.1 s for most mouths; the widest take a frame more.
  EXPECT_LE(closed_after, 0.04 + 0.12);
  EXPECT_LE(closing, 0.1 + 0.1 * 0.04);  // one in ten is that wide
  EXPECT_LE(silent_after, 0.11);
  std::printf(
      "%.0f s: largest step %.2f of that of speech; %.0f stops: mouth closed after %.0f ms (worst "
      "%.0f), "
      "silent after %.0f ms (worst %.0f)\n",
      clip.duration(), worst, speaking, 1e3 * closing, 1e3 * closed_after, 1e3 * silence,
      1e3 * silent_after);
  int queued = 0, done = 0, cancelled = 0;
  for (const LineEvent& event : stage.events) {
    if (event.line == 0) continue;
    queued += event.what == What::queued;
    done += event.what == What::done;
    cancelled += event.what == What::cancelled;
  }
  EXPECT_EQ(queued, done + cancelled);
  EXPECT_GT(done, 20);
  EXPECT_GT(cancelled, 200);
}

unsigned seed() {
  const char* given = std::getenv("ANIMEME_BARGE_SEED");  // others, by hand
  return given == nullptr ? 1 : unsigned(std::atoi(given));
}

TEST_F(Barge, TwoHundredInterruptionsOfLines) { soak(false, seed()); }
TEST_F(Barge, TwoHundredInterruptionsOfPieces) { soak(true, seed()); }

}  // namespace barge_test
}  // namespace animeme::speech

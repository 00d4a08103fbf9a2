// A voice that comes as sound alone and is halted: nothing of it is lost, and face and sound go on
// together.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "tests/speech/talking/voice_stage.h"

namespace animeme::speech {
namespace voice_pause_test {

using namespace voice_stage;
using testing::ElementsAre;
using testing::HasSubstr;
using What = LineEvent::What;

constexpr int kRate = 16000;

double level_at(const media::Pcm& pcm, double time, double seconds = 0.02) {
  const auto from = std::size_t(std::max(time, 0.0) * pcm.sample_rate);
  const auto to = std::min(from + std::size_t(seconds * pcm.sample_rate), pcm.samples.size());
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += double(pcm.samples[i]) * double(pcm.samples[i]);
  return to > from ? std::sqrt(sum / double(to - from)) : 0;
}

// 0.1 s of each tone, which tells where one is in the voice.
constexpr double kTone = 0.1, kLowest = 300, kNext = 75;
constexpr int kTones = 40;

std::vector<float> scale() {
  std::vector<float> samples;
  double phase = 0;
  for (int i = 0; i < kTones * kRate / 10; ++i) {
    phase += 2 * M_PI * (kLowest + kNext * (i * 10 / kRate)) / kRate;
    samples.push_back(float(0.3 * std::sin(phase)));
  }
  return samples;
}

// The tone in 20 ms of the sound; -1: silence.
int tone_at(const media::Pcm& pcm, double time) {
  if (level_at(pcm, time) < 0.1) return -1;
  const auto from = std::size_t(time * pcm.sample_rate);
  int loudest = -1;
  double most = 0;
  for (int tone = 0; tone < kTones; ++tone) {
    const double turn = 2 * M_PI * (kLowest + kNext * tone) / pcm.sample_rate;
    double real = 0, imaginary = 0;
    for (std::size_t i = 0; i < std::size_t(pcm.sample_rate / 50); ++i) {
      if (from + i >= pcm.samples.size()) break;
      real += double(pcm.samples[from + i]) * std::cos(turn * double(i));
      imaginary += double(pcm.samples[from + i]) * std::sin(turn * double(i));
    }
    const double power = real * real + imaginary * imaginary;
    if (power > most) {
      most = power;
      loudest = tone;
    }
  }
  return loudest;
}

// All of it is heard, in its order, and what comes twice are the few milliseconds that faded out.
void expect_whole(const media::Pcm& pcm, int pauses) {
  std::vector<double> seconds(kTones, 0.0);
  int last = 0;
  for (double time = 0; time + 0.02 < pcm.duration(); time += 0.01) {
    const int tone = tone_at(pcm, time);
    if (tone < 0) continue;
    ASSERT_GE(tone, last) << "at " << time;
    ASSERT_LE(tone, last + 1) << "something is missing at " << time;
    last = tone;
    seconds[std::size_t(tone)] += 0.01;
  }
  EXPECT_EQ(last, kTones - 1);
  double all = 0;
  for (int tone = 0; tone < kTones; ++tone) {
    EXPECT_GT(seconds[std::size_t(tone)], kTone - 0.035) << "tone " << tone;
    all += seconds[std::size_t(tone)];
  }
  EXPECT_NEAR(all, kTones * kTone, 0.03 + 0.03 * pauses);
}

TEST(VoicePause, NothingIsLost) {
  const std::pair<double, double> cases[] = {
      {0.35, 0.3}, {1.2, 0.3}, {1.513, 0.3}, {3.85, 0.3}, {1.2, 1.0}};
  for (const auto& [at, delay] : cases) {
    LiveVoiceOptions options;
    options.delay = delay;
    Stage stage(kRate, options);
    stage.feed->there = scale();
    stage.feed->closed = true;
    stage.push(R"({"do": "mark", "id": "end"})");
    stage.run(at);
    stage.push(R"({"do": "pause"})");
    stage.push(R"({"do": "pause"})");
    stage.run(at + 2);
    stage.push(R"({"do": "resume"})");
    stage.run(1e9);
    const auto pcm = media::decode_audio(stage.packets);
    ASSERT_TRUE(pcm);
    expect_whole(*pcm, 1);
    for (double time = at + 0.12; time < at + 2; time += 0.01) {
      ASSERT_LT(level_at(*pcm, time), 0.003) << at << ", " << time;
    }
    double first = -1, last = 0;
    for (double time = 0; time < pcm->duration(); time += 0.01) {
      if (level_at(*pcm, time, 0.01) < 0.1) continue;
      last = time;
      if (first < 0 && time > at + 2) first = time;
    }
    EXPECT_NEAR(first, at + 2 + delay - 0.06, 0.06) << "after the delay of the voice";
    EXPECT_THAT(stage.told(), ElementsAre(HasSubstr("paused"), HasSubstr("resumed"),
                                          HasSubstr(R"("mark":"end")")));
    EXPECT_NEAR(stage.time_of(What::mark), last, 0.1) << at;
  }
}

TEST(VoicePause, AnyNumberOfThem) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Stage stage(kRate, {});
    stage.feed->there = scale();
    stage.feed->closed = true;
    std::minstd_rand random(seed);
    double now = 0.1;
    int pauses = 0;
    bool held = false;
    for (int i = 0; i < 40; ++i) {
      stage.run(now);
      const bool pause = random() % 2 == 0;
      pauses += pause && !held;
      held = pause;
      stage.push(pause ? R"({"do": "pause"})" : R"({"do": "resume"})");
      now += 0.02 * double(random() % 20);
    }
    stage.push(R"({"do": "resume"})");
    stage.run(1e9);
    const auto pcm = media::decode_audio(stage.packets);
    ASSERT_TRUE(pcm);
    EXPECT_GT(pauses, 5);
    expect_whole(*pcm, pauses);
  }
}

// The mouth rests meanwhile, and then moves with the words as it would have.
TEST(VoicePause, TheFaceRestsAndGoesOnWithTheSound) {
  const auto words = spoken_words();
  if (!words) GTEST_SKIP() << "neither a voice nor ears";
  const auto run = [&](double at, double seconds) {
    auto stage = std::make_unique<Stage>(words->sample_rate, LiveVoiceOptions());
    stage->feed->there = words->samples;
    stage->feed->closed = true;
    stage->push(R"({"do": "mark", "id": "end"})");
    if (seconds > 0) {
      stage->run(at);
      stage->push(R"({"do": "pause"})");
      stage->run(at + seconds);
      stage->push(R"({"do": "resume"})");
    }
    stage->run(1e9);
    return stage;
  };
  const auto plain = run(0, 0);
  const auto moves = plain->face();
  const auto before = media::decode_audio(plain->packets);
  ASSERT_TRUE(before);
  double usual = 0;  // largest step of the mouth
  for (std::size_t i = 1; i < moves.frames.size(); ++i) {
    usual = std::max(usual, std::abs(opening(moves.frames[i]) - opening(moves.frames[i - 1])));
  }
  for (const double at : {1.0, 1.3, 1.71}) {
    const auto stage = run(at, 2);
    const auto after = media::decode_audio(stage->packets);
    ASSERT_TRUE(after);
    const fap::Sequence face = stage->face();
    for (std::size_t i = 1; i < face.frames.size(); ++i) {
      const double time = double(i) / 25;
      const double open = opening(face.frames[i]);
      if (time > at + 0.2 && time < at + 2) {
        EXPECT_LT(std::abs(open), 60) << at << ", " << time;
      }
      EXPECT_LE(std::abs(open - opening(face.frames[i - 1])), 1.5 * usual) << at << ", " << time;
    }
    const double shift = stage->time_of(What::mark) - plain->time_of(What::mark);
    EXPECT_NEAR(shift, 2.2, 0.1);
    // By which the sound and the face are later, each for itself.
    const auto lag = [&](double step, auto one, auto other, double reach) {
      double best = -1, found = 0;
      for (double later = shift - reach; later <= shift + reach; later += step) {
        double common = 0, first = 0, second = 0;
        for (double time = at + 0.4; time < before->duration() - 0.5; time += step) {
          const double a = one(time), b = other(time + later);
          common += a * b, first += a * a, second += b * b;
        }
        const double same = common / std::sqrt(first * second + 1e-9);
        if (same > best) {
          best = same;
          found = later;
        }
      }
      EXPECT_GT(best, 0.85) << at;
      return found;
    };
    const auto open_at = [](const fap::Sequence& clip) {
      return [&clip](double time) {
        const auto i = std::size_t(std::lround(time * 25));
        return i < clip.frames.size() ? opening(clip.frames[i]) : 0.0;
      };
    };
    const double sound = lag(
        0.005, [&](double time) { return level_at(*before, time); },
        [&](double time) { return level_at(*after, time); }, 0.15);
    const double mouth = lag(0.04, open_at(moves), open_at(face), 0.16);
    EXPECT_NEAR(mouth, sound, 0.045) << at;
  }
}

TEST(VoicePause, WhatComesMeanwhileWaits) {
  Stage stage(kRate, {});
  stage.run(0.5);
  stage.push(R"({"do": "pause"})");  // nothing is heard yet
  stage.run(0.6);
  stage.feed->there = scale();
  stage.feed->closed = true;
  stage.run(4);
  EXPECT_EQ(stage.feed->waiting(), scale().size()) << "who sends it waits";
  stage.push(R"({"do": "resume"})");
  stage.run(1e9);
  const auto pcm = media::decode_audio(stage.packets);
  ASSERT_TRUE(pcm);
  expect_whole(*pcm, 0);
  EXPECT_EQ(tone_at(*pcm, 3.9), -1);
}

TEST(VoicePause, AStopEndsIt) {
  Stage stage(kRate, {});
  stage.feed->there = scale();
  stage.push(R"({"do": "mark", "id": "never"})");
  stage.run(1.5);
  stage.push(R"({"do": "pause"})");
  stage.run(2);
  stage.push(R"({"do": "stop"})");
  stage.run(3);
  stage.feed->there = scale();
  stage.feed->closed = true;
  stage.run(1e9);
  const auto pcm = media::decode_audio(stage.packets);
  ASSERT_TRUE(pcm);
  for (double time = 1.65; time < 3; time += 0.01) ASSERT_LT(level_at(*pcm, time), 0.003) << time;
  EXPECT_EQ(tone_at(*pcm, 3.29), 0) << "what came later, from its begin";
  EXPECT_THAT(stage.told(),
              ElementsAre(HasSubstr("paused"), HasSubstr("stopped"), HasSubstr("never")));
}

// A drop leaves what had its place, as without a pause.
TEST(VoicePause, ADropLeavesWhatWasAboutToBeHeard) {
  Stage stage(kRate, {});
  stage.feed->there = scale();
  stage.push(R"({"do": "mark", "id": "never"})");
  stage.run(1.5);
  stage.push(R"({"do": "pause"})");
  stage.run(1.6);
  stage.push(R"({"do": "drop"})");
  stage.run(2);
  stage.push(R"({"do": "resume"})");
  stage.run(4);
  const auto pcm = media::decode_audio(stage.packets);
  ASSERT_TRUE(pcm);
  double heard = 0;
  for (double time = 2; time < 4; time += 0.01)
    heard += level_at(*pcm, time, 0.01) > 0.1 ? 0.01 : 0;
  EXPECT_NEAR(heard, 0.26, 0.08);
  EXPECT_THAT(stage.told(), ElementsAre(HasSubstr("paused"), HasSubstr("dropped"),
                                        HasSubstr("never"), HasSubstr("resumed")));
}

TEST(VoicePause, TheEndOfTheCommandsEndsIt) {
  Stage stage(kRate, {});
  stage.feed->there = scale();
  stage.run(1.5);
  stage.push(R"({"do": "pause"})");
  stage.run(2.5);
  stage.push(R"({"do": "end"})");
  stage.run(1e9);
  const auto pcm = media::decode_audio(stage.packets);
  ASSERT_TRUE(pcm);
  expect_whole(*pcm, 1);
}

// Marks whose sound was taken back are not reached by an end.
TEST(VoicePause, AnEndCancelsWhatWaits) {
  for (const double at : {1.5, 3.85}) {  // the mark has no place yet, and has one
    Stage stage(kRate, {});
    stage.feed->there = scale();
    stage.feed->closed = true;
    stage.push(R"({"do": "mark", "id": "never"})");
    stage.run(at);
    stage.push(R"({"do": "pause"})");
    stage.run(at + 1);
    stage.voice->end("it is late");
    for (LineEvent& event : stage.voice->take_events()) stage.events.push_back(std::move(event));
    EXPECT_EQ(stage.time_of(What::mark), -1) << at;
    EXPECT_NEAR(stage.time_of(What::cancelled), at + 1, 0.1) << at;
  }
}

// The face alone.
TEST(VoicePause, WithoutSound) {
  LiveVoiceOptions options;
  LineQueue queue{4000, true, false};
  options.commands = &queue;
  options.audio.reset();
  auto owned = std::make_unique<Feed>();
  Feed* const feed = owned.get();
  auto voice = LiveVoice::open(character(), std::move(owned), kRate, options);
  ASSERT_TRUE(voice);
  feed->there = scale();
  const auto run = [&](double until) {
    for (auto due = (*voice)->next_due(); due && *due < until; due = (*voice)->next_due()) {
      ASSERT_TRUE((*voice)->take(*due));
    }
  };
  run(1.5);
  const std::size_t left = feed->waiting();
  EXPECT_NEAR(double(left) / kRate, kTones * kTone - 1.8, 0.05);
  ASSERT_TRUE(queue.push(R"({"do": "pause"})", 1.5));
  run(3);
  EXPECT_EQ(feed->waiting(), left);
  ASSERT_TRUE(queue.push(R"({"do": "resume"})", 3));
  run(3.2);
  EXPECT_EQ(feed->waiting(), left) << "first what a pause has taken back";
  run(3.8);
  EXPECT_NEAR(double(feed->waiting()) / kRate, double(left) / kRate - 0.56, 0.1);
}

}  // namespace voice_pause_test
}  // namespace animeme::speech

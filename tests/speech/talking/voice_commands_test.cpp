// Commands for a voice that comes as sound alone: what was sent before a stop is not heard, the
// mouth closes, marks are reached, and the face lives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "dam/performance/performance.h"
#include "tests/speech/talking/voice_stage.h"

namespace animeme::speech {
namespace voice_commands_test {

using namespace voice_stage;
using testing::ElementsAre;
using testing::HasSubstr;

// Two seconds of old sound wait when the command comes.
TEST(VoiceCommands, NothingThatWasSentBeforeAStopIsHeard) {
  const auto words = spoken_words();
  if (!words) GTEST_SKIP() << "neither a voice nor ears";
  Stage stage(words->sample_rate, {});
  stage.feed->there = words->samples;
  stage.feed->there.insert(stage.feed->there.end(), words->samples.begin(), words->samples.end());
  stage.push(R"({"do": "mark", "id": "never"})");
  stage.run(1.5);
  EXPECT_GT(stage.feed->waiting(), std::size_t(2 * words->sample_rate));
  stage.push(R"({"do": "stop"})");
  stage.run(2.5);
  // What comes later is heard: a tone.
  for (int i = 0; i < words->sample_rate; ++i) {
    stage.feed->there.push_back(float(0.4 * std::sin(i * 2 * M_PI * 500 / words->sample_rate)));
  }
  stage.push(R"({"do": "mark", "id": "tone"})");
  stage.feed->closed = true;
  stage.run(1e9);
  const auto sound = media::decode_audio(stage.packets);
  ASSERT_TRUE(sound);
  const auto loudest = [&](double from, double to) {
    float peak = 0;
    for (auto i = std::size_t(from * sound->sample_rate); i < std::size_t(to * sound->sample_rate);
         ++i) {
      peak = std::max(peak, std::abs(sound->samples[i]));
    }
    return peak;
  };
  const double stopped = stage.time_of(LineEvent::What::stopped);
  EXPECT_NEAR(stopped, 1.5, 0.05);
  EXPECT_GT(loudest(1, stopped), 0.05F);
  EXPECT_LT(loudest(stopped + 0.12, 2.5), 0.003F);
  EXPECT_GT(loudest(2.6, 3.4), 0.3F);
  const fap::Sequence face = stage.face();
  double widest = 0;
  for (std::size_t i = 0; i < face.frames.size(); ++i) {
    const double time = double(i) / 25;
    if (time < stopped) widest = std::max(widest, opening(face.frames[i]));
    if (time > stopped + 0.17 && time < 2.5) {
      EXPECT_LT(std::abs(opening(face.frames[i])), 60) << time;
    }
  }
  EXPECT_GT(widest, 150);
  EXPECT_THAT(stage.told(),
              ElementsAre(HasSubstr("stopped"), HasSubstr("never"), HasSubstr("tone")));
  EXPECT_GT(stage.time_of(LineEvent::What::mark), 3.4);
}

// Brows and head are those of a performance, which repeats; the lips are those of the voice.
TEST(VoiceCommands, OverAPerformance) {
  const auto words = spoken_words();
  if (!words) GTEST_SKIP() << "neither a voice nor ears";
  fap::Sequence clip{{25, 1}, {}, ""};
  for (int i = 0; i < 50; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(49, std::int32_t(std::lround(8000 * std::sin(i * 0.12))));
    frame.set(31, 100 + i);
    clip.frames.push_back(frame);
  }
  LiveVoiceOptions options;
  options.idle_motion = true;
  const auto run = [&] {
    Stage stage(words->sample_rate, options);
    stage.feed->there = words->samples;
    stage.feed->closed = true;
    stage.run(1e9);
    return stage.face();
  };
  const fap::Sequence alone = run();
  options.over = std::make_shared<const dam::Performance>(*dam::Performance::make(clip));
  const fap::Sequence kept = run();
  ASSERT_EQ(kept.frames.size(), alone.frames.size());
  ASSERT_GT(kept.frames.size(), 60u);
  for (std::size_t i = 0; i < kept.frames.size(); ++i) {
    const fap::Frame &frame = kept.frames[i], &other = alone.frames[i];
    if (i < 50) {
      EXPECT_NEAR(frame.value[49], 8000 * std::sin(double(i) * 0.12), 170) << i;
      EXPECT_NEAR(frame.value[31], 100 + int(i), 2) << i;
    } else {  // again, without a jump
      EXPECT_LT(std::abs(frame.value[49] - kept.frames[i - 1].value[49]), 1400) << i;
      EXPECT_LT(std::abs(frame.value[31] - kept.frames[i - 1].value[31]), 14) << i;
      EXPECT_GT(frame.value[31], 50) << i;
    }
    EXPECT_EQ(opening(frame), opening(other)) << i;
    EXPECT_EQ(frame.value[19], other.value[19]) << i;  // lids, which it lacks
  }
}

TEST(VoiceCommands, MoodsGazeAndBlinksBesidesTheVoice) {
  const auto words = spoken_words();
  if (!words) GTEST_SKIP() << "neither a voice nor ears";
  LiveVoiceOptions options;
  options.idle_motion = true;
  Stage stage(words->sample_rate, options);
  stage.feed->there = words->samples;
  stage.feed->closed = true;
  stage.run(1);
  stage.push(R"({"do": "mood", "mood": "joy"})");
  stage.push(R"({"do": "look", "target": "20,0"})");
  stage.push("A text that nobody can say.");
  const auto job = stage.queue.try_job();
  ASSERT_TRUE(job);
  stage.queue.made(job->line, make_error(Code::unsupported, "no voice"), 1);
  stage.run(1e9);
  const fap::Sequence face = stage.face();
  ASSERT_GT(face.frames.size(), 60u);
  // Corners of the lips (12) and the eyes (23).
  EXPECT_GT(face.frames.back().value[12], face.frames[20].value[12] + 20);
  int turned = 0;
  for (std::size_t i = 40; i < 60; ++i)
    turned = std::max(turned, std::abs(face.frames[i].value[23]));
  EXPECT_GT(turned, 5000);
  EXPECT_THAT(stage.told(), ElementsAre(HasSubstr("queued"), HasSubstr("cancelled")));
}

// What stands in a pipe, and what a program writes after the command.
TEST(VoiceCommands, APipeIsEmptied) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  SoundPipe pipe(ends[0], BareSound{16000, 1});
  const auto write = [&](std::int16_t value, std::size_t count) {
    const std::vector<std::int16_t> samples(count, value);
    ASSERT_EQ(::write(ends[1], samples.data(), 2 * count), ssize_t(2 * count));
  };
  write(1000, 30000);
  for (int i = 0; i < 1000 && pipe.waiting() < 8000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GE(pipe.waiting(), 8000u);
  pipe.discard();
  write(2000, 500);
  ::close(ends[1]);
  std::vector<float> all;
  for (int i = 0; i < 1000 && !pipe.over(); ++i) {
    for (const float sample : pipe.take(100000)) all.push_back(sample);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(all, std::vector<float>(500, 2000.0F / 32768));
  ::close(ends[0]);
}

}  // namespace voice_commands_test
}  // namespace animeme::speech

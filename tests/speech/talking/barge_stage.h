// A head that can be interrupted, on a clock of the test's own, with a voice that takes its time.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"
#include "tools/speech/talking/line_queue.h"
#include "tools/speech/talking/live_speaker.h"

namespace animeme::speech::barge_stage {

using media::LiveTrack;
using media::LiveUnit;
using What = LineEvent::What;

inline constexpr double kSilent =
    0.003;  // of full scale: what a codec leaves behind speech fades below it
inline constexpr int kUpper = 4, kLower = 5;  // FAPs of the inner lips

inline const std::vector<voice::Speech>& voices() {
  static const std::vector<voice::Speech> all = [] {
    std::vector<voice::Speech> made;
    for (const char* text : {"Good morning, my old friend, how are you today?", "Yes.",
                             "I wonder whether all of this will fit into one sentence.",
                             "Bob may buy a map of Mobile.", "Wow, how loud you shout!"}) {
      voice::VoiceOptions options;
      options.lead_silence = 0.1;
      options.tail_silence = 0.3;
      if (auto speech = voice::speak_text(text, options)) made.push_back(std::move(*speech));
    }
    return made;
  }();
  return all;
}

inline const dam::Model& character() {
  static const dam::Model model = std::move(*dam::builtin_model());
  return model;
}

// A queue, a voice that takes `voice_seconds` a line, a head, and what came out of it.
struct Stage {
  LineQueue queue{4000, true, false};
  media::JumpingClock clock;
  std::unique_ptr<LiveSpeaker> speaker;
  std::vector<LiveUnit> planes, packets;
  std::vector<LineEvent> events;
  double voice_seconds = 0.015;
  double ready = -1;  // when the line that is being made will be there
  std::optional<LineQueue::Job> job;
  bool joins = false;

  explicit Stage(bool life = false, int quant = 0, bool tongue = false, std::uint64_t seed = 1) {
    SpeakerOptions options;
    options.face.idle_motion = life;
    options.face.idle.seed = seed;
    options.face.synthesis.tongue = tongue;
    options.events = true;
    options.fap_quant = quant;  // 0: exactly
    options.audio = media::AudioSettings{media::AudioCodec::opus};
    auto opened = LiveSpeaker::open(character(), queue, clock, options);
    EXPECT_TRUE(opened);
    speaker = std::move(*opened);
  }
  void push(const std::string& line) { EXPECT_TRUE(queue.push(line, clock.now())) << line; }
  void let_the_voice_work() {
    if (job && clock.now() >= ready) {
      SpokenLine line;
      line.speech = voices()[std::size_t(job->payload[0]) % voices().size()];
      line.text = job->payload;
      line.joins = joins;
      queue.made(job->line, std::move(line), clock.now());
      job.reset();
    }
    if (job) return;
    job = queue.try_job();
    ready = clock.now() + voice_seconds;
  }
  // To `until` or to the end.
  void run(double until) {
    for (;;) {
      let_the_voice_work();
      const auto due = speaker->next_due();
      if (!due || *due >= until) break;
      clock.sleep_until(*due);
      auto made = speaker->take(std::max(clock.now(), *due));
      ASSERT_TRUE(made) << made.error().describe();
      for (LiveUnit& unit : *made) {
        speaker->sent(unit, clock.now());
        (unit.track == LiveTrack::face ? planes : packets).push_back(std::move(unit));
      }
      for (LineEvent& event : speaker->take_events()) events.push_back(std::move(event));
    }
    if (std::isfinite(until)) clock.sleep_until(until);
  }
  void end() {
    queue.close();
    run(std::numeric_limits<double>::infinity());
    EXPECT_FALSE(speaker->next_due());
    EXPECT_TRUE(queue.ended());
    speaker->end("over");
    for (LineEvent& event : speaker->take_events()) events.push_back(std::move(event));
  }
  fap::Sequence face() const {
    fba::AccessUnits units;
    for (const LiveUnit& plane : planes) units.units.push_back({plane.bytes, plane.intra, 0, 1});
    const auto decoded = fba::decode(fba::join_access_units(units));
    EXPECT_TRUE(decoded);
    return decoded ? fba::face_sequence(*decoded) : fap::Sequence{};
  }
  media::Pcm sound() const {
    media::EncodedAudio audio;
    audio.format = *speaker->info().audio;
    for (const LiveUnit& packet : packets) {
      audio.packets.push_back({packet.bytes, packet.time, packet.duration});
    }
    const auto pcm = media::decode_audio(audio);
    EXPECT_TRUE(pcm);
    return pcm ? *pcm : media::Pcm{};
  }
};

inline std::string command(const std::string& rest) { return "{\"do\":" + rest + "}"; }

// Of each FAP the largest change from a frame to the next.
inline std::array<int, fap::kFapCount + 1> largest_steps(const fap::Sequence& clip) {
  std::array<int, fap::kFapCount + 1> steps{};
  for (std::size_t i = 1; i < clip.frames.size(); ++i) {
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const int step = std::abs(clip.frames[i].value[fap] - clip.frames[i - 1].value[fap]);
      steps[fap] = std::max(steps[fap], step);
    }
  }
  return steps;
}

inline int opening(const fap::Frame& frame) { return -(frame.value[kUpper] + frame.value[kLower]); }

// Level of the sound about an instant, 5 ms to both sides.
inline double level(const media::Pcm& pcm, double time) {
  double sum = 0;
  const auto first = std::max<std::int64_t>(0, std::int64_t((time - 0.005) * pcm.sample_rate));
  const auto last = std::min<std::int64_t>(std::int64_t(pcm.samples.size()),
                                           std::int64_t((time + 0.005) * pcm.sample_rate));
  for (auto i = first; i < last; ++i) sum += std::pow(double(pcm.samples[std::size_t(i)]), 2);
  return last > first ? std::sqrt(sum / double(last - first)) : 0;
}

// Every line ends once, in order, and nothing is told of it before it begins or after it ended.
inline void check_events(const std::vector<LineEvent>& events) {
  struct Life {
    int queued = 0, started = 0, ended = 0;
  };
  std::map<std::uint64_t, Life> lines;
  double last = 0;
  for (const LineEvent& event : events) {
    EXPECT_GE(event.time, last) << to_json(event);
    last = event.time;
    if (event.line == 0) continue;
    Life& life = lines[event.line];
    switch (event.what) {
      case What::queued:
        EXPECT_EQ(life.queued++ + life.started + life.ended, 0) << to_json(event);
        break;
      case What::started:
        EXPECT_EQ(life.started++ + life.ended, 0) << to_json(event);
        EXPECT_EQ(life.queued, 1) << to_json(event);
        break;
      case What::done:
        EXPECT_EQ(life.started, 1) << to_json(event);
        EXPECT_EQ(life.ended++, 0) << to_json(event);
        break;
      case What::cancelled:
        EXPECT_EQ(life.queued, 1) << to_json(event);
        EXPECT_EQ(life.ended++, 0) << to_json(event);
        break;
      default:
        EXPECT_EQ(life.started, 1) << to_json(event);
        EXPECT_EQ(life.ended, 0) << to_json(event);
    }
  }
  for (const auto& [number, life] : lines) EXPECT_EQ(life.ended, 1) << number;
}

class Barge : public testing::Test {
 protected:
  void SetUp() override {
    if (voices().empty()) GTEST_SKIP() << "no voice";
  }
};

}  // namespace animeme::speech::barge_stage

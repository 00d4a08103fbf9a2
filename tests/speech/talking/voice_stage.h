// The stage of tests of a voice that comes as sound alone: on a clock of its own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "dam/model/builtin.h"
#include "tools/formats/media/audio.h"
#include "tools/speech/talking/line_queue.h"
#include "tools/speech/talking/live_voice.h"
#include "tools/speech/voice/listen_stream.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech::voice_stage {

using media::LiveTrack;

inline const dam::Model& character() {
  static const dam::Model model = std::move(*dam::builtin_model());
  return model;
}

// Samples that a program has sent by now; those that were not taken wait.
class Feed : public SoundFeed {
 public:
  std::vector<float> take(std::size_t most) override {
    const auto count = std::ptrdiff_t(std::min(most, there.size()));
    std::vector<float> some(there.begin(), there.begin() + count);
    there.erase(there.begin(), there.begin() + count);
    return some;
  }
  bool over() override { return closed && there.empty(); }
  std::size_t waiting() override { return there.size(); }
  void discard() override { there.clear(); }

  std::vector<float> there;
  bool closed = false;
};

struct Stage {
  LineQueue queue{4000, true, false};
  Feed* feed = nullptr;
  std::unique_ptr<LiveVoice> voice;
  std::vector<LineEvent> events;
  fba::AccessUnits planes;
  media::EncodedAudio packets;
  double now = 0;

  Stage(int rate, const LiveVoiceOptions& wanted) {
    auto owned = std::make_unique<Feed>();
    feed = owned.get();
    LiveVoiceOptions options = wanted;
    options.commands = &queue;
    options.audio = media::AudioSettings{media::AudioCodec::opus, 96000};
    auto opened = LiveVoice::open(character(), std::move(owned), rate, options);
    EXPECT_TRUE(opened) << opened.error().describe();
    voice = std::move(*opened);
    packets.format = *voice->info().audio;
  }
  void run(double until) {
    for (;;) {
      const auto due = voice->next_due();
      if (!due || *due >= until) break;
      now = *due;
      auto made = voice->take(now);
      ASSERT_TRUE(made) << made.error().describe();
      for (media::LiveUnit& unit : *made) {
        voice->sent(unit, now);
        if (unit.track == LiveTrack::face) {
          planes.units.push_back({std::move(unit.bytes), unit.intra, 0, 1});
        } else {
          packets.packets.push_back({std::move(unit.bytes), unit.time, unit.duration});
        }
      }
      for (LineEvent& event : voice->take_events()) events.push_back(std::move(event));
    }
  }
  void push(const std::string& line) { EXPECT_TRUE(queue.push(line, now)); }
  std::vector<std::string> told() const {
    std::vector<std::string> all;
    for (const LineEvent& event : events) all.push_back(to_json(event));
    return all;
  }
  double time_of(LineEvent::What what) const {
    for (const LineEvent& event : events) {
      if (event.what == what) return event.time;
    }
    return -1;
  }
  fap::Sequence face() const {
    const auto decoded = fba::decode(fba::join_access_units(planes));
    EXPECT_TRUE(decoded);
    return decoded ? fba::face_sequence(*decoded) : fap::Sequence{};
  }
};

inline double opening(const fap::Frame& frame) { return -(frame.value[4] + frame.value[5]); }

inline std::optional<media::Pcm> spoken_words() {
  if (!voice::SoundListener::open(16000, {})) return std::nullopt;
  const auto speech =
      voice::speak_text("How many boats are there, and who paid for all of them?", {});
  if (!speech) return std::nullopt;
  return speech->audio;
}

}  // namespace animeme::speech::voice_stage

#include "tools/formats/media/live/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/live/loopback.h"
#include "tools/formats/media/live/presentation.h"

namespace animeme::media {
namespace recorder_test {

EncodedAudio make_sound(int packets, int rate = 48000, int frame = 960, int priming = 312) {
  EncodedAudio sound;
  sound.format.codec = AudioCodec::opus;
  sound.format.sample_rate = rate;
  sound.format.frame_samples = frame;
  sound.format.priming = priming;
  for (int i = 0; i < packets; ++i) {
    sound.packets.push_back({{std::uint8_t(i), 7}, i * std::int64_t(frame) - priming, frame});
  }
  return sound;
}

// All events of a clip that is sent; the first `skip` of them (behind the info) do not arrive.
std::vector<LiveEvent> events_of(ClipInput input, const LoopbackOptions& options = {},
                                 std::size_t skip = 0) {
  Loopback joined = make_loopback(options);
  EXPECT_TRUE(joined.sink->start(input.info()));
  const auto units = input.take(1e9);
  for (const LiveUnit& unit : *units) EXPECT_TRUE(joined.sink->send(unit));
  EXPECT_TRUE(joined.sink->finish());
  std::vector<LiveEvent> events;
  for (std::size_t i = 0;; ++i) {
    auto event = joined.source->next(0);
    if (std::holds_alternative<LiveIdle>(*event)) return events;
    if (i == 0 || i > skip) events.push_back(std::move(*event));
  }
}

// What a file would hold.
struct Kept {
  fba::AccessUnits face;
  EncodedAudio sound;
};

void take_into(Kept& kept, Recorder& recorder) {
  for (LiveUnit& unit : recorder.take_units()) {
    if (unit.track == LiveTrack::face) {
      kept.face.units.push_back({std::move(unit.bytes), unit.intra, unit.time, unit.duration});
    } else {
      kept.sound.packets.push_back({std::move(unit.bytes), unit.time, unit.duration});
    }
  }
  if (!recorder.info()) return;
  kept.face.config = recorder.info()->face_config;
  kept.face.timescale = recorder.info()->timescale;
  if (!kept.sound.packets.empty()) kept.sound.format = *recorder.info()->audio;
}

// `every`: what there is is taken behind each event, as a file does that grows; else at the end.
Kept record(const std::vector<LiveEvent>& events, Recorder&& recorder = Recorder(),
            bool every = true) {
  Kept kept;
  for (const LiveEvent& event : events) {
    (void)recorder.accept(event);
    if (every) take_into(kept, recorder);
  }
  take_into(kept, recorder);
  return kept;
}

TEST(Recorder, WithoutLossIsWhatWasSentByteForByte) {
  const fba::AccessUnits face = test::make_face(100, 25000, 1000, 25);
  const EncodedAudio sound = make_sound(201);
  Recorder recorder;
  const Kept recording = record(events_of(ClipInput(face, sound)), std::move(recorder));
  EXPECT_TRUE(recorder.ended());
  EXPECT_EQ(recording.face, face);
  EXPECT_EQ(recording.sound.format, sound.format);
  EXPECT_EQ(recording.sound.packets, sound.packets);
  EXPECT_NEAR(recorder.face_seconds(), 4, 1e-9);
  EXPECT_NEAR(recorder.sound_seconds(), 4.02, 1e-9);
}

TEST(Recorder, AGapHoldsThePlaneBeforeItUntilTheNextIntraPlane) {
  const fba::AccessUnits face = test::make_face(100, 25000, 1000, 25);
  auto events = events_of(ClipInput(face, {}));
  // Info, then plane i is event i + 1. Plane 30 is lost.
  events[31] = LiveGap{LiveTrack::face, 1};
  Recorder recorder;
  Kept all;
  std::vector<std::int64_t> shown;
  std::vector<std::int64_t> after_gap;
  for (const LiveEvent& event : events) {
    const auto unit = recorder.accept(event);
    take_into(all, recorder);
    if (!unit) continue;
    shown.push_back(unit->time / 1000);
    if (recorder.after_gap()) after_gap.push_back(unit->time / 1000);
  }
  EXPECT_EQ(shown.size(), 80u);
  EXPECT_THAT(after_gap, testing::ElementsAre(50));
  const fba::AccessUnits& kept = all.face;
  ASSERT_EQ(kept.units.size(), 80u);
  EXPECT_EQ(kept.units[29].time, 29 * 1000);
  EXPECT_EQ(kept.units[29].duration, 21 * 1000);
  EXPECT_EQ(kept.units[30].bytes, face.units[50].bytes);
  EXPECT_TRUE(kept.units[30].intra);
  EXPECT_EQ(recorder.recovery().dropped, 19);
}

TEST(Recorder, LossesOfSoundAreGapsInItsTimes) {
  const EncodedAudio sound = make_sound(500);
  const auto events = events_of(ClipInput({}, sound), {.loss = 0.1, .seed = 3});
  const Kept recording = record(events);
  ASSERT_LT(recording.sound.packets.size(), 480u);
  ASSERT_GT(recording.sound.packets.size(), 420u);
  EXPECT_TRUE(recording.face.units.empty());
  for (const AudioPacket& packet : recording.sound.packets) {
    const auto index = std::size_t((packet.time + 312) / 960);
    EXPECT_EQ(packet, sound.packets[index]);
  }
}

TEST(Recorder, WhoJoinsInTheMiddleBeginsWithAnIntraPlaneAndKeepsTheDistance) {
  const fba::AccessUnits face = test::make_face(100, 25000, 1000, 25);
  const EncodedAudio sound = make_sound(201);
  // About 31 planes and 63 packets are missed.
  const auto events = events_of(ClipInput(face, sound), {}, 94);
  const Kept recording = record(events);
  ASSERT_FALSE(recording.sound.packets.empty());
  ASSERT_FALSE(recording.face.units.empty());
  // The first sample that is heard is time 0.
  EXPECT_EQ(recording.sound.packets.front().time, -312);
  const AudioPacket& packet = recording.sound.packets.front();
  const auto original = std::find_if(sound.packets.begin(), sound.packets.end(),
                                     [&](const AudioPacket& p) { return p.bytes == packet.bytes; });
  ASSERT_NE(original, sound.packets.end());
  const double zero = double(original->time + 312) / 48000;
  // The face begins with plane 50, its distance to the sound is what it was.
  const fba::AccessUnit& first = recording.face.units.front();
  EXPECT_TRUE(first.intra);
  EXPECT_NEAR(double(first.time) / 25000 + zero, 50 * 0.04, 0.51 / 25000);
  const test::Bytes start(first.bytes.begin(), first.bytes.begin() + 5);
  EXPECT_EQ(start, (test::Bytes{0, 0, 1, 0xBA, 0x7F}));
  EXPECT_EQ(test::Bytes(first.bytes.begin() + 5, first.bytes.end()), face.units[50].bytes);
  EXPECT_EQ(recording.face.units[1].bytes, face.units[51].bytes);
}

TEST(Recorder, SoundThatBeginsAfterTheFaceBeginsLater) {
  const fba::AccessUnits face = test::make_face(100, 25000, 1000, 25);
  EncodedAudio sound = make_sound(100);
  for (AudioPacket& packet : sound.packets) packet.time += 48000;
  const Kept recording = record(events_of(ClipInput(face, sound)));
  EXPECT_EQ(recording.face.units.front().time, 0);
  EXPECT_EQ(recording.sound.packets.front().time, 48000 - 312);
}

// Sound that is announced and does not come holds nothing up for longer than a second.
TEST(Recorder, NothingIsHeldForLong) {
  const fba::AccessUnits face = test::make_face(100, 25000, 1000, 25);
  EncodedAudio sound = make_sound(100);
  for (AudioPacket& packet : sound.packets) packet.time += 2 * 48000;
  const auto events = events_of(ClipInput(face, sound));
  Recorder recorder;
  std::size_t given = 0;
  for (std::size_t i = 0; i < 29; ++i) {  // info, 28 planes: 1.12 s
    (void)recorder.accept(events[i]);
    given += recorder.take_units().size();
  }
  EXPECT_EQ(given, 27u) << "all but the one whose duration is not known";
  const Kept kept = record(events);
  EXPECT_EQ(kept.face, face);
  ASSERT_FALSE(kept.sound.packets.empty());
  EXPECT_EQ(kept.sound.packets.front().time, 2 * 48000 - 312);
}

// What is taken late is what is taken at once.
TEST(Recorder, WhenUnitsAreTakenDoesNotMatter) {
  const fba::AccessUnits face = test::make_face(100, 25000, 1000, 25);
  const auto events = events_of(ClipInput(face, make_sound(201)), {.loss = 0.1, .seed = 5});
  const Kept soon = record(events), late = record(events, Recorder(), false);
  EXPECT_EQ(soon.face, late.face);
  EXPECT_EQ(soon.sound, late.sound);
}

TEST(Recorder, EndsAtTheDuration) {
  const fba::AccessUnits face = test::make_face(100, 25000, 1000, 25);
  const auto events = events_of(ClipInput(face, make_sound(201)));
  Recorder timed({.duration = 2});
  const Kept kept = record(events, std::move(timed));
  EXPECT_TRUE(timed.ended());
  EXPECT_NEAR(timed.face_seconds(), 2, 0.05);
  EXPECT_NEAR(timed.sound_seconds(), 2, 0.05);
  EXPECT_NEAR(double(kept.face.units.size()), 50, 1) << "from the first sound on";
}

TEST(Recorder, AnotherPresentationEndsIt) {
  const fba::AccessUnits face = test::make_face(50, 25000, 1000, 25);
  auto events = events_of(ClipInput(face, {}));
  events.pop_back();  // the goodbye
  LiveInfo other = std::get<LiveInfo>(events.front());
  events.insert(events.begin() + 20, other);  // told again: nothing new
  other.timescale = 30000;
  events.push_back(other);
  Recorder recorder;
  EXPECT_EQ(record(events, std::move(recorder)).face.timescale, 25000u);
  EXPECT_TRUE(recorder.ended());
}

TEST(Recorder, UnitsThatDoNotAscendAreLeftOut) {
  const fba::AccessUnits face = test::make_face(50, 25000, 1000, 25);
  auto events = events_of(ClipInput(face, {}));
  events.insert(events.begin() + 10, events[9]);
  EXPECT_EQ(record(events).face, face);
}

TEST(Recorder, WithoutKeepingItStillCounts) {
  const fba::AccessUnits face = test::make_face(50, 25000, 1000, 25);
  Recorder recorder({.keep = false});
  int shown = 0;
  for (const LiveEvent& event : events_of(ClipInput(face, make_sound(101)))) {
    shown += recorder.accept(event).has_value();
  }
  EXPECT_EQ(shown, 151);
  EXPECT_TRUE(recorder.take_units().empty());
  EXPECT_NEAR(recorder.face_seconds(), 2, 1e-9);
}

TEST(Recorder, NothingReceivedIsAnEmptyRecording) {
  Recorder recorder;
  (void)recorder.accept(LiveEnd{});
  EXPECT_TRUE(recorder.take_units().empty());
  EXPECT_EQ(recorder.face_seconds(), 0);
}

}  // namespace recorder_test
}  // namespace animeme::media

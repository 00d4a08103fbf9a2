// From a late joiner's events to a file: face and sound keep their distance in every container.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/live/loopback.h"
#include "tools/formats/media/live/presentation.h"
#include "tools/formats/media/live/recorder.h"
#include "tools/formats/media/live/recording_file.h"

namespace animeme::media {
namespace recorder_file_test {

constexpr double kClick = 2.5;  // seconds of the presentation; plane 62 or so begins at 2.48

Pcm click(double length) {
  Pcm pcm{48000, std::vector<float>(std::size_t(length * 48000), 0.0F)};
  for (std::size_t i = 0; i < 240; ++i) {
    pcm.samples[std::size_t(kClick * 48000) + i] = float(0.8 * std::sin(double(i) * 0.5236));
  }
  return pcm;
}

double click_of(const Pcm& pcm) {
  for (std::size_t i = 0; i < pcm.samples.size(); ++i) {
    if (std::abs(pcm.samples[i]) > 0.3F) return double(i) / pcm.sample_rate;
  }
  return -1;
}

// What a receiver gets that gets nothing before `face_from` and `sound_from`, seconds.
std::vector<LiveEvent> events_from(const fba::AccessUnits& face, const EncodedAudio& sound,
                                   double face_from, double sound_from) {
  ClipInput input(face, sound);
  std::vector<LiveEvent> events = {input.info()};
  const auto units = input.take(1e9);
  for (const LiveUnit& unit : *units) {
    const double from = unit.track == LiveTrack::face ? face_from : sound_from;
    if (seconds_of(input.info(), unit.track, unit.time) >= from) events.emplace_back(unit);
  }
  events.emplace_back(LiveEnd{});
  return events;
}

enum class End : bool { killed, regular };

// The events into a file as they come.
void record(const std::vector<LiveEvent>& events, const std::string& path, End end) {
  Recorder recorder;
  RecordingFile file(path);
  for (const LiveEvent& event : events) {
    (void)recorder.accept(event);
    const auto written = file.write(recorder);
    ASSERT_TRUE(written) << path << ": " << written.error().describe();
  }
  if (end == End::killed) return;
  const auto finished = file.finish();
  ASSERT_TRUE(finished) << path << ": " << finished.error().describe();
}

struct Case {
  double face_from, sound_from;
  AudioCodec codec;
};

class LateJoiners : public testing::TestWithParam<Case> {};

TEST_P(LateJoiners, HearTheClickAtItsPlane) {
  const fba::AccessUnits face = test::make_face(125, 25000, 1000, 25);
  const auto sound = encode_audio(click(5), {GetParam().codec});
  ASSERT_TRUE(sound);
  const auto events = events_from(face, *sound, GetParam().face_from, GetParam().sound_from);
  const test::TempDir dir;
  for (const End end : {End::regular, End::killed}) {
    for (const std::string name : {"talk.mp4", "talk.mkv", "talk.ts"}) {
      const std::string path = dir.file((end == End::killed ? "killed_" : "whole_") + name);
      record(events, path, end);
      const auto read = read_container(path);
      const auto pcm = read_audio(path);
      ASSERT_TRUE(read && pcm) << path;
      // From the first intra plane on; who is killed loses the last second at most.
      const std::size_t all = GetParam().face_from < 0 ? 125 : GetParam().face_from > 1 ? 75 : 100;
      EXPECT_LE(read->face.units.size(), all) << path;
      EXPECT_GE(read->face.units.size(), end == End::regular ? all : all - 25) << path;
      // The plane that begins at 2.48 s, found by its bytes.
      const auto& wanted = face.units[62].bytes;
      double plane = -1000;
      for (const fba::AccessUnit& unit : read->face.units) {
        if (unit.bytes == wanted) plane = double(unit.time) / read->face.timescale;
      }
      EXPECT_NEAR(click_of(*pcm) - plane, kClick - 2.48, 0.0016) << path;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, LateJoiners,
    testing::Values(Case{-1, -1, AudioCodec::aac}, Case{1.5, 1.2, AudioCodec::aac},
                    Case{1.0, 1.7, AudioCodec::aac}, Case{-1, -1, AudioCodec::opus},
                    Case{1.5, 1.2, AudioCodec::opus}, Case{1.0, 1.7, AudioCodec::opus},
                    // One of them comes when the file has been begun already.
                    Case{1.9, -1, AudioCodec::aac}, Case{-1, 2.2, AudioCodec::aac},
                    Case{1.9, -1, AudioCodec::opus}, Case{-1, 2.2, AudioCodec::opus}));

// What is there when the program is killed while it writes the last of `bytes`: a fragment that is
// not whole is free space by then (growing_mp4.h).
std::string cut_short(std::string bytes, std::size_t size, bool mp4) {
  bytes.resize(size);
  for (std::size_t at = 0, fragment = 0; mp4 && at + 8 <= size;) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::uint8_t(bytes[at + i]);
    if (bytes.compare(at + 4, 4, "moof") == 0) fragment = at;
    if (at + length > size && fragment > 0) bytes.replace(fragment + 4, 4, "free");
    at += length;
  }
  return bytes;
}

// A prefix of the file, as writes end when the process does.
TEST(RecordingFile, CanBeCutAnywhere) {
  const fba::AccessUnits face = test::make_face(150, 25000, 1000, 25);
  const auto sound = encode_audio(click(6));
  ASSERT_TRUE(sound);
  const test::TempDir dir;
  for (const std::string extension : {".mp4", ".mkv", ".ts"}) {
    const std::string path = dir.file("talk" + extension);
    record(events_from(face, *sound, -1, -1), path, End::killed);
    const std::string bytes = test::slurp(path);
    std::size_t most = 0;
    for (std::size_t cut = bytes.size() / 3; cut <= bytes.size(); cut += 1 + bytes.size() / 97) {
      const std::string part = dir.file("part" + extension);
      test::spill(part, cut_short(bytes, cut, extension == ".mp4"));
      const auto read = read_container(part);
      ASSERT_TRUE(read) << extension << " cut at " << cut << ": " << read.error().describe();
      const std::size_t planes = read->face.units.size();
      // The file grows evenly behind its contents: what is missing was just being written.
      const double share = (double(cut) - 2000) / (double(bytes.size()) - 2000);
      EXPECT_GE(double(planes), 150 * share - 28) << extension << " cut at " << cut;
      most = std::max(most, planes);
      EXPECT_TRUE(std::equal(read->face.units.begin(), read->face.units.end(), face.units.begin(),
                             [](const auto& a, const auto& b) { return a.bytes == b.bytes; }))
          << extension << " cut at " << cut;
    }
    EXPECT_GE(most, 125u) << extension;
  }
}

std::size_t resident_bytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  in >> all >> resident;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

// An hour takes no more memory than its first five minutes.
TEST(RecordingFile, MemoryDoesNotGrowWithTheLength) {
  const fba::AccessUnits face = test::make_face(25, 25000, 1000, 25);
  const auto sound = encode_audio(click(3));
  ASSERT_TRUE(sound);
  const test::TempDir dir;
  for (const std::string extension : {".mp4", ".mkv", ".ts", ".fba"}) {
    ClipInput input(face, *sound, {.loop = true, .duration = 3600});
    Recorder recorder;
    RecordingFile file(dir.file("long" + extension));
    (void)recorder.accept(input.info());
    std::size_t early = 0;
    for (double now = 0; now <= 3600; now += 1) {
      const auto units = input.take(now);
      for (const LiveUnit& unit : *units) {
        (void)recorder.accept(unit);
        ASSERT_TRUE(file.write(recorder));
      }
      (void)recorder.take_intervals();
      if (now == 300) early = resident_bytes();
    }
    EXPECT_LT(resident_bytes(), early + (std::size_t(4) << 20)) << extension;
    ASSERT_TRUE(file.finish());
  }
}

TEST(RecordingFile, AnMp4KnowsItsLengthWhileItIsMade) {
  const fba::AccessUnits face = test::make_face(150, 25000, 1000, 25);
  const auto events = events_from(face, {}, -1, -1);
  const test::TempDir dir;
  const std::string path = dir.file("talk.mp4");
  Recorder recorder;
  RecordingFile file(path);
  double before = -1;
  for (std::size_t i = 0; i < events.size(); ++i) {
    (void)recorder.accept(events[i]);
    ASSERT_TRUE(file.write(recorder));
    if (i % 25 != 0 || i < 50) continue;
    const auto info = probe(path);
    ASSERT_TRUE(info) << info.error().describe();
    EXPECT_GE(info->duration, before);
    EXPECT_NEAR(info->duration, double(i) / 25, 0.6);
    before = info->duration;
  }
  ASSERT_TRUE(file.finish());
  EXPECT_NEAR(probe(path)->duration, 6, 0.01);
}

TEST(RecordingFile, AnOldFileStaysUntilThereIsSomethingNew) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(50, 25000, 1000, 25);
  for (const std::string name : {"a.mp4", "a.mkv", "a.ts", "a.fba"}) {
    const std::string path = dir.file(name);
    test::spill(path, "old");
    {
      Recorder recorder;
      RecordingFile file(path);
      const auto events = events_from(face, {}, -1, -1);
      (void)recorder.accept(events[0]);
      ASSERT_TRUE(file.write(recorder));
      (void)recorder.accept(LiveIdle{});
      ASSERT_TRUE(file.flush());
      EXPECT_EQ(test::slurp(path), "old") << "nothing came";
      for (std::size_t i = 1; i < 5; ++i) {
        (void)recorder.accept(events[i]);
        ASSERT_TRUE(file.write(recorder));
      }
      EXPECT_NE(test::slurp(path), "old") << name;
    }
    EXPECT_NE(test::slurp(path), "old") << name << ": it stays without a regular end";
    Recorder nothing;
    RecordingFile none(dir.file("none" + name));
    (void)nothing.accept(LiveEnd{});
    EXPECT_TRUE(none.write(nothing));
    EXPECT_TRUE(none.finish());
    EXPECT_FALSE(std::filesystem::exists(dir.file("none" + name)));
  }
  EXPECT_EQ(dir.files().size(), 4u) << "nothing else is left behind";
}

TEST(RecordingFile, AStreamIsThatOfTheSender) {
  const fba::AccessUnits face = test::make_face(50, 25000, 1000, 25);
  const auto sound = encode_audio(click(3));
  const test::TempDir dir;
  record(events_from(face, *sound, -1, -1), dir.file("a.fba"), End::regular);
  const auto joined = fba::join_access_units(face);
  EXPECT_EQ(test::slurp(dir.file("a.fba")), std::string(joined.begin(), joined.end()));
}

TEST(RecordingFile, SaysWhatIsWrong) {
  const fba::AccessUnits face = test::make_face(50, 25000, 1000, 25);
  const auto events = events_from(face, {}, -1, -1);
  const test::TempDir dir;
  const auto first_error = [&](const std::string& path, const std::vector<LiveEvent>& all) {
    Recorder recorder;
    RecordingFile file(path);
    std::optional<Error> error;
    for (const LiveEvent& event : all) {
      (void)recorder.accept(event);
      const auto written = file.write(recorder);
      if (!written && !error) error = written.error();
    }
    EXPECT_TRUE(file.finish()) << "told once";
    return error.value_or(Error{});
  };
  EXPECT_EQ(first_error(dir.file("a.avi"), events).code, Code::unsupported);
  EXPECT_EQ(first_error(dir.file("none/a.mp4"), events).code, Code::io);
  auto other = events;
  std::get<LiveInfo>(other[0]).face_config = {1, 2, 3};
  EXPECT_EQ(first_error(dir.file("a.mp4"), other).code, Code::invalid_argument);
  EXPECT_TRUE(dir.files().empty());
}

}  // namespace recorder_file_test
}  // namespace animeme::media

// HLS and DASH presentations as files: whole or not at all, read in a closed room.
#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tests/formats/media/small_disk.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace segments_test {

namespace fs = std::filesystem;

class Segments : public testing::TestWithParam<const char*> {
 protected:
  std::string folder() const {
    return dir_.file(std::string("talk") + (GetParam() == std::string(".mpd") ? "_dash" : "_hls"));
  }
  Result<MuxResult> write(const MuxOptions& options = {}) {
    return write_container(path_, {.face = &face_, .audio = &sound_}, options);
  }
  void expect_whole() {
    const Result<Container> back = read_container(path_);
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_TRUE(back->face == face_);
    EXPECT_EQ(back->format, GetParam() == std::string(".mpd") ? "dash" : "hls");
    ASSERT_TRUE(back->audio);
    EXPECT_EQ(back->audio->codec, "aac");
  }

  test::TempDir dir_;
  std::string path_ = dir_.file(std::string("talk") + GetParam());
  fba::AccessUnits face_ = test::make_face(150, 25000, 1000, 25);
  Pcm sound_ = test::make_clicks(48000, 6 * 48000, {24037, 96011});
};

TEST_P(Segments, EverythingIsReadFromThem) {
  const Result<MuxResult> written = write({.fragment_seconds = 2});
  ASSERT_TRUE(written) << written.error().describe();
  EXPECT_NEAR(written->seconds, 6, 0.05);
  expect_whole();
  EXPECT_EQ(dir_.count(), 2u) << "the playlist and its folder";
  EXPECT_TRUE(fs::exists(folder() + "/face-00003.m4s"));
  EXPECT_FALSE(fs::exists(folder() + "/face-00004.m4s"));
  EXPECT_TRUE(fs::exists(folder() + "/sound-00003.m4s"));
  const Result<Pcm> heard = read_audio(path_);
  ASSERT_TRUE(heard) << heard.error().describe();
  EXPECT_EQ(heard->samples.size(), sound_.samples.size());
  const Result<EncodedAudio> coded = read_encoded_audio(path_);
  ASSERT_TRUE(coded) << coded.error().describe();
  const Result<EncodedAudio> direct = encode_audio(sound_);
  ASSERT_TRUE(direct);
  EXPECT_EQ(coded->format, direct->format);
  EXPECT_EQ(coded->length, direct->length);
  ASSERT_EQ(coded->packets.size(), direct->packets.size());
  for (std::size_t i = 0; i < direct->packets.size(); ++i) {
    EXPECT_EQ(coded->packets[i].bytes, direct->packets[i].bytes) << i;
    EXPECT_EQ(coded->packets[i].time, direct->packets[i].time) << i;
    EXPECT_EQ(coded->packets[i].duration, direct->packets[i].duration) << i;
  }
  const Result<ContainerInfo> info = probe(path_);
  ASSERT_TRUE(info) << info.error().describe();
  ASSERT_EQ(info->tracks.size(), 2u);
  EXPECT_NE(info->first(TrackKind::face), nullptr);
  EXPECT_EQ(info->first(TrackKind::face)->visual_profile, 0x61);
  ASSERT_TRUE(extract_audio(path_, dir_.file("a.m4a")));
  const Result<Pcm> copied = read_audio(dir_.file("a.m4a"));
  ASSERT_TRUE(copied) << copied.error().describe();
  EXPECT_EQ(copied->samples.size(), heard->samples.size());
  for (std::size_t i = 0; i < heard->samples.size(); ++i) {
    ASSERT_EQ(copied->samples[i], heard->samples[i]) << i;
  }
}

TEST_P(Segments, EachSegmentBeginsWithAnIntraPlane) {
  ASSERT_TRUE(write({.fragment_seconds = 0.1}));  // shorter than the intra period
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder())) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("face-0")) ++count;
  }
  EXPECT_EQ(count, 6u);
  expect_whole();
}

TEST_P(Segments, TheSameInputGivesTheSameBytes) {
  ASSERT_TRUE(write());
  const auto text = test::read_bytes(path_);
  const auto segment = test::read_bytes(folder() + "/sound-00002.m4s");
  ASSERT_FALSE(segment.empty());
  ASSERT_TRUE(write());
  EXPECT_EQ(test::read_bytes(path_), text);
  EXPECT_EQ(test::read_bytes(folder() + "/sound-00002.m4s"), segment);
}

TEST_P(Segments, AnOldPresentationIsReplacedAsAWhole) {
  ASSERT_TRUE(write({.fragment_seconds = 0.5}));
  ASSERT_TRUE(fs::exists(folder() + "/sound-00010.m4s"));
  ASSERT_TRUE(write({.fragment_seconds = 3}));
  EXPECT_FALSE(fs::exists(folder() + "/sound-00010.m4s"));
  EXPECT_EQ(dir_.count(), 2u);
  expect_whole();
}

TEST_P(Segments, AFolderOfOthersIsLeftAlone) {
  fs::create_directory(folder());
  test::write_bytes(folder() + "/diary.txt", {1});
  const auto written = write();
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::io);
  EXPECT_THAT(written.error().message, testing::HasSubstr("diary.txt"));
  EXPECT_TRUE(fs::exists(folder() + "/diary.txt"));
  EXPECT_EQ(dir_.count(), 1u);
}

TEST_P(Segments, AFullDiskLeavesNothingAndKeepsTheOld) {
  ASSERT_TRUE(write());
  const auto before = test::read_bytes(path_);
  const std::vector<float> loud = [&] {
    std::vector<float> samples(48000 * 10);
    std::uint32_t state = 1;
    for (float& sample : samples) {
      state = state * 1664525u + 1013904223u;
      sample = float(state >> 8) / float(1 << 24) - 0.5f;
    }
    return samples;
  }();
  const Pcm noise{48000, loud};
  test::with_small_disk(20000, [&] {
    const auto written = write_container(path_, {.face = &face_, .audio = &noise});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, Code::io);
  });
  EXPECT_EQ(test::read_bytes(path_), before);
  EXPECT_EQ(dir_.count(), 2u);
  expect_whole();
}

TEST_P(Segments, OddNamesAreWrittenAsReferences) {
  path_ = dir_.file(std::string("so $Time$ & \"100%\" #1 \xC3\xA4") + GetParam());
  const auto written = write();
  ASSERT_TRUE(written) << written.error().describe();
  expect_whole();
}

TEST_P(Segments, StoppedEarlyTheyAreStillWhole) {
  int asked = 0;
  MuxOptions options;
  options.stop = [&] { return ++asked == 100; };
  const auto written = write(options);
  ASSERT_TRUE(written) << written.error().describe();
  EXPECT_TRUE(written->stopped);
  const Result<Container> back = read_container(path_);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_LT(back->face.units.size(), 150u);
  EXPECT_NEAR(double(back->face.units.size()) / 25, written->seconds, 0.1);
}

TEST_P(Segments, NoOtherFolderIsRead) {
  ASSERT_TRUE(write());
  const test::TempDir outside;
  fs::copy(folder() + "/face-00001.m4s", outside.file("face-00001.m4s"));
  fs::remove(folder() + "/face-00001.m4s");
  const auto missing = read_container(path_);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::not_found);
  EXPECT_THAT(missing.error().message, testing::HasSubstr("face-00001.m4s"));
  fs::create_symlink(outside.file("face-00001.m4s"), folder() + "/face-00001.m4s");
  const auto linked = read_container(path_);
  ASSERT_FALSE(linked);
  EXPECT_EQ(linked.error().code, Code::unsupported);
  fs::remove(folder() + "/face-00001.m4s");
  fs::create_directory(folder() + "/face-00001.m4s");
  EXPECT_EQ(read_container(path_).error().code, Code::unsupported);
}

TEST_P(Segments, SoundAloneAndFaceAlone) {
  ASSERT_TRUE(write_container(path_, {.audio = &sound_}));
  EXPECT_EQ(read_container(path_).error().code, Code::not_found);
  EXPECT_TRUE(read_audio(path_));
  ASSERT_TRUE(write_container(path_, {.face = &face_}));
  EXPECT_TRUE(read_container(path_));
  EXPECT_EQ(read_audio(path_).error().code, Code::not_found);
}

TEST_P(Segments, AnOrdinaryPlayerPlaysTheSound) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  ASSERT_TRUE(write());
  int status = -1;
  test::run("cd '" + dir_.file("") + "' && ffmpeg -v quiet -i talk" + GetParam() + " out.wav",
            &status);
  ASSERT_EQ(status, 0);
  const Result<Pcm> heard = read_audio(dir_.file("out.wav"));
  ASSERT_TRUE(heard) << heard.error().describe();
  // ffmpeg plays the priming, too, when it is asked for a plain file.
  const std::int64_t shift = test::find_click(*heard, 24037, 3000) - 24037;
  EXPECT_THAT(shift, testing::AnyOf(0, 1024));
  EXPECT_EQ(test::find_click(*heard, 96011 + shift, 3000), 96011 + shift);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Segments, testing::Values(".m3u8", ".mpd"),
                         [](const auto& kind) { return std::string(kind.param + 1); });

TEST(SegmentsOfOthers, AMediaPlaylistAlone) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(48000, 4 * 48000, {24000});
  // Face and sound in one file, cut by nobody: one segment that has its own contents.
  ASSERT_TRUE(
      write_container(dir.file("a.mp4"), {.face = &face, .audio = &sound}, {.fragmented = true}));
  const std::string text = "#EXTM3U\n#EXTINF:4,\na.mp4\n#EXT-X-ENDLIST\n";
  test::write_bytes(dir.file("a.m3u8"), test::Bytes(text.begin(), text.end()));
  const Result<Container> back = read_container(dir.file("a.m3u8"));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_TRUE(back->face == face);
  EXPECT_TRUE(back->audio);
}

TEST(SegmentsOfOthers, ThoseOfLibavformat) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const test::TempDir dir;
  const Pcm sound = test::make_clicks(48000, 8 * 48000, {24037, 96011});
  ASSERT_TRUE(write_wav(dir.file("a.wav"), sound));
  int status = -1;
  test::run("cd '" + dir.file("") +
                "' && ffmpeg -v quiet -i a.wav -c:a aac -f dash -seg_duration 2 -hls_playlist 1 "
                "a.mpd",
            &status);
  ASSERT_EQ(status, 0);
  for (const char* name : {"a.mpd", "master.m3u8"}) {
    const Result<Pcm> heard = read_audio(dir.file(name));
    ASSERT_TRUE(heard) << heard.error().describe();
    EXPECT_NEAR(double(test::find_click(*heard, 96011, 3000)), 96011, 1) << name;
  }
}

}  // namespace segments_test
}  // namespace animeme::media

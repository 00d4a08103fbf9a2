// Nothing half-written is left behind, and every refusal says why.
#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tests/formats/media/small_disk.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace mux_failure_test {

class MuxFailure : public testing::Test {
 protected:
  void expect_refused(Code code, const std::string& words) {
    const Result<MuxResult> written = write_container(dir_.file("talk.mp4"), input_);
    ASSERT_FALSE(written) << words;
    EXPECT_EQ(written.error().code, code);
    EXPECT_THAT(written.error().message, testing::HasSubstr(words));
    EXPECT_EQ(dir_.count(), 0u);
  }

  test::TempDir dir_;
  fba::AccessUnits face_ = test::make_face(10);
  Pcm sound_ = test::make_clicks(16000, 16000, {8000});
  MuxInput input_{.face = &face_, .audio = &sound_};
};

TEST_F(MuxFailure, NothingToWrite) {
  input_ = {};
  expect_refused(Code::invalid_argument, "nothing to write");
}

TEST_F(MuxFailure, NoUnits) {
  face_.units.clear();
  expect_refused(Code::invalid_argument, "no access units");
}

TEST_F(MuxFailure, EmptyUnit) {
  face_.units[4].bytes.clear();
  expect_refused(Code::invalid_argument, "access unit 4 is empty");
}

TEST_F(MuxFailure, TimesDoNotAscend) {
  face_.units[5].time = face_.units[4].time;
  expect_refused(Code::invalid_argument, "access unit 5 has the time 4000");
}

TEST_F(MuxFailure, NegativeTime) {
  face_.units[0].time = -1;
  expect_refused(Code::invalid_argument, "access unit 0");
}

TEST_F(MuxFailure, NoDuration) {
  face_.units[9].duration = 0;
  expect_refused(Code::invalid_argument, "positive duration");
}

TEST_F(MuxFailure, ConfigurationOfVideo) {
  face_.config[10] = 0x13;  // visual_object_type 1
  expect_refused(Code::invalid_argument, "not that of a face");
  face_.config.clear();
  expect_refused(Code::invalid_argument, "missing");
}

TEST_F(MuxFailure, ZeroTimescale) {
  face_.timescale = 0;
  expect_refused(Code::invalid_argument, "time scale");
}

TEST_F(MuxFailure, EmptySound) {
  sound_.samples.clear();
  expect_refused(Code::invalid_argument, "sound is empty");
}

TEST_F(MuxFailure, UnknownExtension) {
  for (const char* name : {"talk.avi", "talk", "talk.mp3"}) {
    const Result<MuxResult> written = write_container(dir_.file(name), input_);
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().code, Code::unsupported);
    EXPECT_THAT(written.error().message, testing::HasSubstr("use .mp4, .mkv or .ts"));
  }
  const auto face_in_m4a = write_container(dir_.file("talk.m4a"), input_);
  ASSERT_FALSE(face_in_m4a);
  EXPECT_EQ(face_in_m4a.error().code, Code::unsupported);
  EXPECT_EQ(dir_.count(), 0u);
}

TEST_F(MuxFailure, FolderMissing) {
  const Result<MuxResult> written = write_container(dir_.file("no/such/talk.mp4"), input_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::io);
  EXPECT_EQ(written.error().where.file, dir_.file("no/such/talk.mp4"));
}

TEST_F(MuxFailure, AFolderIsNotOverwritten) {
  std::filesystem::create_directory(dir_.file("talk.mp4"));
  const Result<MuxResult> written = write_container(dir_.file("talk.mp4"), input_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::io);
  EXPECT_EQ(dir_.count(), 1u);
}

TEST_F(MuxFailure, FullDiskLeavesNothingAndKeepsTheOldFile) {
  Pcm noise{48000, std::vector<float>(48000 * 10)};
  std::uint32_t state = 1;
  for (float& sample : noise.samples) {
    state = state * 1664525u + 1013904223u;
    sample = float(state >> 8) / float(1 << 24) - 0.5f;
  }
  input_.audio = &noise;
  const auto files = {"a.mp4", "a.mkv", "a.ts", "a.mka", "a.m4a"};
  for (const char* name : files) test::write_bytes(dir_.file(name), {1, 2, 3});
  test::write_bytes(dir_.file("a.wav"), {1, 2, 3});
  test::with_small_disk(20000, [&] {
    for (const char* name : files) {
      input_.face = std::string(name).ends_with("a") ? nullptr : &face_;
      const Result<MuxResult> written = write_container(dir_.file(name), input_);
      ASSERT_FALSE(written) << name;
      EXPECT_EQ(written.error().code, Code::io) << name << written.error().describe();
      EXPECT_THAT(written.error().message, testing::HasSubstr("File too large; the file system"))
          << name;
    }
    const Result<void> wav = write_wav(dir_.file("a.wav"), noise);
    ASSERT_FALSE(wav);
    EXPECT_EQ(wav.error().code, Code::io);
  });
  EXPECT_EQ(dir_.count(), files.size() + 1);
  EXPECT_EQ(test::read_bytes(dir_.file("a.wav")), (test::Bytes{1, 2, 3}));
  for (const char* name : files) {
    EXPECT_EQ(test::read_bytes(dir_.file(name)), (test::Bytes{1, 2, 3})) << name;
  }
}

TEST_F(MuxFailure, FullDiskWhileTheContentsAreMoved) {
  // All of it fits but not the contents, which are longer at the end.
  ASSERT_TRUE(write_container(dir_.file("whole.mp4"), input_));
  const auto size = std::filesystem::file_size(dir_.file("whole.mp4"));
  test::with_small_disk(size - 5, [&] {
    const auto written = write_container(dir_.file("talk.mp4"), input_);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, Code::io);
    EXPECT_THAT(written.error().message, testing::HasSubstr("File too large"));
  });
  EXPECT_EQ(dir_.count(), 1u);
}

TEST_F(MuxFailure, CodecsThatAFormatDoesNotTake) {
  const auto coded = encode_audio(sound_, {.codec = AudioCodec::opus});
  ASSERT_TRUE(coded);
  const auto refused = [&](const char* name, const MuxInput& input, const MuxOptions& options,
                           const char* words) {
    const auto written = write_container(dir_.file(name), input, options);
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().code, Code::unsupported) << name;
    EXPECT_THAT(written.error().message, testing::HasSubstr(words)) << name;
  };
  const MuxOptions opus{.audio = {.codec = AudioCodec::opus}};
  refused("a.ts", input_, opus, "a .ts file does not support opus; code the sound as aac");
  refused("a.m4a", {.audio = &sound_}, opus, "does not support opus");
  refused("a.opus", {.audio = &sound_}, {}, "does not support aac; code the sound as opus");
  refused("a.webm", {.audio = &sound_}, {}, "does not support aac");
  refused("a.webm", input_, opus, "can only contain sound");
  refused("a.ts", {.face = &face_, .encoded = &*coded}, {}, "does not support opus");
  refused("a.mp4", {.face = &face_, .encoded = &*coded}, {.systems = true}, "needs AAC");
  refused("a.mkv", input_, {.fragmented = true}, "only an mp4");
  refused("a.mkv", input_, {.shared_seconds = 0.4}, ".ts files only");
  refused("a.mp4", input_, {.fragmented = true, .systems = true}, "cannot be fragmented");
  EXPECT_EQ(dir_.count(), 0u);
}

TEST_F(MuxFailure, SoundGivenTwiceAndFragmentsOfNoLength) {
  const auto coded = encode_audio(sound_);
  ASSERT_TRUE(coded);
  input_.encoded = &*coded;
  expect_refused(Code::invalid_argument, "given more than once");
  input_.encoded = nullptr;
  for (const double seconds : {0.0, -1.0, 1e9, double(NAN)}) {
    const auto written = write_container(dir_.file("a.mp4"), input_, {.fragment_seconds = seconds});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, Code::invalid_argument);
  }
}

TEST_F(MuxFailure, CodedSoundThatIsNone) {
  auto coded = encode_audio(sound_);
  ASSERT_TRUE(coded);
  input_.audio = nullptr;
  EncodedAudio bad = *coded;
  input_.encoded = &bad;
  bad.packets[3].bytes.clear();
  expect_refused(Code::invalid_argument, "sound packet 3 is empty");
  bad = *coded;
  bad.packets[3].time = bad.packets[2].time;
  expect_refused(Code::invalid_argument, "sound packet 3 has the time");
  bad = *coded;
  bad.format.config.clear();
  expect_refused(Code::invalid_argument, "configuration");
  bad.packets.clear();
  expect_refused(Code::invalid_argument, "sound is empty");
}

TEST_F(MuxFailure, NonsenseSamplesDoNotStopTheEncoder) {
  sound_.samples[100] = NAN;
  sound_.samples[101] = INFINITY;
  sound_.samples[102] = -1e30f;
  const Result<MuxResult> written = write_container(dir_.file("talk.mp4"), input_);
  EXPECT_TRUE(written) << written.error().describe();
}

}  // namespace mux_failure_test
}  // namespace animeme::media

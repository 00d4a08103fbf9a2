// Sound out of containers: copied where the target can take it, in place to the sample.
#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace extract_audio_test {

class ExtractAudio : public testing::Test {
 protected:
  void SetUp() override {
    const Result<MuxResult> written = write_mp4(talk_, {.face = &face_, .audio = &sound_});
    ASSERT_TRUE(written) << written.error().describe();
  }

  // Sample at which the first burst lies, and the length.
  void expect_place(const std::string& path, std::int64_t shift, std::size_t length) {
    const Result<Pcm> pcm = read_audio(path);
    ASSERT_TRUE(pcm) << pcm.error().describe();
    EXPECT_EQ(pcm->samples.size(), length);
    for (const std::int64_t start : {24000, 72000}) {
      EXPECT_NEAR(double(test::find_click(*pcm, start + shift, 3000)), double(start + shift), 1.0);
    }
  }

  test::TempDir dir_;
  fba::AccessUnits face_ = test::make_face(50);
  Pcm sound_ = test::make_clicks(48000, 96000, {24000, 72000});
  std::string talk_ = dir_.file("talk.mp4");
};

TEST_F(ExtractAudio, Wav) {
  ASSERT_TRUE(extract_audio(talk_, dir_.file("a.wav")));
  expect_place(dir_.file("a.wav"), 0, 96000);
}

TEST_F(ExtractAudio, CopiesKeepThePriming) {
  for (const char* name : {"a.m4a", "a.mp4"}) {
    const Result<void> done = extract_audio(talk_, dir_.file(name));
    ASSERT_TRUE(done) << done.error().describe();
    expect_place(dir_.file(name), 0, 96000);
  }
}

TEST_F(ExtractAudio, AdtsAndMatroskaCannotSayPriming) {
  for (const char* name : {"a.aac", "a.mka"}) {
    const Result<void> done = extract_audio(talk_, dir_.file(name));
    ASSERT_TRUE(done) << done.error().describe();
    const Result<Pcm> pcm = read_audio(dir_.file(name));
    ASSERT_TRUE(pcm) << pcm.error().describe();
    EXPECT_NEAR(double(test::find_click(*pcm, 25024, 3000)), 25024, 1.0) << name;
  }
}

TEST_F(ExtractAudio, FromTransportStreamTheTimeBeginsAtZero) {
  ASSERT_TRUE(write_container(dir_.file("talk.ts"), {.face = &face_, .audio = &sound_}));
  const Result<void> done = extract_audio(dir_.file("talk.ts"), dir_.file("a.m4a"));
  ASSERT_TRUE(done) << done.error().describe();
  const Result<ContainerInfo> info = probe(dir_.file("a.m4a"));
  ASSERT_TRUE(info);
  ASSERT_EQ(info->tracks.size(), 1u);
  EXPECT_DOUBLE_EQ(info->tracks[0].start, 0.0);
  const Result<Pcm> pcm = read_audio(dir_.file("a.m4a"));
  ASSERT_TRUE(pcm) << pcm.error().describe();
  EXPECT_NEAR(double(test::find_click(*pcm, 25024, 3000)), 25024, 1.0);
}

TEST_F(ExtractAudio, OpusIsCopiedToOgg) {
  const std::filesystem::path shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "no reference data (set ANIMEME_SHARED)";
  const std::string opus = (shared / "examples" / "containers" / "std_opus.mp4").string();
  for (const char* name : {"a.opus", "a.ogg", "a.mp4"}) {
    const Result<void> done = extract_audio(opus, dir_.file(name));
    ASSERT_TRUE(done) << done.error().describe();
    expect_place(dir_.file(name), 0, 480000);
  }
}

TEST_F(ExtractAudio, RefusalsNameWhatToUse) {
  const Result<void> misfit = extract_audio(talk_, dir_.file("a.opus"));
  ASSERT_FALSE(misfit);
  EXPECT_EQ(misfit.error().code, Code::unsupported);
  EXPECT_THAT(misfit.error().message,
              testing::AllOf(testing::HasSubstr("is aac"), testing::HasSubstr(".m4a"),
                             testing::HasSubstr(".wav"), testing::Not(testing::HasSubstr(".mp3"))));
  const Result<void> unknown = extract_audio(talk_, dir_.file("a.xyz"));
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Code::unsupported);
  ASSERT_TRUE(write_mp4(dir_.file("mute.mp4"), {.face = &face_}));
  for (const char* name : {"a.m4a", "a.wav"}) {
    const Result<void> mute = extract_audio(dir_.file("mute.mp4"), dir_.file(name));
    ASSERT_FALSE(mute);
    EXPECT_EQ(mute.error().code, Code::not_found);
  }
  const Result<void> missing = extract_audio(dir_.file("none.mp4"), dir_.file("a.m4a"));
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::not_found);
  EXPECT_EQ(dir_.count(), 2u) << "nothing but talk.mp4 and mute.mp4";
}

TEST_F(ExtractAudio, SameInputGivesSameBytes) {
  ASSERT_TRUE(extract_audio(talk_, dir_.file("a.m4a")));
  ASSERT_TRUE(extract_audio(talk_, dir_.file("b.m4a")));
  EXPECT_EQ(test::read_bytes(dir_.file("a.m4a")), test::read_bytes(dir_.file("b.m4a")));
}

}  // namespace extract_audio_test
}  // namespace animeme::media

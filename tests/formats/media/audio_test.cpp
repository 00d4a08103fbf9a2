// Sound in and out: lengths, positions, refusals.
#include "tools/formats/media/audio.h"

#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"

namespace animeme::media {
namespace audio_test {

using test::Bytes;

TEST(Wav, RoundTripIsExactFor16Bits) {
  const test::TempDir dir;
  Pcm pcm{22050, {}};
  for (int v = -32768; v <= 32767; v += 13) pcm.samples.push_back(float(v) / 32768.0f);
  ASSERT_TRUE(write_wav(dir.file("a.wav"), pcm));
  EXPECT_EQ(std::filesystem::file_size(dir.file("a.wav")), 44 + 2 * pcm.samples.size());
  const Result<Pcm> back = read_audio(dir.file("a.wav"));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->sample_rate, 22050);
  EXPECT_EQ(back->samples, pcm.samples);
}

TEST(Wav, ClipsInsteadOfWrapping) {
  const test::TempDir dir;
  ASSERT_TRUE(write_wav(dir.file("a.wav"), {8000, {2.0f, -2.0f, NAN, INFINITY}}));
  const Result<Pcm> back = read_audio(dir.file("a.wav"));
  ASSERT_TRUE(back);
  EXPECT_THAT(back->samples, testing::ElementsAre(32767 / 32768.0f, -1.0f, 0.0f, 32767 / 32768.0f));
}

TEST(Wav, RefusesNonsense) {
  const test::TempDir dir;
  const Result<void> rate = write_wav(dir.file("a.wav"), {0, {1.0f}});
  ASSERT_FALSE(rate);
  EXPECT_EQ(rate.error().code, Code::invalid_argument);
  const Result<void> folder = write_wav(dir.file("no/a.wav"), {8000, {1.0f}});
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, Code::io);
  EXPECT_EQ(dir.count(), 0u);
}

TEST(Resample, KeepsLengthAndPosition) {
  const Pcm clicks = test::make_clicks(44100, 4 * 44100, {44100, 3 * 44100});
  for (const int rate : {16000, 22050, 48000, 96000}) {
    const Result<Pcm> out = resample(clicks, rate);
    ASSERT_TRUE(out);
    EXPECT_EQ(out->sample_rate, rate);
    EXPECT_EQ(out->samples.size(), std::size_t(4 * rate));
    EXPECT_NEAR(double(test::find_click(*out, rate, 500)), rate, 1.0);
    EXPECT_NEAR(double(test::find_click(*out, 3 * rate, 500)), 3.0 * rate, 1.0);
  }
  const Result<Pcm> odd = resample({44100, std::vector<float>(1001)}, 16000);
  ASSERT_TRUE(odd);
  EXPECT_EQ(odd->samples.size(), 363u);  // 363.17
  EXPECT_FALSE(resample(clicks, 0));
  EXPECT_FALSE(resample({0, {1.0f}}, 16000));
}

// Every file that ffmpeg makes of the same sound must come back in place and length.
struct Encoding {
  const char* name;
  const char* options;
  int sample_rate = 48000;
};

class ReadAudio : public testing::TestWithParam<Encoding> {};

TEST_P(ReadAudio, LengthAndBurstsAreKept) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const test::TempDir dir;
  const Pcm clicks = test::make_clicks(48000, 4 * 48000, {24000, 96000, 168000});
  ASSERT_TRUE(write_wav(dir.file("in.wav"), clicks));
  const std::string path = dir.file(GetParam().name);
  int status = -1;
  test::run(
      "ffmpeg -v error -i " + dir.file("in.wav") + " " + GetParam().options + " " + path + " 2>&1",
      &status);
  if (status != 0) GTEST_SKIP() << "this ffmpeg cannot make " << GetParam().name;
  for (const int rate : {16000, 0}) {
    const Result<Pcm> pcm = read_audio(path, {.sample_rate = rate});
    ASSERT_TRUE(pcm) << pcm.error().describe();
    EXPECT_EQ(pcm->sample_rate, rate != 0 ? rate : GetParam().sample_rate);
    EXPECT_EQ(pcm->samples.size(), std::size_t(4 * pcm->sample_rate));
    for (const double seconds : {0.5, 2.0, 3.5}) {
      const double at = seconds * pcm->sample_rate;
      EXPECT_NEAR(double(test::find_click(*pcm, std::int64_t(at), 2000)), at, 1.0) << seconds;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, ReadAudio,
    testing::Values(Encoding{"a.wav", "-c:a pcm_s24le"}, Encoding{"b.wav", "-c:a pcm_u8"},
                    Encoding{"stereo.wav", "-ac 2"}, Encoding{"a.mp3", "-c:a libmp3lame"},
                    Encoding{"low.mp3", "-c:a libmp3lame -ar 22050", 22050},
                    Encoding{"a.ogg", "-c:a libvorbis"}, Encoding{"a.opus", "-c:a libopus"},
                    Encoding{"a.flac", ""}, Encoding{"a.m4a", "-c:a aac"},
                    Encoding{"b.m4a", "-c:a aac -ar 44100", 44100}, Encoding{"a.mka", "-c:a flac"},
                    Encoding{"a.aiff", ""}, Encoding{"a.caf", "-c:a alac"}));

TEST(ReadAudioErrors, NameTheReason) {
  const Result<Pcm> missing = read_audio("/no/such/file.wav");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::not_found);
  EXPECT_EQ(missing.error().where.file, "/no/such/file.wav");
  const std::string video = (test::data_dir() / "containers" / "mpeg4_video.mp4").string();
  const Result<Pcm> silent = read_audio(video);
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().code, Code::not_found);
  EXPECT_THAT(silent.error().message, testing::HasSubstr("no audio track"));
  const Result<Pcm> junk = read_audio(Bytes(1000, 0x5A));
  ASSERT_FALSE(junk);
  EXPECT_EQ(junk.error().code, Code::syntax);
  const Result<Pcm> nothing = read_audio(Bytes{});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Code::truncated);
  EXPECT_EQ(read_audio(video, {.sample_rate = -1}).error().code, Code::invalid_argument);
  EXPECT_EQ(read_audio(video, {.max_seconds = NAN}).error().code, Code::invalid_argument);
}

TEST(ReadAudioErrors, TooLong) {
  const test::TempDir dir;
  ASSERT_TRUE(write_wav(dir.file("a.wav"), test::make_clicks(8000, 16000, {100})));
  EXPECT_TRUE(read_audio(dir.file("a.wav"), {.max_seconds = 2}));
  const Result<Pcm> longer = read_audio(dir.file("a.wav"), {.max_seconds = 1.9});
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().code, Code::out_of_range);
  EXPECT_THAT(longer.error().message, testing::HasSubstr("longer than the limit"));
}

TEST(ReadAudioErrors, AbsurdSampleRate) {
  const test::TempDir dir;
  ASSERT_TRUE(write_wav(dir.file("a.wav"), test::make_clicks(8000, 16000, {100})));
  Bytes file = test::read_bytes(dir.file("a.wav"));
  for (const Bytes& rate : {Bytes{0xFF, 0xFF, 0xFF, 0x7F}, Bytes{1, 0, 0, 0}, Bytes{0, 0, 0, 0}}) {
    std::copy(rate.begin(), rate.end(), file.begin() + 24);
    EXPECT_FALSE(read_audio(file)) << int(rate[0]);
  }
}

TEST(ReadAudio, TruncatedWavGivesWhatIsThere) {
  const test::TempDir dir;
  const Pcm pcm = test::make_clicks(8000, 16000, {100});
  ASSERT_TRUE(write_wav(dir.file("a.wav"), pcm));
  Bytes file = test::read_bytes(dir.file("a.wav"));
  file.resize(44 + 2 * 5000);
  const Result<Pcm> part = read_audio(file);
  ASSERT_TRUE(part) << part.error().describe();
  EXPECT_EQ(part->samples.size(), 5000u);
}

// Its edit list hides the AAC priming, but no packet says so.
TEST(ReadAudio, FragmentedMp4BeginsAtItsEditList) {
  const Result<Pcm> pcm = read_audio((test::data_dir() / "containers" / "frag_aac.mp4").string());
  ASSERT_TRUE(pcm) << pcm.error().describe();
  EXPECT_EQ(pcm->samples.size(), 480000u);
  for (const std::int64_t start : {24000, 240000, 456000}) {
    EXPECT_NEAR(double(test::find_click(*pcm, start, 3000)), double(start), 1.0);
  }
}

TEST(ReadAudio, AGapInTheTimeStampsBecomesSilence) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const test::TempDir dir;
  const Pcm clicks = test::make_clicks(48000, 4 * 48000, {24000, 168000});
  ASSERT_TRUE(write_wav(dir.file("in.wav"), clicks));
  // The middle second is dropped; time stamps keep their places.
  test::run("ffmpeg -v error -i " + dir.file("in.wav") +
            " -af \"aselect='not(between(t,1,2))'\" -c:a flac " + dir.file("a.mka"));
  const Result<Pcm> pcm = read_audio(dir.file("a.mka"));
  ASSERT_TRUE(pcm) << pcm.error().describe();
  EXPECT_NEAR(pcm->duration(), 4.0, 0.002);
  EXPECT_NEAR(double(test::find_click(*pcm, 24000, 2000)), 24000, 1);
  EXPECT_NEAR(double(test::find_click(*pcm, 168000, 2000)), 168000, 96);
}

TEST(ReadAudio, NoOtherFileIsOpened) {
  const test::TempDir dir;
  ASSERT_TRUE(write_wav(dir.file("a.wav"), test::make_clicks(8000, 16000, {100})));
  const std::string list = "ffconcat version 1.0\nfile a.wav\n";
  test::write_bytes(dir.file("list.ffconcat"), Bytes(list.begin(), list.end()));
  EXPECT_FALSE(read_audio(dir.file("list.ffconcat")));
  const std::string hls =
      "#EXTM3U\n#EXT-X-TARGETDURATION:2\n#EXTINF:2,\n" + dir.file("a.wav") + "\n#EXT-X-ENDLIST\n";
  test::write_bytes(dir.file("list.m3u8"), Bytes(hls.begin(), hls.end()));
  EXPECT_FALSE(read_audio(dir.file("list.m3u8")));
  EXPECT_FALSE(read_audio("http://127.0.0.1:9/a.wav"));
  EXPECT_FALSE(read_audio("concat:" + dir.file("a.wav")));
}

}  // namespace audio_test
}  // namespace animeme::media

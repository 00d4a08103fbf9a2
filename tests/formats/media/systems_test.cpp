// The MPEG-4 Systems presentation: its bytes against those of tools/formats/media/containers.md,
// section 1.5, which another encoder made, and the file through independent readers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/mp4/systems_scene.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace systems_test {

using Bytes = std::vector<std::uint8_t>;

TEST(SystemsScene, IsTheOneOfTheSpecification) {
  EXPECT_EQ(scene_config(), (Bytes{0x10, 0x38, 0x0A, 0x00, 0x07, 0x80}));
  EXPECT_EQ(scene_unit(true), (Bytes{0xC0, 0x05, 0xA1, 0xD0, 0x0D, 0x00, 0x24, 0x05, 0x39, 0x38,
                                     0x86, 0x05, 0x41, 0x4F, 0x00}));
  EXPECT_EQ(object_unit(true), (Bytes{0x01, 0x10, 0x11, 0x06, 0x02, 0x9F, 0x0F, 0x02, 0x00, 0x01,
                                      0x11, 0x06, 0x05, 0x1F, 0x0F, 0x02, 0x00, 0x02}));
  EXPECT_EQ(initial_object_descriptor(0x29, 0x61),
            (Bytes{0x10, 0x13, 0x00, 0x4F, 0xFE, 0xFE, 0x29, 0x61, 0xFE, 0x0E, 0x04,
                   0x00, 0x00, 0x00, 0x01, 0x0E, 0x04, 0x00, 0x00, 0x00, 0x02}));
}

TEST(SystemsScene, ProfileOfTheSound) {
  EXPECT_EQ(audio_profile(nullptr), 0xFFu);
  const auto profile = [](int rate, int channels, unsigned object_type = 2,
                          AudioCodec codec = AudioCodec::aac) {
    const AudioFormat format{codec, rate, channels,
                             1024,  1024, {std::uint8_t(object_type << 3), 0x88}};
    return audio_profile(&format);
  };
  EXPECT_EQ(profile(48000, 1), 0x29u);
  EXPECT_EQ(profile(44100, 2), 0x29u);
  EXPECT_EQ(profile(96000, 2), 0x2Bu);
  EXPECT_EQ(profile(48000, 5), 0x2Au);
  EXPECT_EQ(profile(88200, 4), 0x2Bu);
  EXPECT_EQ(profile(48000, 6), 0x50u);
  EXPECT_EQ(profile(96000, 8), 0x51u);
  EXPECT_EQ(profile(48000, 2, 5), 0xFEu) << "HE-AAC";
  EXPECT_EQ(profile(48000, 2, 2, AudioCodec::opus), 0xFEu);
}

// Both writers say the same of sound of more than two channels.
TEST(SystemsScene, CopiedSoundOfManyChannelsIsOfLevel4) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(50);
  auto sound = encode_audio(test::make_clicks(48000, 2 * 48000, {24037}));
  ASSERT_TRUE(sound);
  sound->format.channels = 5;
  for (const bool systems : {false, true}) {
    const MuxInput input{.face = &face, .encoded = &*sound};
    ASSERT_TRUE(write_container(dir.file("a.mp4"), input, {.systems = systems}));
    const Bytes iods = test::find_box(test::read_bytes(dir.file("a.mp4")), "moov/iods");
    ASSERT_GE(iods.size(), 14u);
    const std::size_t begin = iods[5] >= 0x80 ? 9 : 6;  // behind tag and length
    EXPECT_EQ(iods[begin + 4], 0x2A) << systems;
  }
}

TEST(SystemsScene, WithoutSoundHasOnlyTheFace) {
  // The same bits up to the end of the face, then the ends of children, routes and commands.
  EXPECT_EQ(scene_unit(false), (Bytes{0xC0, 0x05, 0xA1, 0xD0, 0x0D, 0x00, 0x24, 0x05, 0x3C}));
  EXPECT_EQ(object_unit(false),
            (Bytes{0x01, 0x08, 0x11, 0x06, 0x02, 0x9F, 0x0F, 0x02, 0x00, 0x01}));
}

TEST(SystemsScene, DescriptorOfTheFaceTrack) {
  const StreamDescription stream{0x20, 4, 64, 4000, 2488, test::kFaceConfig};
  EXPECT_EQ(elementary_stream_descriptor(stream),
            (Bytes{0x03, 0x80, 0x80, 0x80, 0x2B, 0x00, 0x00, 0x00, 0x04, 0x80, 0x80, 0x80,
                   0x1D, 0x20, 0x11, 0x00, 0x00, 0x40, 0x00, 0x00, 0x0F, 0xA0, 0x00, 0x00,
                   0x09, 0xB8, 0x05, 0x80, 0x80, 0x80, 0x0B, 0x00, 0x00, 0x01, 0xB0, 0x61,
                   0x00, 0x00, 0x01, 0xB5, 0x89, 0x47, 0x06, 0x80, 0x80, 0x80, 0x01, 0x02}));
}

class Systems : public testing::Test {
 protected:
  std::string write(const fba::AccessUnits& face, const Pcm* sound) {
    const std::string path = dir_.file("talk.mp4");
    MuxOptions options;
    options.systems = true;
    const auto written = write_container(path, {.face = &face, .audio = sound}, options);
    EXPECT_TRUE(written) << written.error().describe();
    return path;
  }
  test::TempDir dir_;
};

TEST_F(Systems, ChunksAreShared) {
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(48000, 4 * 48000, {24037});
  const Bytes file = test::read_bytes(write(face, &sound));
  // The tracks of scene and objects have one chunk each; the third table is that of the face.
  std::vector<std::size_t> counts;
  const std::string text(file.begin(), file.end());
  for (auto at = text.find("stco"); at != text.npos; at = text.find("stco", at + 1)) {
    counts.push_back(file[at + 11]);
  }
  ASSERT_EQ(counts.size(), 4u);
  EXPECT_EQ(counts[0], 1u);
  EXPECT_EQ(counts[1], 1u);
  EXPECT_EQ(counts[2], 4u) << "a chunk a second";
  EXPECT_LE(counts[3], 5u);
}

TEST_F(Systems, FaceComesBackByteForByteAndInTime) {
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(48000, 4 * 48000, {24037, 96011});
  const std::string path = write(face, &sound);
  const auto back = read_container(path);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face.config, face.config);
  EXPECT_EQ(back->face.timescale, face.timescale);
  ASSERT_EQ(back->face.units.size(), face.units.size());
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    EXPECT_EQ(back->face.units[i].bytes, face.units[i].bytes);
    EXPECT_EQ(back->face.units[i].time, face.units[i].time);
    EXPECT_EQ(back->face.units[i].duration, face.units[i].duration);
    EXPECT_EQ(back->face.units[i].intra, face.units[i].intra);
  }
  const auto decoded = read_audio(path);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_EQ(decoded->samples.size(), sound.samples.size());
  for (const std::int64_t start : {24037, 96011})
    EXPECT_NEAR(double(test::find_click(*decoded, start, 3000)), double(start), 1.01);
}

TEST_F(Systems, GapsAndALateStartKeepTheirTimes) {
  fba::AccessUnits face = test::make_face(20);
  for (std::size_t i = 0; i < face.units.size(); ++i)
    face.units[i].time += 3000 + (i > 9 ? 5000 : 0);
  const Pcm sound = test::make_clicks(44100, 2 * 44100, {1000});
  const auto back = read_container(write(face, &sound));
  ASSERT_TRUE(back) << back.error().describe();
  for (std::size_t i = 0; i < face.units.size(); ++i)
    EXPECT_NEAR(double(back->face.units[i].time), double(face.units[i].time), 1);
}

TEST_F(Systems, WithoutSound) {
  const fba::AccessUnits face = test::make_face(30);
  const auto back = read_container(write(face, nullptr));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face.units.size(), 30u);
  EXPECT_FALSE(back->audio);
}

TEST_F(Systems, RefusesWhatItCannotBe) {
  const fba::AccessUnits face = test::make_face(3);
  const Pcm sound = test::make_clicks(48000, 4800, {});
  MuxOptions options;
  options.systems = true;
  EXPECT_EQ(write_container(dir_.file("a.mkv"), {.face = &face}, options).error().code,
            Code::unsupported);
  EXPECT_EQ(write_container(dir_.file("a.mp4"), {.audio = &sound}, options).error().code,
            Code::unsupported);
  EXPECT_EQ(dir_.count(), 0u);
}

TEST_F(Systems, FfprobeSeesFourTracks) {
  if (!test::has_program("ffprobe")) GTEST_SKIP() << "ffprobe is not installed";
  const fba::AccessUnits face = test::make_face(50);
  const Pcm sound = test::make_clicks(48000, 2 * 48000, {5000});
  const std::string path = write(face, &sound);
  const std::string said = test::run(
      "ffprobe -v error -show_entries stream=codec_tag_string,profile -of csv=p=0 '" + path + "'");
  EXPECT_THAT(said, testing::HasSubstr("Simple Face Animation Profile,mp4v"));
  EXPECT_THAT(said, testing::HasSubstr("LC,mp4a"));
}

}  // namespace systems_test
}  // namespace animeme::media

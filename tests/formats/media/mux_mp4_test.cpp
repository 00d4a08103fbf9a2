// The primary mp4: what is written, byte by byte where tools/formats/media/containers.md gives
// them, and that it comes back.
#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace mux_mp4_test {

using test::Bytes;

const std::string kSampleTable = "moov/trak/mdia/minf/stbl/";

class MuxMp4 : public testing::Test {
 protected:
  void write(const MuxOptions& options = {}) {
    const MuxInput input{.face = &face_, .audio = &sound_};
    const Result<MuxResult> written = write_mp4(path_, input, options);
    ASSERT_TRUE(written) << written.error().describe();
  }

  test::TempDir dir_;
  std::string path_ = dir_.file("talk.mp4");
  fba::AccessUnits face_ = test::make_face(100);
  Pcm sound_ = test::make_clicks(48000, 4 * 48000, {24000, 96000});
};

TEST_F(MuxMp4, RoundTripIsExact) {
  write();
  const Result<Container> back = read_container(path_);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face, face_);
  EXPECT_EQ(back->format, "mp4");
  EXPECT_EQ(back->visual_profile, 0x61);
  EXPECT_THAT(back->warnings, testing::IsEmpty());
  ASSERT_TRUE(back->audio);
  EXPECT_EQ(back->audio->codec, "aac");
  EXPECT_EQ(back->audio->sample_rate, 48000);
  EXPECT_EQ(back->audio->channels, 1);
  EXPECT_DOUBLE_EQ(back->audio->duration, 4.0);
}

TEST_F(MuxMp4, RoundTripFromMemoryIsTheSame) {
  write();
  const Result<Container> back = read_container(test::read_bytes(path_));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face, face_);
}

struct Clock {
  std::uint32_t timescale;
  std::int64_t duration;
};

class MuxMp4Clock : public testing::TestWithParam<Clock> {};

TEST_P(MuxMp4Clock, TimesSurviveExactly) {
  const test::TempDir dir;
  const auto [timescale, duration] = GetParam();
  const fba::AccessUnits face = test::make_face(60, timescale, duration, 20);
  const Pcm sound = test::make_clicks(44100, 44100, {22050});
  const Result<MuxResult> written = write_mp4(dir.file("a.mp4"), {.face = &face, .audio = &sound});
  ASSERT_TRUE(written) << written.error().describe();
  const Result<Container> back = read_container(dir.file("a.mp4"));
  ASSERT_TRUE(back) << back.error().describe();
  ASSERT_EQ(back->face.units.size(), face.units.size());
  ASSERT_GE(back->face.timescale, 10000u);
  ASSERT_EQ(back->face.timescale % timescale, 0u);
  const std::int64_t factor = back->face.timescale / timescale;
  EXPECT_EQ(factor, timescale >= 10000 ? 1 : (10000 + timescale - 1) / timescale);
  for (std::size_t i = 0; i < face.units.size(); ++i) {
    EXPECT_EQ(back->face.units[i].time, face.units[i].time * factor);
    EXPECT_EQ(back->face.units[i].duration, face.units[i].duration * factor);
    EXPECT_EQ(back->face.units[i].bytes, face.units[i].bytes);
    EXPECT_EQ(back->face.units[i].intra, face.units[i].intra);
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, MuxMp4Clock,
                         testing::Values(Clock{25000, 1000}, Clock{30000, 1001}, Clock{12500, 1000},
                                         Clock{479000, 16000}, Clock{90000, 3600}, Clock{25, 1},
                                         Clock{9000, 1000}, Clock{1000, 1001}));

TEST_F(MuxMp4, SkippedFramesAndALateStartKeepTheirTimes) {
  face_.units[3].duration = 3000;
  for (std::size_t i = 4; i < face_.units.size(); ++i) face_.units[i].time += 2000;
  for (fba::AccessUnit& unit : face_.units) unit.time += 5000;
  write();
  const Result<Container> back = read_container(path_);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(back->face, face_);
}

TEST_F(MuxMp4, EsdsHasTheBytesOfTheSpecification) {
  face_.units[0].bytes.resize(1000, 0x55);
  write();
  Bytes esds = test::find_box(test::read_bytes(path_), kSampleTable + "stsd/mp4s/esds");
  ASSERT_EQ(esds.size(), 0x3Cu - 8);
  // bufferSizeDB, maxBitrate and avgBitrate depend on the data.
  EXPECT_EQ(Bytes(esds.begin() + 19, esds.begin() + 22), (Bytes{0, 0x03, 0xE8}));
  std::uint32_t peak = 0;
  std::uint32_t average = 0;
  for (std::size_t i = 22; i < 26; ++i) peak = peak << 8 | esds[i];
  for (std::size_t i = 26; i < 30; ++i) average = average << 8 | esds[i];
  std::size_t total = 0;
  std::size_t first_second = 0;
  for (std::size_t i = 0; i < face_.units.size(); ++i) {
    total += face_.units[i].bytes.size();
    if (i < 25) first_second += face_.units[i].bytes.size();
  }
  EXPECT_EQ(peak, first_second * 8);
  EXPECT_NEAR(average, double(total) * 8 / 4, 1.0);
  std::fill(esds.begin() + 19, esds.begin() + 30, std::uint8_t(0));
  const Bytes expected = {
      0,    0,    0,    0,                                            // version, flags
      0x03, 0x80, 0x80, 0x80, 0x2B, 0,    0,    0,                    // ES_ID 0
      0x04, 0x80, 0x80, 0x80, 0x1D, 0x20, 0x11,                       // object type, stream type
      0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,  // sizes and rates
      0x05, 0x80, 0x80, 0x80, 0x0B, 0,    0,    1,    0xB0, 0x61, 0,
      0,    1,    0xB5, 0x89, 0x47, 0x06, 0x80, 0x80, 0x80, 0x01, 0x02};
  EXPECT_EQ(esds, expected);
}

TEST_F(MuxMp4, EsIdIsZeroInTheSoundTrackToo) {
  write();
  const Bytes esds = test::find_box(test::read_bytes(path_), kSampleTable + "stsd/mp4a/esds");
  ASSERT_GT(esds.size(), 12u);
  EXPECT_EQ(Bytes(esds.begin() + 4, esds.begin() + 11),
            (Bytes{3, 0x80, 0x80, 0x80, esds[8], 0, 0}));
}

TEST_F(MuxMp4, IodsHasTheBytesOfTheSpecification) {
  write();
  EXPECT_EQ(test::find_box(test::read_bytes(path_), "moov/iods"),
            (Bytes{0,    0,    0,    0,    0x10, 0x80, 0x80, 0x80, 25,
                   0,    0x4F, 0xFF, 0xFF, 0x29, 0x61, 0xFF,           // profiles
                   0x0E, 0x80, 0x80, 0x80, 4,    0,    0,    0,    1,  // ES_ID_Inc: tracks
                   0x0E, 0x80, 0x80, 0x80, 4,    0,    0,    0,    2}));
}

TEST_F(MuxMp4, IodsListsOnlyTracksWithAnEsDescriptor) {
  write({.audio = {.codec = AudioCodec::opus}});
  const Bytes iods = test::find_box(test::read_bytes(path_), "moov/iods");
  EXPECT_EQ(iods[8], 16) << "profiles and one track";
  EXPECT_EQ(iods[13], 0xFE) << "Opus is no MPEG-4 audio";
}

TEST_F(MuxMp4, IodsTakesTheProfileThatIsGiven) {
  face_.config[4] = 0x62;
  write();
  EXPECT_EQ(test::find_box(test::read_bytes(path_), "moov/iods")[14], 0x62) << "from the config";
  const MuxInput input{.face = &face_, .visual_profile = 0x64};
  ASSERT_TRUE(write_mp4(path_, input));
  const Bytes iods = test::find_box(test::read_bytes(path_), "moov/iods");
  EXPECT_EQ(iods[14], 0x64);
  EXPECT_EQ(iods[13], 0xFF) << "no sound: no audio profile required";
}

TEST_F(MuxMp4, SyncTableNamesTheIntraPlanes) {
  write();
  EXPECT_EQ(test::find_box(test::read_bytes(path_), kSampleTable + "stss"),
            (Bytes{0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 51}));
}

TEST_F(MuxMp4, ChunksAreShared) {
  write();
  const Bytes file = test::read_bytes(path_);
  const Bytes offsets = test::find_box(file, kSampleTable + "stco");
  ASSERT_GE(offsets.size(), 8u);
  EXPECT_EQ(offsets.size(), 8u + 4 * offsets[7]);
  EXPECT_LE(offsets[7], 5) << "4 s, a chunk a second, not one a plane";
  EXPECT_GE(offsets[7], 3) << "but the sound is never far";
}

TEST_F(MuxMp4, BrandsAndContentsFirst) {
  write();
  const Bytes file = test::read_bytes(path_);
  const Bytes ftyp = test::find_box(file, "ftyp");
  EXPECT_EQ(std::string(ftyp.begin(), ftyp.begin() + 4), "mp42");
  EXPECT_EQ(std::string(ftyp.begin() + 8, ftyp.begin() + 16), "mp42iso2");
  const std::string text(file.begin(), file.end());
  EXPECT_LT(text.find("moov"), text.find("mdat"));
  EXPECT_EQ(text.find("Lavf"), std::string::npos) << "a version string would change the bytes";
  EXPECT_EQ(text.find("Lavc"), std::string::npos);
  write({.faststart = false});
  const Bytes other = test::read_bytes(path_);
  const std::string tail(other.begin(), other.end());
  EXPECT_GT(tail.find("moov"), tail.find("mdat"));
  EXPECT_EQ(test::find_box(other, kSampleTable + "stsd/mp4s/esds")[10], 0) << "ES_ID";
}

TEST_F(MuxMp4, SameInputGivesSameBytes) {
  write();
  const Bytes first = test::read_bytes(path_);
  path_ = dir_.file("another-name.mp4");
  write();
  EXPECT_EQ(test::read_bytes(path_), first);
}

TEST_F(MuxMp4, ProgressRisesToOne) {
  std::vector<double> seen;
  write({.progress = [&](double done) { seen.push_back(done); }});
  ASSERT_GE(seen.size(), 3u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_GE(seen.front(), 0.0);
  EXPECT_DOUBLE_EQ(seen.back(), 1.0);
}

TEST_F(MuxMp4, FaceAloneAndSoundAlone) {
  ASSERT_TRUE(write_mp4(path_, {.face = &face_}));
  const Result<Container> face_only = read_container(path_);
  ASSERT_TRUE(face_only) << face_only.error().describe();
  EXPECT_EQ(face_only->face, face_);
  EXPECT_FALSE(face_only->audio);
  ASSERT_TRUE(write_mp4(path_, {.audio = &sound_}));
  const Result<Container> sound_only = read_container(path_);
  ASSERT_FALSE(sound_only);
  EXPECT_EQ(sound_only.error().code, Code::not_found);
  EXPECT_THAT(sound_only.error().message, testing::HasSubstr("audio aac"));
  const Result<ContainerInfo> info = probe(path_);
  ASSERT_TRUE(info);
  ASSERT_NE(info->first(TrackKind::audio), nullptr);
  EXPECT_DOUBLE_EQ(info->duration, 4.0);
}

TEST_F(MuxMp4, FaceIsMetadataOrVideo) {
  for (const FaceTrackType type : {FaceTrackType::metadata, FaceTrackType::video}) {
    const bool metadata = type == FaceTrackType::metadata;
    for (const bool fragmented : {false, true}) {
      for (const bool faststart : {false, true}) {
        MuxOptions options;
        options.face_track = type;
        options.fragmented = fragmented;
        options.faststart = faststart;
        write(options);
        SCOPED_TRACE(testing::Message() << metadata << fragmented << faststart);
        const Bytes file = test::read_bytes(path_);
        const Bytes handler = test::find_box(file, "moov/trak/mdia/hdlr");
        ASSERT_GE(handler.size(), 12u);
        EXPECT_EQ(std::string(handler.begin() + 8, handler.begin() + 12),
                  metadata ? "meta" : "vide");
        const std::string media = "moov/trak/mdia/minf/";
        EXPECT_EQ(test::find_box(file, media + "nmhd").empty(), !metadata);
        EXPECT_EQ(test::find_box(file, media + "vmhd").empty(), metadata);
        EXPECT_EQ(test::find_box(file, kSampleTable + "stsd/mp4s/esds").empty(), !metadata);
        EXPECT_EQ(test::find_box(file, kSampleTable + "stsd/mp4v/esds").empty(), metadata);
        const Result<Container> back = read_container(path_);
        ASSERT_TRUE(back) << back.error().describe();
        EXPECT_EQ(back->face, face_);
        EXPECT_EQ(back->visual_profile, 0x61);
        EXPECT_THAT(back->warnings, testing::IsEmpty());
        const Result<ContainerInfo> info = probe(path_);
        ASSERT_TRUE(info) << info.error().describe();
        ASSERT_EQ(info->tracks.size(), 2u);
        EXPECT_EQ(info->tracks[0].kind, TrackKind::face);
        EXPECT_EQ(info->tracks[0].face_config, face_.config);
        EXPECT_EQ(info->tracks[0].visual_profile, 0x61);
      }
    }
  }
}

// What is broken in the descriptors of a metadata face costs its configuration at most.
TEST_F(MuxMp4, BrokenDescriptorsOfMetadataAreNoFace) {
  write();
  const Bytes file = test::read_bytes(path_);
  const std::string text(file.begin(), file.end());
  const std::size_t esds = text.find("esds");
  ASSERT_NE(esds, std::string::npos);
  for (std::size_t at = esds - 4; at < esds + 60; ++at) {
    for (const int value : {0, 1, 0x7F, 0x80, 0xFF}) {
      Bytes broken = file;
      broken[at] = std::uint8_t(value);
      const Result<Container> back = read_container(broken);
      if (!back) continue;
      EXPECT_EQ(back->face.units.size(), face_.units.size()) << at << " " << value;
    }
  }
}

TEST_F(MuxMp4, FfmpegConvertsTheSoundAndLeavesTheFace) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  for (const bool fragmented : {false, true}) {
    MuxOptions options;
    options.fragmented = fragmented;
    write(options);
    for (const char* conversion : {"-c:a libopus -b:a 40k out.webm", "-c copy out.mkv",
                                   "-c copy out.mp4", "-c copy out.mov", "out.wav"}) {
      int status = -1;
      const std::string said =
          test::run("cd '" + dir_.path().string() + "' && ffmpeg -nostdin -y -v warning -i '" +
                        path_ + "' " + conversion + " 2>&1",
                    &status);
      EXPECT_EQ(status, 0) << conversion;
      EXPECT_EQ(said, "") << conversion;
    }
  }
}

TEST_F(MuxMp4, FfprobeSeesTheSame) {
  if (!test::has_program("ffprobe")) GTEST_SKIP() << "ffprobe is not installed";
  write();
  EXPECT_EQ(test::run("ffprobe -v error -show_entries stream=codec_type,codec_tag_string -of "
                      "csv=p=0 " +
                      path_ + " 2>&1"),
            "data,mp4s\naudio,mp4a\n");
  MuxOptions video;
  video.face_track = FaceTrackType::video;
  write(video);
  const std::string streams =
      test::run("ffprobe -v quiet -show_entries stream=codec_name,profile -of csv=p=0 " + path_);
  EXPECT_EQ(streams, "mpeg4,Simple Face Animation Profile\naac,LC\n");
  const std::string packets = test::run(
      "ffprobe -v quiet -select_streams v -show_data_hash crc32 -show_entries "
      "packet=pts,duration,flags,data_hash -of csv=p=0 " +
      path_);
  std::string expected;
  for (const fba::AccessUnit& unit : face_.units) {
    std::array<char, 128> line{};
    std::snprintf(line.data(), line.size(), "%lld,%lld,%s,CRC32:%08x\n", (long long)unit.time,
                  (long long)unit.duration, unit.intra ? "K_" : "__",
                  unsigned(test::crc32(unit.bytes)));
    expected += line.data();
  }
  EXPECT_EQ(packets, expected);
}

}  // namespace mux_mp4_test
}  // namespace animeme::media

// Faces from other people's files, and files that must not be taken for one.
#include "tools/formats/media/container.h"

#include <gmock/gmock.h>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace read_container_test {

using test::Bytes;

std::string sample(const std::string& name) {
  return (test::data_dir() / "containers" / name).string();
}

struct Plane {
  Bytes bytes;
  bool intra = false;
  friend bool operator==(const Plane&, const Plane&) = default;
};

// The access units of all samples, from the length-prefixed file.
std::vector<Plane> reference_planes() {
  const Bytes file = test::read_bytes(sample("fba.aus"));
  std::vector<Plane> planes;
  for (std::size_t at = 0; at + 5 <= file.size();) {
    const std::size_t size = std::size_t(file[at]) << 24 | std::size_t(file[at + 1]) << 16 |
                             std::size_t(file[at + 2]) << 8 | file[at + 3];
    const auto begin = file.begin() + std::ptrdiff_t(at) + 5;
    planes.push_back({Bytes(begin, begin + std::ptrdiff_t(size)), file[at + 4] != 0});
    at += 5 + size;
  }
  return planes;
}

std::vector<Plane> planes_of(const fba::AccessUnits& face) {
  std::vector<Plane> planes;
  for (const fba::AccessUnit& unit : face.units) planes.push_back({unit.bytes, unit.intra});
  return planes;
}

struct Sample {
  const char* name;
  const char* format;
  std::uint32_t timescale;
  std::int64_t first;
  std::int64_t step;
};

void expect_sample(const std::string& path, const Sample& want) {
  const Result<Container> talk = read_container(path);
  ASSERT_TRUE(talk) << talk.error().describe();
  EXPECT_EQ(talk->format, want.format);
  EXPECT_EQ(talk->face.timescale, want.timescale);
  EXPECT_EQ(planes_of(talk->face), reference_planes());
  ASSERT_EQ(talk->face.units.size(), 250u);
  for (std::size_t i = 0; i < talk->face.units.size(); ++i) {
    EXPECT_EQ(talk->face.units[i].time, want.first + std::int64_t(i) * want.step) << i;
    EXPECT_EQ(talk->face.units[i].duration, want.step) << i;
  }
  EXPECT_EQ(talk->face.config, test::kFaceConfig);
}

TEST(ReadContainer, SamplesAreReadByteForByte) {
  ASSERT_EQ(reference_planes().size(), 250u);
  for (const Sample& want :
       {Sample{"std_aac.mp4", "mp4", 25000, 0, 1000}, Sample{"frag_aac.mp4", "mp4", 25000, 0, 1000},
        Sample{"iso_reference_fba_only.mp4", "mp4", 25000, 0, 1000},
        Sample{"fba_aac.mkv", "matroska", 1000, 21, 40}}) {
    SCOPED_TRACE(want.name);
    expect_sample(sample(want.name), want);
    EXPECT_THAT(read_container(sample(want.name))->warnings, testing::IsEmpty());
  }
}

TEST(ReadContainer, FurtherSamples) {
  for (const Sample& want : {Sample{"std_opus.mp4", "mp4", 25000, 0, 1000},
                             Sample{"preview_h264_aac_fba.mp4", "mp4", 25000, 0, 1000},
                             Sample{"systems_bifs_od.mp4", "mp4", 25000, 0, 1000},
                             Sample{"systems_by_gpac.mp4", "mp4", 25000, 0, 1000},
                             Sample{"fba_opus_delayfix.mkv", "matroska", 1000, 0, 40},
                             Sample{"fba_aac.nut", "nut", 50000, 1067, 2000}}) {
    SCOPED_TRACE(want.name);
    expect_sample(sample(want.name), want);
  }
  const test::TempDir dir;
  for (const char* name : {"fba_type10.ts", "fba_private06.ts"}) {
    SCOPED_TRACE(name);
    int status = -1;
    test::run("gzip -dc '" + sample(name) + ".gz' > " + dir.file(name), &status);
    ASSERT_EQ(status, 0) << "gzip is needed";
    expect_sample(dir.file(name), {name, "mpegts", 90000, 1920, 3600});
  }
}

void expect_refused(const std::string& path, Code code, const std::string& words) {
  const Result<Container> talk = read_container(path);
  ASSERT_FALSE(talk) << path;
  EXPECT_EQ(talk.error().code, code) << talk.error().describe();
  EXPECT_THAT(talk.error().message, testing::HasSubstr(words));
  EXPECT_EQ(talk.error().where.file, path);
}

TEST(ReadContainer, RefusalsNameTheReason) {
  expect_refused(sample("systems_bifsanim_layout.mp4"), Code::not_found, "MPEG-4 Systems stream");
  expect_refused(sample("mpeg4_video.mp4"), Code::not_found, "video mpeg4");
  expect_refused(sample("mpeg4_video.ts"), Code::not_found, "no face");
  expect_refused(sample("fba.aus"), Code::syntax, "not a media file");
  expect_refused(sample("no such file"), Code::not_found, "cannot be opened");
  expect_refused(test::data_dir().string(), Code::io, "cannot be opened");
  const test::TempDir dir;
  test::write_bytes(dir.file("empty.mp4"), {});
  expect_refused(dir.file("empty.mp4"), Code::truncated, "empty");
  Bytes raw = test::kFaceConfig;
  const fba::AccessUnits face = test::make_face(5);
  for (const fba::AccessUnit& unit : face.units) {
    raw.insert(raw.end(), unit.bytes.begin(), unit.bytes.end());
  }
  test::write_bytes(dir.file("raw.mp4"), raw);
  expect_refused(dir.file("raw.mp4"), Code::unsupported, "raw FBA stream");
  ASSERT_TRUE(write_wav(dir.file("sound.mp4"), test::make_clicks(8000, 8000, {100})));
  expect_refused(dir.file("sound.mp4"), Code::unsupported, "cannot carry a face");
}

TEST(ReadContainer, LimitsHold) {
  EXPECT_TRUE(read_container(sample("std_aac.mp4"), {.max_units = 250}));
  const Result<Container> many = read_container(sample("std_aac.mp4"), {.max_units = 249});
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().code, Code::out_of_range);
  const Result<Container> large = read_container(sample("std_aac.mp4"), {.max_bytes = 4000});
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Code::out_of_range);
}

TEST(ReadContainer, TruncatedFileGivesItsBeginWithAWarning) {
  Bytes file = test::read_bytes(sample("iso_reference_fba_only.mp4"));
  const std::vector<Plane> all = reference_planes();
  file.resize(file.size() / 2);  // contents are at the begin of this one or nothing is readable
  const Result<Container> talk = read_container(file);
  if (talk) {
    EXPECT_LT(talk->face.units.size(), 250u);
    EXPECT_THAT(talk->warnings, testing::Not(testing::IsEmpty()));
  }
  Bytes moov_first = test::read_bytes(sample("std_aac.mp4"));
  moov_first.resize(moov_first.size() * 2 / 3);
  const Result<Container> begin = read_container(moov_first);
  ASSERT_TRUE(begin) << begin.error().describe();
  const std::size_t count = begin->face.units.size();
  ASSERT_GT(count, 50u);
  ASSERT_LT(count, 250u);
  EXPECT_EQ(planes_of(begin->face), std::vector<Plane>(all.begin(), all.begin() + int(count)));
  EXPECT_THAT(begin->warnings, testing::Contains(testing::HasSubstr("ends early")));
}

TEST(ReadContainer, ADamagedPlaneIsLeftOutUpToTheNextIntraPlane) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(30, 25000, 1000, 10);
  fba::AccessUnits broken = face;
  broken.units[13].bytes[0] = 0x55;  // no start code
  ASSERT_TRUE(write_mp4(dir.file("a.mp4"), {.face = &broken}));
  const Result<Container> back = read_container(dir.file("a.mp4"));
  ASSERT_TRUE(back) << back.error().describe();
  ASSERT_EQ(back->face.units.size(), 23u);
  EXPECT_EQ(back->face.units[12].time, 12000);
  EXPECT_EQ(back->face.units[12].duration, 8000) << "the gap stays a gap";
  EXPECT_EQ(back->face.units[13], face.units[20]);
  EXPECT_THAT(back->warnings, testing::ElementsAre(testing::HasSubstr("7 planes")));
}

TEST(ReadContainer, NoIntraPlaneIsAnError) {
  const test::TempDir dir;
  fba::AccessUnits face = test::make_face(5);
  face.units[0].bytes[9] = 0x27;
  ASSERT_TRUE(write_mp4(dir.file("a.mp4"), {.face = &face}));
  const Result<Container> back = read_container(dir.file("a.mp4"));
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, Code::syntax);
  EXPECT_THAT(back.error().message, testing::HasSubstr("no readable intra plane"));
}

TEST(ReadContainer, MatroskaAndTransportStreamOfOurOwn) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100, 30000, 1001, 30);
  const Pcm sound = test::make_clicks(48000, 160000, {24000});
  for (const char* name : {"a.mkv", "a.ts"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(write_container(dir.file(name), {.face = &face, .audio = &sound}));
    const Result<Container> back = read_container(dir.file(name));
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(planes_of(back->face), planes_of(face));
    EXPECT_EQ(back->face.config, face.config) << "in band in TS";
    EXPECT_EQ(back->visual_profile, 0x61);
    const auto ticks = double(back->face.timescale);
    const double start = double(back->face.units[0].time) / ticks;
    EXPECT_NEAR(start, 1024.0 / 48000, 0.0006) << "the AAC priming";
    const Result<ContainerInfo> info = probe(dir.file(name));
    ASSERT_TRUE(info) << info.error().describe();
    EXPECT_NEAR(info->first(TrackKind::face)->start - info->first(TrackKind::audio)->start, start,
                0.0006);
    for (std::size_t i = 0; i < face.units.size(); ++i) {
      EXPECT_NEAR(double(back->face.units[i].time) / ticks - start, double(i) * 1001 / 30000,
                  0.00101);
    }
    ASSERT_TRUE(back->audio);
    EXPECT_EQ(back->audio->codec, "aac");
    EXPECT_THAT(back->warnings, testing::IsEmpty());
  }
}

TEST(ReadContainer, ACommonStartTimeIsTakenOff) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(48000, 192000, {24000});
  ASSERT_TRUE(write_container(dir.file("a.mp4"), {.face = &face, .audio = &sound}));
  int status = -1;
  test::run("ffmpeg -v quiet -i " + dir.file("a.mp4") + " -map 0 -c copy -output_ts_offset 7 " +
                dir.file("a.ts"),
            &status);
  ASSERT_EQ(status, 0);
  const Result<ContainerInfo> info = probe(dir.file("a.ts"));
  ASSERT_TRUE(info) << info.error().describe();
  ASSERT_GT(info->first(TrackKind::audio)->start, 7.0);
  const Result<Container> back = read_container(dir.file("a.ts"));
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(planes_of(back->face), planes_of(face));
  EXPECT_NEAR(double(back->face.units[0].time) / 90000, 1024.0 / 48000, 0.0001);
}

TEST(ReadContainer, FacesAloneInMatroskaAndTransportStream) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  for (const char* name : {"a.mkv", "a.ts"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(write_container(dir.file(name), {.face = &face}));
    const Result<Container> back = read_container(dir.file(name));
    ASSERT_TRUE(back) << back.error().describe();
    EXPECT_EQ(planes_of(back->face), planes_of(face));
    EXPECT_EQ(back->face.units[0].time, 0);
    EXPECT_FALSE(back->audio);
  }
}

TEST(ReadContainer, SameInputGivesSameBytesInEveryFormat) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  const Pcm sound = test::make_clicks(16000, 64000, {8000});
  for (const auto& [first, second] : {std::pair("a.mkv", "b.mkv"), std::pair("a.ts", "b.ts")}) {
    for (const char* name : {first, second}) {
      ASSERT_TRUE(write_container(dir.file(name), {.face = &face, .audio = &sound}));
    }
    EXPECT_EQ(test::read_bytes(dir.file(first)), test::read_bytes(dir.file(second)));
  }
}

TEST(Probe, NamesTheTracks) {
  const Result<ContainerInfo> info = probe(sample("std_aac.mp4"));
  ASSERT_TRUE(info) << info.error().describe();
  EXPECT_EQ(info->format, "mp4");
  EXPECT_EQ(info->bytes, 21252);
  EXPECT_DOUBLE_EQ(info->duration, 10.0);
  ASSERT_EQ(info->tracks.size(), 2u);
  const TrackInfo& face = info->tracks[0];
  EXPECT_EQ(face.kind, TrackKind::face);
  EXPECT_EQ(face.codec, "fba");
  EXPECT_EQ(face.tag, "mp4v");
  EXPECT_EQ(face.timescale, 25000u);
  EXPECT_EQ(face.samples, 250);
  EXPECT_DOUBLE_EQ(face.duration, 10.0);
  EXPECT_DOUBLE_EQ(face.frame_rate, 25.0);
  EXPECT_EQ(face.visual_profile, 0x61);
  EXPECT_EQ(face.face_config, test::kFaceConfig);
  const TrackInfo& sound = info->tracks[1];
  EXPECT_EQ(sound.kind, TrackKind::audio);
  EXPECT_EQ(sound.codec, "aac");
  EXPECT_EQ(sound.sample_rate, 48000);
  EXPECT_EQ(sound.channels, 1);
}

TEST(Probe, VideoIsVideoWhereverItComesFrom) {
  for (const char* name : {"mpeg4_video.mp4", "mpeg4_video.ts"}) {
    const Result<ContainerInfo> info = probe(sample(name));
    ASSERT_TRUE(info) << info.error().describe();
    ASSERT_EQ(info->tracks.size(), 1u) << name;
    EXPECT_EQ(info->tracks[0].kind, TrackKind::video) << name;
    EXPECT_EQ(info->tracks[0].codec, "mpeg4") << name;
  }
}

TEST(Probe, InBandFace) {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(100);
  ASSERT_TRUE(write_container(dir.file("a.ts"), {.face = &face}));
  const Result<ContainerInfo> info = probe(dir.file("a.ts"));
  ASSERT_TRUE(info) << info.error().describe();
  const TrackInfo* track = info->first(TrackKind::face);
  ASSERT_NE(track, nullptr);
  EXPECT_EQ(track->visual_profile, 0x61);
}

}  // namespace read_container_test
}  // namespace animeme::media

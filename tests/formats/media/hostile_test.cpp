// Damaged files must end in an error or in a part with a warning, never in a crash or a hang.
// The sanitizer builds make this test sharp.
#include <gtest/gtest.h>

#include <string_view>

#include "tests/formats/media/media_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace hostile_test {

using test::Bytes;

// What must hold whatever the input is.
void read_everything(const Bytes& file) {
  const Result<Container> talk = read_container(file);
  if (talk) {
    ASSERT_FALSE(talk->face.units.empty());
    EXPECT_TRUE(talk->face.units[0].intra);
    EXPECT_GT(talk->face.timescale, 0u);
    std::int64_t last = INT64_MIN;
    std::size_t bytes = 0;
    for (const fba::AccessUnit& unit : talk->face.units) {
      EXPECT_FALSE(unit.bytes.empty());
      EXPECT_GT(unit.time, last);
      EXPECT_GT(unit.duration, 0);
      last = unit.time;
      bytes += unit.bytes.size();
    }
    EXPECT_LE(bytes, std::size_t(1) << 28);
  } else {
    EXPECT_FALSE(talk.error().message.empty());
    EXPECT_NE(talk.error().code, Code::internal);
  }
  const Result<ContainerInfo> info = probe(file);
  EXPECT_TRUE(info || info.error().code != Code::internal);
  const Result<Pcm> sound = read_audio(file, {.sample_rate = 8000, .max_seconds = 60});
  EXPECT_TRUE(sound || sound.error().code != Code::internal);
  const Result<EncodedAudio> coded = read_encoded_audio(file);
  if (!coded) {
    EXPECT_NE(coded.error().code, Code::internal);
    return;
  }
  // What was read can be decoded, or is refused in order.
  const Result<Pcm> decoded = decode_audio(*coded);
  EXPECT_TRUE(decoded || decoded.error().code != Code::internal);
}

std::vector<Bytes> make_samples() {
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(60);
  const Pcm sound = test::make_clicks(16000, 32000, {8000});
  std::vector<Bytes> samples;
  for (const char* name : {"a.mp4", "a.mkv", "a.ts"}) {
    EXPECT_TRUE(write_container(dir.file(name), {.face = &face, .audio = &sound}));
    samples.push_back(test::read_bytes(dir.file(name)));
  }
  samples.push_back(test::read_bytes((test::data_dir() / "containers" / "frag_aac.mp4").string()));
  MuxOptions options;
  options.audio.codec = AudioCodec::opus;
  EXPECT_TRUE(write_container(dir.file("b.mkv"), {.face = &face, .audio = &sound}, options));
  options.fragmented = true;
  EXPECT_TRUE(write_container(dir.file("b.mp4"), {.face = &face, .audio = &sound}, options));
  for (const char* name : {"b.mkv", "b.mp4"}) {
    samples.push_back(test::read_bytes(dir.file(name)));
  }
  return samples;
}

TEST(Hostile, TruncatedAtEvery293rdByte) {
  for (const Bytes& file : make_samples()) {
    for (std::size_t size = 1; size < file.size(); size += 293) {
      read_everything(Bytes(file.begin(), file.begin() + std::ptrdiff_t(size)));
    }
  }
}

// libavformat 5.1 spends seconds on each run of samples of a track without a number.
TEST(Hostile, FragmentsOfATrackWithoutANumberAreRefused) {
  const Bytes file = test::read_bytes((test::data_dir() / "containers" / "frag_aac.mp4").string());
  const std::string text(file.begin(), file.end());
  const std::size_t header = text.find("tkhd");
  ASSERT_NE(header, std::string::npos);
  ASSERT_TRUE(read_container(file));
  Bytes no_header = file;
  no_header[header] = 'x';
  Bytes no_number = file;
  std::fill_n(no_number.begin() + std::ptrdiff_t(header) + 16, 4, std::uint8_t(0));
  Bytes too_long = file;
  too_long[header - 2] = 0x7F;
  for (const Bytes& damaged : {no_header, no_number, too_long}) {
    const Result<Container> talk = read_container(damaged);
    ASSERT_FALSE(talk);
    EXPECT_EQ(talk.error().code, Code::syntax);
  }
}

TEST(Hostile, FlippedBits) {
  std::uint32_t state = 7;
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
  for (const Bytes& file : make_samples()) {
    for (int round = 0; round < 60; ++round) {
      Bytes damaged = file;
      // Half of the rounds hit the headers, where it hurts.
      const std::size_t reach =
          round % 2 == 0 ? file.size() : std::min<std::size_t>(2500, file.size());
      const std::uint32_t count = 1 + next() % 8;
      for (std::uint32_t i = 0; i < count; ++i)
        damaged[next() % reach] ^= std::uint8_t(1u << next() % 8);
      read_everything(damaged);
    }
  }
}

TEST(Hostile, HugeNumbersInHeaders) {
  for (const Bytes& file : make_samples()) {
    for (std::size_t at = 0; at + 4 <= std::min<std::size_t>(file.size(), 3000); at += 41) {
      Bytes damaged = file;
      for (std::size_t i = 0; i < 4; ++i) damaged[at + i] = i == 0 ? 0x7F : 0xFF;
      read_everything(damaged);
    }
  }
}

// Fragments count samples and bytes again and again; each number is set wrong in turn.
TEST(Hostile, WrongNumbersInFragments) {
  const Bytes file = make_samples().back();
  const std::string text(file.begin(), file.end());
  for (const char* box : {"moof", "mfhd", "traf", "tfhd", "tfdt", "trun", "elst", "trex", "mdat"}) {
    std::size_t at = text.find(box);
    ASSERT_NE(at, std::string::npos) << box;
    for (std::ptrdiff_t word = -1; word < 4; ++word) {
      for (const std::uint32_t value : {0u, 7u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
        Bytes damaged = file;
        const std::size_t place = at + std::size_t(4 * word + (word < 0 ? 0 : 4));
        for (std::size_t i = 0; i < 4 && place + i < damaged.size(); ++i) {
          damaged[place + i] = std::uint8_t(value >> (24 - 8 * i));
        }
        read_everything(damaged);
      }
    }
  }
}

class HostileSegments : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const fba::AccessUnits face = test::make_face(60, 25000, 1000, 20);
    const Pcm sound = test::make_clicks(16000, 40000, {8000});
    const auto written =
        write_container(path_, {.face = &face, .audio = &sound}, {.fragment_seconds = 0.5});
    ASSERT_TRUE(written) << written.error().describe();
  }
  // Whatever the files hold, there is an answer.
  void read_all() {
    const Result<Container> talk = read_container(path_);
    EXPECT_TRUE(talk || talk.error().code != Code::internal);
    const Result<Pcm> sound = read_audio(path_, {.sample_rate = 8000, .max_seconds = 60});
    EXPECT_TRUE(sound || sound.error().code != Code::internal);
    const Result<ContainerInfo> info = probe(path_);
    EXPECT_TRUE(info || info.error().code != Code::internal);
  }
  std::uint32_t next() { return (state_ = state_ * 1664525u + 1013904223u) >> 8; }

  test::TempDir dir_;
  std::string path_ = dir_.file(std::string("talk") + GetParam());
  std::string folder_ =
      dir_.file(std::string("talk") + (GetParam() == std::string(".mpd") ? "_dash" : "_hls"));
  std::uint32_t state_ = 11;
};

TEST_P(HostileSegments, DamagedPlaylists) {
  const Bytes good = test::read_bytes(path_);
  for (std::size_t size = 0; size < good.size(); size += 37) {
    test::write_bytes(path_, Bytes(good.begin(), good.begin() + std::ptrdiff_t(size)));
    read_all();
  }
  constexpr std::string_view kOdd = "<>\"'=/$%&#:.\n\0\xFF";
  for (int round = 0; round < 60; ++round) {
    Bytes damaged = good;
    for (std::uint32_t i = 0; i <= next() % 4; ++i) {
      damaged[next() % damaged.size()] = std::uint8_t(kOdd[next() % kOdd.size()]);
    }
    test::write_bytes(path_, damaged);
    read_all();
  }
}

TEST_P(HostileSegments, DamagedMissingAndMixedSegments) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    const Bytes good = test::read_bytes(file);
    for (int round = 0; round < 6; ++round) {
      Bytes damaged = good;
      if (round < 2) damaged.resize(next() % damaged.size());
      for (int i = 0; i < 8 && !damaged.empty(); ++i) {
        damaged[next() % damaged.size()] ^= std::uint8_t(1u << next() % 8);
      }
      test::write_bytes(file, damaged);
      read_all();
    }
    test::write_bytes(file, test::read_bytes(files[next() % files.size()]));
    read_all();
    std::filesystem::remove(file);
    read_all();
    test::write_bytes(file, good);
  }
}

TEST_P(HostileSegments, PlaylistsThatNameThemselves) {
  const std::string name = std::string("talk") + GetParam();
  const std::string hls = "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=1\n" + name + "\n";
  const std::string dash =
      "<MPD><Period><AdaptationSet><Representation><SegmentList><SegmentURL media='" + name +
      "'/></SegmentList></Representation></AdaptationSet></Period></MPD>";
  for (const std::string& text : {hls, dash}) {
    test::write_bytes(path_, Bytes(text.begin(), text.end()));
    EXPECT_FALSE(read_container(path_));
    EXPECT_FALSE(read_audio(path_));
  }
}

TEST_P(HostileSegments, OneSegmentNamedOverAndOverIsRefusedInTime) {
  std::string text = "#EXTM3U\n#EXT-X-MAP:URI=\"big\"\n";
  test::write_bytes(dir_.file("big"), Bytes(std::size_t(1) << 25));
  for (int i = 0; i < 1000; ++i) text += "big\n";
  const std::string path = dir_.file("many.m3u8");
  test::write_bytes(path, Bytes(text.begin(), text.end()));
  const Result<Container> talk = read_container(path);
  ASSERT_FALSE(talk);
  EXPECT_EQ(talk.error().code, Code::out_of_range);
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostileSegments, testing::Values(".m3u8", ".mpd"),
                         [](const auto& kind) { return std::string(kind.param + 1); });

}  // namespace hostile_test
}  // namespace animeme::media

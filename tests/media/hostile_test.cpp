// Damaged files must end in an error or in a part with a warning, never in a crash or a hang.
// The sanitizer builds make this test sharp.
#include <gtest/gtest.h>

#include "tests/media/media_support.h"
#include "tools/media/audio.h"
#include "tools/media/container.h"
#include "tools/media/mux.h"

namespace animeme::media {
namespace {

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
  return samples;
}

TEST(Hostile, TruncatedAtEvery97thByte) {
  for (const Bytes& file : make_samples()) {
    for (std::size_t size = 1; size < file.size(); size += 97) {
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
    for (int round = 0; round < 150; ++round) {
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
    for (std::size_t at = 0; at + 4 <= std::min<std::size_t>(file.size(), 3000); at += 11) {
      Bytes damaged = file;
      for (std::size_t i = 0; i < 4; ++i) damaged[at + i] = i == 0 ? 0x7F : 0xFF;
      read_everything(damaged);
    }
  }
}

}  // namespace
}  // namespace animeme::media

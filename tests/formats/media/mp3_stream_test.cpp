// MP3 in pieces that are cut anywhere sounds as it does at once.
#include "tools/formats/media/mp3_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tools/formats/media/audio.h"

namespace animeme::media {
namespace mp3_stream_test {

using Bytes = std::vector<std::uint8_t>;

// By ffmpeg; empty: it cannot.
Bytes make_mp3(const std::string& options) {
  const test::TempDir dir;
  const std::string voice = std::string(test::kSourceFolder) + "/tools/release/samples/voice.wav";
  const std::string line = "ffmpeg -v quiet -y -i '" + voice + "' " + options + " -f mp3 '" +
                           dir.file("a.mp3") + "' >/dev/null 2>&1";
  if (std::system(line.c_str()) != 0) return {};
  std::ifstream file(dir.file("a.mp3"), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Pcm in_pieces(const Bytes& mp3, std::size_t least, std::size_t most, unsigned seed) {
  Mp3Stream pieces;
  Pcm all;
  std::minstd_rand random(seed);
  for (std::size_t at = 0; at < mp3.size();) {
    const std::size_t size = std::min(mp3.size() - at, least + random() % (most - least + 1));
    const auto pcm = pieces.push(std::span(mp3).subspan(at, size));
    EXPECT_TRUE(pcm) << pcm.error().describe();
    if (!pcm) return all;
    if (!pcm->samples.empty()) all.sample_rate = pcm->sample_rate;
    all.samples.insert(all.samples.end(), pcm->samples.begin(), pcm->samples.end());
    at += size;
  }
  return all;
}

// Power of the difference of two sounds, as a share of that of the first.
double noise(const Pcm& a, const Pcm& b) {
  double sum = 0, power = 0;
  const std::size_t size = std::min(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < size; ++i) {
    sum += std::pow(double(a.samples[i] - b.samples[i]), 2);
    power += std::pow(double(a.samples[i]), 2);
  }
  return power > 0 ? sum / power : 1;
}

class Mp3 : public testing::TestWithParam<const char*> {};

TEST_P(Mp3, PiecesSoundAsTheWhole) {
  const Bytes mp3 = make_mp3(GetParam());
  if (mp3.empty()) GTEST_SKIP() << "ffmpeg cannot write MP3 (Debian: ffmpeg)";
  ASSERT_TRUE(Mp3Stream::begins(mp3));
  const auto whole = read_audio(mp3);
  ASSERT_TRUE(whole);
  for (const auto& [least, most] :
       std::vector<std::pair<std::size_t, std::size_t>>{{1, 50}, {100, 1000}, {1000, 9000}}) {
    const Pcm pieces = in_pieces(mp3, least, most, 3);
    EXPECT_EQ(pieces.sample_rate, whole->sample_rate);
    EXPECT_NEAR(double(pieces.samples.size()), double(whole->samples.size()), 2400);
    EXPECT_LT(noise(*whole, pieces), 1e-6) << least;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Mp3,
                         testing::Values("-ar 44100 -b:a 128k", "-ar 44100 -b:a 32k -ac 1",
                                         "-ar 24000 -b:a 48k", "-ar 16000 -q:a 6",
                                         "-ar 22050 -b:a 64k -write_xing 0 -id3v2_version 0"));

TEST(Mp3Stream, SeveralFilesFollowEachOther) {
  const Bytes mp3 = make_mp3("-ar 24000 -b:a 64k -t 1");
  if (mp3.empty()) GTEST_SKIP() << "ffmpeg cannot write MP3 (Debian: ffmpeg)";
  const auto whole = read_audio(mp3);
  ASSERT_TRUE(whole);
  Mp3Stream pieces;
  for (int i = 0; i < 3; ++i) {
    const auto pcm = pieces.push(mp3);
    ASSERT_TRUE(pcm);
    // What the last frame has too much is only known from its file.
    EXPECT_GE(pcm->samples.size(), whole->samples.size()) << i;
    EXPECT_LT(pcm->samples.size(), whole->samples.size() + 1152) << i;
    EXPECT_LT(noise(*whole, *pcm), 1e-6) << i;
  }
}

TEST(Mp3Stream, NoiseIsNone) {
  std::minstd_rand random(5);
  Bytes bytes(200000);
  for (std::uint8_t& byte : bytes) byte = std::uint8_t(random() >> 8);
  EXPECT_FALSE(Mp3Stream::begins(std::span(bytes).first(4000)));
  EXPECT_FALSE(Mp3Stream::begins({}));
  Mp3Stream pieces;
  Result<Pcm> last = Pcm{};
  for (std::size_t at = 0; at < bytes.size() && last; at += 5000) {
    last = pieces.push(std::span(bytes).subspan(at, 5000));
  }
  EXPECT_TRUE(!last || last->samples.size() < 48000) << "a frame may look like one";
  // Half of a header, and tags that lie about their size.
  for (const Bytes& odd : {Bytes{0xFF}, Bytes{0xFF, 0xFB}, Bytes{'I', 'D', '3'},
                           Bytes{'I', 'D', '3', 4, 0, 0, 0x7F, 0x7F, 0x7F, 0x7F, 1, 2, 3}}) {
    Mp3Stream fresh;
    EXPECT_TRUE(fresh.push(odd));
    EXPECT_TRUE(fresh.push(odd));
  }
}

}  // namespace mp3_stream_test
}  // namespace animeme::media

#include "tools/media/read_sound.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/media/media_support.h"
#include "tools/media/audio.h"
#include "tools/media/mux.h"

namespace animeme::media {
namespace {

Pcm click_at(double seconds, double length, int rate = 48000) {
  Pcm pcm{rate, std::vector<float>(std::size_t(length * rate), 0.0F)};
  const auto at = std::size_t(seconds * rate);
  for (std::size_t i = 0; i < 240; ++i) {
    pcm.samples[at + i] = float(0.8 * std::sin(2 * 3.14159265 * 4000 * double(i) / rate));
  }
  return pcm;
}

double click_of(const Pcm& pcm) {
  for (std::size_t i = 0; i < pcm.samples.size(); ++i) {
    if (std::abs(pcm.samples[i]) > 0.2F) return double(i) / pcm.sample_rate;
  }
  return -1;
}

class Containers : public testing::TestWithParam<const char*> {};

TEST_P(Containers, PacketsComeOutWithTheTimesOfTheDecodedSound) {
  const test::TempDir dir;
  const std::string path = dir.file(std::string("talk") + GetParam());
  const fba::AccessUnits face = test::make_face(50);
  const Pcm pcm = click_at(0.5, 2);
  ASSERT_TRUE(write_container(path, {.face = &face, .audio = &pcm}));
  const auto audio = read_encoded_audio(path);
  ASSERT_TRUE(audio) << audio.error().describe();
  EXPECT_EQ(audio->format.codec, AudioCodec::aac);
  EXPECT_EQ(audio->packets.front().time, -audio->format.priming);
  for (std::size_t i = 1; i < audio->packets.size(); ++i) {
    EXPECT_EQ(audio->packets[i].time, audio->packets[i - 1].time + 1024);
  }
  const auto decoded = decode_audio(*audio);
  const auto whole = read_audio(path);
  ASSERT_TRUE(decoded && whole);
  EXPECT_NEAR(click_of(*decoded), click_of(*whole), 1.5 / 48000);
  EXPECT_GT(click_of(*decoded), 0.49);
}

INSTANTIATE_TEST_SUITE_P(All, Containers, testing::Values(".mp4", ".mkv"));

TEST(ReadSound, Mp4GivesBackWhatWasEncoded) {
  const test::TempDir dir;
  const std::string path = dir.file("talk.mp4");
  const Pcm pcm = click_at(0.5, 2);
  const auto expected = encode_audio(pcm);
  ASSERT_TRUE(expected);
  ASSERT_TRUE(write_container(path, {.audio = &pcm}));
  const auto audio = read_encoded_audio(path);
  ASSERT_TRUE(audio) << audio.error().describe();
  EXPECT_EQ(audio->format.config, expected->format.config);
  EXPECT_EQ(audio->format.priming, expected->format.priming);
  ASSERT_EQ(audio->packets.size(), expected->packets.size());
  for (std::size_t i = 0; i < audio->packets.size(); ++i) {
    EXPECT_EQ(audio->packets[i].bytes, expected->packets[i].bytes) << i;
    EXPECT_EQ(audio->packets[i].time, expected->packets[i].time) << i;
    EXPECT_EQ(audio->packets[i].duration, expected->packets[i].duration) << i;
  }
  EXPECT_EQ(audio->length, std::int64_t(pcm.samples.size()));
}

TEST(ReadSound, OtherCodecsAndAdtsAreUnsupported) {
  const test::TempDir dir;
  const Pcm pcm = click_at(0.5, 1);
  const fba::AccessUnits face = test::make_face(25);
  ASSERT_TRUE(write_wav(dir.file("voice.wav"), pcm));
  EXPECT_EQ(read_encoded_audio(dir.file("voice.wav")).error().code, Code::unsupported);
  ASSERT_TRUE(write_container(dir.file("talk.ts"), {.face = &face, .audio = &pcm}));
  EXPECT_EQ(read_encoded_audio(dir.file("talk.ts")).error().code, Code::unsupported);
  ASSERT_TRUE(write_container(dir.file("mute.mp4"), {.face = &face}));
  EXPECT_EQ(read_encoded_audio(dir.file("mute.mp4")).error().code, Code::not_found);
  EXPECT_EQ(read_encoded_audio(dir.file("none.mp4")).error().code, Code::not_found);
}

}  // namespace
}  // namespace animeme::media

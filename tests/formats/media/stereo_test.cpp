// The two channels of a recording stay two in what is written, each with its own sound at its time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/formats/media/media_support.h"
#include "tests/support/wav_bytes.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {
namespace stereo_test {

struct Channels {
  int sample_rate = 0;
  std::vector<float> left, right;
};

// Different sweeps, so that only one shift fits; the right one is quieter.
Channels made_up(int sample_rate, double seconds, double gain) {
  Channels sound{sample_rate, {}, {}};
  for (std::size_t i = 0; i < std::size_t(seconds * sample_rate); ++i) {
    const double t = double(i) / sample_rate;
    const double swell = std::sin(std::numbers::pi * t / seconds);
    sound.left.push_back(
        float(gain * 0.5 * swell * std::sin(2 * std::numbers::pi * (300 * t + 200 * t * t))));
    sound.right.push_back(
        float(gain * 0.2 * swell * std::sin(2 * std::numbers::pi * (1500 * t - 250 * t * t))));
  }
  return sound;
}

Channels read_both(const std::string& path, int sample_rate) {
  auto reader = AudioReader::open(path, {.sample_rate = sample_rate, .most_channels = 2});
  EXPECT_TRUE(reader) << reader.error().describe();
  if (!reader) return {};
  EXPECT_EQ(reader->channels(), 2);
  Channels sound{reader->sample_rate(), {}, {}};
  std::vector<float> all;
  for (;;) {
    const auto block = reader->next();
    EXPECT_TRUE(block);
    if (!block || block->empty()) break;
    all.insert(all.end(), block->begin(), block->end());
  }
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
    sound.left.push_back(all[i]);
    sound.right.push_back(all[i + 1]);
  }
  return sound;
}

double product(const std::vector<float>& a, const std::vector<float>& b, std::ptrdiff_t shift) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::ptrdiff_t k = std::ptrdiff_t(i) + shift;
    if (k >= 0 && k < std::ptrdiff_t(b.size())) sum += double(a[i]) * double(b[std::size_t(k)]);
  }
  return sum;
}

void expect_same(const std::vector<float>& made, const std::vector<float>& back,
                 std::ptrdiff_t shift) {
  const double power = product(made, made, 0);
  EXPECT_NEAR(product(back, back, 0) / power, 1, 0.1) << "the level is kept";
  std::ptrdiff_t best = -20;
  for (std::ptrdiff_t at = -20; at <= 20; ++at) {
    if (product(made, back, shift + at) > product(made, back, shift + best)) best = at;
  }
  EXPECT_LE(std::abs(best), 1) << "samples";
  EXPECT_GT(product(made, back, shift + best) / power, 0.9);
}

struct Way {
  const char* name;
  AudioCodec codec;
  int sample_rate;
  double gain;
};

class Stereo : public testing::TestWithParam<Way> {};

TEST_P(Stereo, StaysInAFile) {
  const Way way = GetParam();
  const test::TempDir dir;
  const fba::AccessUnits face = test::make_face(75);
  const Channels made = made_up(way.sample_rate, 3, way.gain);
  const std::string voice = dir.file("voice.wav"), file = dir.file(way.name);
  test::write_bytes(voice, test::wav_bytes(way.sample_rate, {made.left, made.right}));
  const bool alone = std::string(way.name) == "quiet.opus";
  const MuxInput input{.face = alone ? nullptr : &face, .audio_file = &voice};
  MuxOptions options{.audio = {.codec = way.codec}};
  options.systems = std::string(way.name) == "systems.mp4";
  const auto written = write_container(file, input, options);
  ASSERT_TRUE(written) << written.error().describe();
  EXPECT_NEAR(written->sound_seconds, 3, options.systems ? 1e-3 : 1e-9);
  const auto coded = read_encoded_audio(file);
  ASSERT_TRUE(coded) << coded.error().describe();
  EXPECT_EQ(coded->format.channels, 2);
  // Matroska and TS have no place for the priming of AAC: all tracks are later by it.
  const bool later = std::string(way.name) == "a.mkv" || std::string(way.name) == "a.ts";
  const bool by_priming = later && way.codec == AudioCodec::aac;
  const Channels back = read_both(file, way.sample_rate);
  const auto shift = std::ptrdiff_t(by_priming ? 1024 : 0);
  {
    SCOPED_TRACE("left");
    expect_same(made.left, back.left, shift);
  }
  {
    SCOPED_TRACE("right");
    expect_same(made.right, back.right, shift);
  }
  EXPECT_LT(std::abs(product(made.left, back.right, shift)),
            0.02 * product(made.left, made.left, 0));
  const auto mono = read_audio(file, {.sample_rate = way.sample_rate});
  ASSERT_TRUE(mono) << mono.error().describe();
  EXPECT_EQ(mono->samples.size(), back.left.size()) << "the mean of both, as long";
}

INSTANTIATE_TEST_SUITE_P(Formats, Stereo,
                         testing::Values(Way{"a.mp4", AudioCodec::aac, 44100, 1},
                                         Way{"a.mp4", AudioCodec::aac, 16000, 1},
                                         Way{"b.mp4", AudioCodec::opus, 48000, 1},
                                         Way{"c.mp4", AudioCodec::opus, 22050, 1},
                                         Way{"quiet.mp4", AudioCodec::aac, 44100, 0.01},
                                         Way{"quiet.opus", AudioCodec::opus, 44100, 0.01},
                                         Way{"systems.mp4", AudioCodec::aac, 44100, 1},
                                         Way{"a.mkv", AudioCodec::aac, 48000, 1},
                                         Way{"a.mkv", AudioCodec::opus, 48000, 1},
                                         Way{"a.ts", AudioCodec::aac, 48000, 1},
                                         Way{"a.m3u8", AudioCodec::aac, 44100, 1},
                                         Way{"a.mpd", AudioCodec::opus, 44100, 1}));

// Sound of more channels becomes two, of one stays one; sound in memory has one.
TEST(Stereo, IsWhatTheFileHas) {
  const test::TempDir dir;
  const Pcm one = test::make_clicks(16000, 32000, {8000});
  ASSERT_TRUE(write_wav(dir.file("one.wav"), one));
  const std::string voice = dir.file("one.wav");
  ASSERT_TRUE(write_container(dir.file("one.mp4"), {.audio_file = &voice}));
  const auto coded = read_encoded_audio(dir.file("one.mp4"));
  ASSERT_TRUE(coded) << coded.error().describe();
  EXPECT_EQ(coded->format.channels, 1);
  const auto reader = AudioReader::open(voice, {.most_channels = 2});
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->channels(), 1);
  const std::vector<float> zeros(32000);
  const std::string six = dir.file("six.wav");
  test::write_bytes(six, test::wav_bytes(16000, {one.samples, zeros, zeros, zeros, zeros, zeros}));
  ASSERT_TRUE(write_container(dir.file("six.mp4"), {.audio_file = &six}));
  const Channels two = read_both(dir.file("six.mp4"), 16000);
  EXPECT_GT(product(two.left, two.left, 0), 1) << "front left";
  EXPECT_LT(product(two.right, two.right, 0), 0.01 * product(two.left, two.left, 0));
  const auto wrong = AudioReader::open(voice, {.most_channels = 3});
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Code::invalid_argument);
  const auto encoder = AudioEncoder::open(16000, {}, 3);
  ASSERT_FALSE(encoder);
  EXPECT_EQ(encoder.error().code, Code::invalid_argument);
}

// Pairs that are cut anywhere, also in their middle.
TEST(Stereo, IsCodedTheSameHoweverItIsCut) {
  const Channels made = made_up(22050, 1, 1);
  std::vector<float> pairs;
  for (std::size_t i = 0; i < made.left.size(); ++i) {
    pairs.push_back(made.left[i]);
    pairs.push_back(made.right[i]);
  }
  for (const AudioCodec codec : {AudioCodec::aac, AudioCodec::opus}) {
    std::vector<std::vector<AudioPacket>> ways;
    for (const std::size_t piece : {pairs.size(), std::size_t(441), std::size_t(2048)}) {
      auto encoder = AudioEncoder::open(22050, {.codec = codec}, 2);
      ASSERT_TRUE(encoder) << encoder.error().describe();
      EXPECT_EQ(encoder->format().channels, 2);
      auto& packets = ways.emplace_back();
      for (std::size_t at = 0; at < pairs.size(); at += piece) {
        const auto more = std::span(pairs).subspan(at, std::min(piece, pairs.size() - at));
        const auto some = encoder->push(more);
        ASSERT_TRUE(some);
        packets.insert(packets.end(), some->begin(), some->end());
      }
      const auto rest = encoder->finish();
      ASSERT_TRUE(rest);
      packets.insert(packets.end(), rest->begin(), rest->end());
    }
    EXPECT_EQ(ways[0], ways[1]);
    EXPECT_EQ(ways[0], ways[2]);
  }
}

}  // namespace stereo_test
}  // namespace animeme::media

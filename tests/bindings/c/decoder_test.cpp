// The decoder of the C interface: pieces, resets, damage, and the values of the C++ decoder.
#include <thread>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "tests/bindings/c/support.h"
#include "tests/support/random_clip.h"

namespace animeme::test {
namespace decoder_test {
namespace {

C<animeme_decoder> new_decoder() {
  animeme_decoder* decoder = nullptr;
  EXPECT_EQ(animeme_decoder_new(&decoder, nullptr), ANIMEME_OK);
  return C<animeme_decoder>(decoder);
}

Bytes stream_of(std::uint64_t seed, int frames = 60) {
  fba::EncodeOptions options = fba::live_options();
  options.intra_seconds = 0.4;
  options.stream.plane_start_codes = fba::PlaneStartCodes::all;
  const auto stream = fba::encode(random_clip(seed, frames, true), options);
  EXPECT_TRUE(stream) << stream.error().describe();
  return *stream;
}

TEST(CDecoder, GivesWhatTheLibraryBehindItGives) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Bytes bytes = stream_of(seed);
    const auto want = fba::decode(bytes);
    ASSERT_TRUE(want);
    const auto decoder = new_decoder();
    animeme_decoder_push(decoder.get(), bytes.data(), bytes.size(), nullptr);
    animeme_frame frame = empty_frame();
    for (const fba::Plane& plane : want->planes) {
      ASSERT_EQ(animeme_decoder_next(decoder.get(), &frame, nullptr, nullptr), ANIMEME_OK);
      expect_same(frame, plane.face);
      EXPECT_EQ(frame.seconds, plane.seconds);
      EXPECT_EQ(frame.rate_num, plane.rate.num);
      EXPECT_EQ(frame.rate_den, plane.rate.den);
      EXPECT_EQ((frame.flags & ANIMEME_FRAME_INTRA) != 0, plane.intra);
      EXPECT_EQ(frame.size, sizeof frame);
    }
    EXPECT_EQ(animeme_decoder_next(decoder.get(), &frame, nullptr, nullptr), ANIMEME_END);
  }
}

TEST(CDecoder, PiecesAreAsOnePush) {
  Random random(5);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Bytes bytes = stream_of(seed);
    std::vector<std::size_t> pieces;
    for (std::size_t sum = 0; sum < bytes.size(); sum += pieces.back()) {
      pieces.push_back(std::size_t(random.range(0, seed % 2 == 0 ? 3 : 400)));
    }
    ASSERT_TRUE(everything(new_decoder().get(), bytes, pieces) ==
                everything(new_decoder().get(), bytes));
  }
}

TEST(CDecoder, AfterAResetAllIsForgotten) {
  const Bytes first = stream_of(1);
  const Bytes second = stream_of(2);
  const auto want = everything(new_decoder().get(), second);
  Random random(3);
  const auto decoder = new_decoder();
  for (int round = 0; round < 20; ++round) {
    const std::size_t cut = std::size_t(random.range(0, int(first.size())));
    animeme_decoder_push(decoder.get(), first.data(), cut, nullptr);
    animeme_frame frame = empty_frame();
    while (animeme_decoder_next(decoder.get(), &frame, nullptr, nullptr) == ANIMEME_OK) {
    }
    if (round % 3 == 0) animeme_decoder_finish(decoder.get(), nullptr);
    ASSERT_EQ(animeme_decoder_reset(decoder.get(), nullptr), ANIMEME_OK);
    ASSERT_TRUE(everything(decoder.get(), second) == want);
    ASSERT_EQ(animeme_decoder_reset(decoder.get(), nullptr), ANIMEME_OK);
  }
}

TEST(CDecoder, DamageIsToldWithItsBitAndDecodingGoesOn) {
  Random random(7);
  int failures = 0;
  int later = 0;  // planes behind a failure
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Bytes bytes = stream_of(seed % 4 + 1);
    for (int hit = 0; hit < 5; ++hit) {
      bytes[std::size_t(random.range(0, int(bytes.size()) - 1))] = std::uint8_t(random.next());
    }
    const auto decoder = new_decoder();
    animeme_decoder_push(decoder.get(), bytes.data(), bytes.size(), nullptr);
    animeme_decoder_finish(decoder.get(), nullptr);
    bool failed = false;
    for (std::size_t call = 0;; ++call) {
      ASSERT_LE(call, bytes.size() * 8) << "it does not end";
      animeme_frame frame = empty_frame();
      animeme_error error{};
      const animeme_status status = animeme_decoder_next(decoder.get(), &frame, nullptr, &error);
      if (status == ANIMEME_END) break;
      if (status < 0) {
        failed = true;
        ++failures;
        EXPECT_EQ(error.status, status);
        EXPECT_GE(error.bit, 0);
        EXPECT_LE(error.bit, std::int64_t(bytes.size()) * 8);
        EXPECT_NE(std::string(error.message).find("bit " + std::to_string(error.bit)),
                  std::string::npos);
      } else {
        ASSERT_EQ(status, ANIMEME_OK);
        later += failed ? 1 : 0;
      }
    }
  }
  EXPECT_GT(failures, 20);
  EXPECT_GT(later, 20);
}

TEST(CDecoder, NoiseEnds) {
  Random random(11);
  for (int round = 0; round < 200; ++round) {
    Bytes bytes = {0, 0, 1, 0xBA};
    for (int i = 0; i < 500; ++i)
      bytes.push_back(random.chance(30) ? 0 : std::uint8_t(random.next()));
    const auto all = everything(new_decoder().get(), bytes);
    ASSERT_FALSE(all.empty());
    EXPECT_LT(all.size(), bytes.size() * 8);
  }
}

TEST(CDecoder, WarningsAreCounted) {
  Bytes bytes = stream_of(1);
  ASSERT_EQ(bytes.back(), 0xB1);
  bytes.back() =
      0xB6;  // a start code that belongs to neither planes nor headers, in place of the end
  const auto decoder = new_decoder();
  animeme_error last{};
  EXPECT_EQ(animeme_decoder_warnings(decoder.get(), &last), 0);
  EXPECT_STREQ(last.message, "");
  (void)everything(decoder.get(), bytes);
  EXPECT_EQ(animeme_decoder_warnings(decoder.get(), &last), 1);
  EXPECT_GT(last.bit, 0);
  EXPECT_STRNE(last.message, "");
  animeme_decoder_reset(decoder.get(), nullptr);
  EXPECT_EQ(animeme_decoder_warnings(decoder.get(), nullptr), 0);
}

TEST(CDecoder, AnOlderProgramHasAShorterFrame) {
  const Bytes bytes = stream_of(1);
  const auto decoder = new_decoder();
  animeme_decoder_push(decoder.get(), bytes.data(), bytes.size(), nullptr);
  animeme_frame frame;
  std::fill_n(reinterpret_cast<unsigned char*>(&frame), sizeof frame, std::uint8_t{0xAB});
  frame.size = offsetof(animeme_frame, viseme);
  ASSERT_EQ(animeme_decoder_next(decoder.get(), &frame, nullptr, nullptr), ANIMEME_OK);
  EXPECT_EQ(frame.number, 0);
  EXPECT_EQ(frame.size, offsetof(animeme_frame, viseme));
  const auto* raw = reinterpret_cast<const unsigned char*>(&frame);
  for (std::size_t at = frame.size; at < sizeof frame; ++at) ASSERT_EQ(raw[at], 0xAB) << at;
}

TEST(CDecoder, ANewerProgramHasALongerFrame) {
  struct Newer {
    animeme_frame frame;
    unsigned char more[16];
  } newer;
  animeme_frame_init(&newer.frame, sizeof newer);
  const Bytes bytes = stream_of(1);
  const auto decoder = new_decoder();
  animeme_decoder_push(decoder.get(), bytes.data(), bytes.size(), nullptr);
  std::fill(std::begin(newer.more), std::end(newer.more), std::uint8_t{0xAB});
  ASSERT_EQ(animeme_decoder_next(decoder.get(), &newer.frame, nullptr, nullptr), ANIMEME_OK);
  for (const unsigned char byte : newer.more) EXPECT_EQ(byte, 0);
  // What it sets there is unknown here; that is said, not passed over.
  animeme_frame out = empty_frame();
  EXPECT_EQ(animeme_expand(&newer.frame, &out, nullptr), ANIMEME_OK);
  newer.more[3] = 1;
  EXPECT_EQ(animeme_expand(&newer.frame, &out, nullptr), ANIMEME_INVALID_ARGUMENT);
}

TEST(CDecoder, HandlesInThreadsKnowNothingOfEachOther) {
  const Bytes one = stream_of(1, 400);
  const Bytes two = stream_of(2, 400);
  const auto want_one = everything(new_decoder().get(), one);
  const auto want_two = everything(new_decoder().get(), two);
  std::vector<std::string> got_one;
  std::vector<std::string> got_two;
  std::thread other([&] { got_one = everything(new_decoder().get(), one); });
  got_two = everything(new_decoder().get(), two);
  other.join();
  EXPECT_TRUE(got_one == want_one);
  EXPECT_TRUE(got_two == want_two);
}

}  // namespace
}  // namespace decoder_test
}  // namespace animeme::test

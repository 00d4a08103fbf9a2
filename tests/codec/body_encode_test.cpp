// Coding clips with a body: what comes back is within half a step, frames and gaps are kept.
#include "codec/encode/encode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "tests/support/random_clip.h"

namespace animeme::fba {
namespace body_encode_test {

using testing::HasSubstr;

BodySequence random_body(std::uint64_t seed, int frames, fap::Rate rate) {
  test::Random random(seed);
  BodySequence body{rate, {}, "random"};
  std::bitset<kBapCount + 1> used;
  for (std::size_t bap = 1; bap <= kBapCount; ++bap) used[bap] = random.chance(30);
  used.set(1);
  std::int64_t number = random.range(0, 5);
  for (int i = 0; i < frames; ++i) {
    BodyFrame& frame = body.frames.emplace_back();
    frame.number = number;
    number += random.chance(20) ? random.range(1, 40) : 1;
    for (std::size_t bap = 1; bap <= kBapCount; ++bap) {
      if (!used[bap] || random.chance(10)) continue;
      frame.mask.set(bap);
      frame.value[bap] = random.range(-1800, 1800);
    }
  }
  return body;
}

Result<std::vector<std::uint8_t>> encode_with_body(fap::Sequence face, const BodySequence& body,
                                                   EncodeOptions options = {}) {
  if (face.frames.empty()) face.rate = body.rate;
  options.bap_quant = options.fap_quant;
  return encode(face, options, body.frames);
}

int step_of(std::size_t bap) {
  for (std::size_t slot = 0; slot < kBapOrder.size(); ++slot) {
    if (kBapOrder[slot] == bap) return kBapSteps[slot];
  }
  return 0;
}

// Every frame of `given` is in `got` by its number, its values within half a step.
void expect_close(const BodySequence& given, const DecodedStream& stream, std::int64_t origin,
                  int scale) {
  const BodySequence got = body_sequence(stream);
  auto at = got.frames.begin();
  for (const BodyFrame& frame : given.frames) {
    while (at != got.frames.end() && at->number < frame.number - origin) ++at;
    ASSERT_NE(at, got.frames.end());
    ASSERT_EQ(at->number, frame.number - origin);
    for (std::size_t bap = 1; bap <= kBapCount; ++bap) {
      if (!frame.mask[bap]) continue;
      ASSERT_TRUE(at->mask[bap]);
      ASSERT_LE(2 * std::abs(at->value[bap] - frame.value[bap]), step_of(bap) * scale)
          << "BAP " << bap << " frame " << frame.number;
    }
  }
}

TEST(EncodeWithBody, ComesBackWithinHalfAStep) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    test::Random random(seed + 1000);
    EncodeOptions options;
    options.fap_quant = random.range(1, 3);
    options.intra_seconds = (random.chance(50) ? random.range(1, 9) : 0) / 25.0;
    fap::Sequence face;
    if (random.chance(60)) face = test::random_clip(seed, random.range(1, 25), true);
    const BodySequence body =
        random_body(seed, random.range(1, 25), face.frames.empty() ? fap::Rate{30, 1} : face.rate);
    auto bytes = encode_with_body(face, body, options);
    ASSERT_TRUE(bytes) << bytes.error().describe();
    auto stream = decode(*bytes);
    ASSERT_TRUE(stream) << stream.error().describe();
    EXPECT_EQ(stream->rate, body.rate);
    EXPECT_TRUE(stream->warnings.empty());
    const std::int64_t origin =
        face.frames.empty() ? body.frames.front().number
                            : std::min(face.frames.front().number, body.frames.front().number);
    expect_close(body, *stream, origin, bap_scale(options.fap_quant));
    const fap::Sequence got = face_sequence(*stream);
    EXPECT_EQ(got.frames.empty(), face.frames.empty());
    auto at = got.frames.begin();
    for (const fap::Frame& frame : face.frames) {
      while (at != got.frames.end() && at->number < frame.number - origin) ++at;
      ASSERT_NE(at, got.frames.end());
      ASSERT_EQ(at->number, frame.number - origin);
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        if (!frame.mask[fap]) continue;
        ASSERT_LE(2 * std::abs(at->value[fap] - frame.value[fap]),
                  fap::info(int(fap)).quant_step * options.fap_quant);
      }
    }
  }
}

TEST(EncodeWithBody, StartsAnewWhereAChangeIsTooLarge) {
  BodySequence body;
  for (int i = 0; i < 4; ++i) {
    BodyFrame& frame = body.frames.emplace_back();
    frame.number = i;
    frame.mask.set(1);
    frame.value[1] = (i < 2 ? -1 : 1) * 170 * 1860;
  }
  auto bytes = encode_with_body({}, body);
  ASSERT_TRUE(bytes) << bytes.error().describe();
  auto stream = decode(*bytes);
  ASSERT_TRUE(stream);
  ASSERT_EQ(stream->planes.size(), 4u);
  EXPECT_EQ(stream->planes[2].body->value[1], 170 * 1860);
  EXPECT_TRUE(stream->planes[2].intra);
  EXPECT_FALSE(stream->planes[1].intra || stream->planes[3].intra);
}

TEST(EncodeWithBody, Refuses) {
  const auto says = [](const fap::Sequence& face, const BodySequence& body, EncodeOptions options,
                       Code code, const char* message) {
    auto bytes = encode_with_body(face, body, options);
    ASSERT_FALSE(bytes) << message;
    EXPECT_EQ(bytes.error().code, code);
    EXPECT_THAT(bytes.error().message, HasSubstr(message));
  };
  BodySequence body = random_body(1, 3, {25, 1});
  says({}, {}, {}, Code::invalid_argument, "no frames");
  says({}, body, {.fap_quant = 32}, Code::invalid_argument, "fap_quant");
  says({}, body, {.intra_seconds = -1}, Code::invalid_argument, "intra period");
  body.rate = {1, 7};
  says({}, body, {}, Code::unsupported, "cannot be coded");
  body.rate = {25, 1};
  body.frames[0].mask.set(1);
  body.frames[0].value[1] = 170 * 1861;
  says({}, body, {.fap_quant = 0}, Code::out_of_range, "BAP ");
  std::swap(body.frames[0], body.frames[1]);
  says({}, body, {}, Code::invalid_argument, "ascend");
}

}  // namespace body_encode_test
}  // namespace animeme::fba

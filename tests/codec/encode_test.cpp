// encode(): the file preset, the error and rate limits, and the hazards it avoids.
#include "codec/encode/encode.h"

#include <gtest/gtest.h>

#include <cmath>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/live.h"
#include "fap/compare.h"
#include "tests/codec/two_decoders.h"
#include "tests/support/random_clip.h"

namespace animeme {
namespace encode_test {

// A face that talks: few FAPs move, some sides are equal, some FAPs rest at 0 or elsewhere.
fap::Sequence talking_clip(std::uint64_t seed, int frames) {
  test::Random random(seed);
  fap::Sequence clip;
  std::array<int, fap::kFapCount + 1> kind{};
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    kind[std::size_t(fap)] = random.range(0, 4);
  }
  std::array<double, fap::kFapCount + 1> phase{};
  for (double& p : phase) p = random.range(0, 628) * 0.01;
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::size_t n = std::size_t(fap);
      const int size = fap::info(fap).unit == fap::Unit::angle ? 9000 : 150;
      int value = 0;
      if (kind[n] == 1) value = 40;
      if (kind[n] >= 2) value = int(std::lround(size * std::sin(0.2 * i + phase[n])));
      const int mirror = fap::info(fap).mirror;
      if (kind[n] == 4 && mirror != 0 && mirror < fap) value = frame.value[std::size_t(mirror)];
      frame.set(fap, value);
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

fap::Sequence filled(const std::vector<std::uint8_t>& stream, bool like_public_decoder) {
  auto decoded = fba::decode(stream);
  EXPECT_TRUE(decoded) << decoded.error().describe();
  if (!decoded) return {};
  auto result = fba::fill(*decoded, {.like_public_decoder = like_public_decoder});
  EXPECT_TRUE(result) << result.error().describe();
  return result ? *result : fap::Sequence{};
}

// Every value of `a`, in both; what only `b` has does not matter.
void expect_same_values(const fap::Sequence& a, const fap::Sequence& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!a.frames[i].mask[fap]) continue;
      ASSERT_EQ(a.frames[i].value[fap], b.frames[i].value[fap]) << "frame " << i << " FAP " << fap;
    }
  }
}

class Presets : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Presets, FileHasTheSameValuesAfterFilling) {
  const fap::Sequence clip = talking_clip(GetParam(), 60);
  const int quant = int(GetParam() % 5);
  fba::EncodeOptions small = fba::file_options();
  small.fap_quant = quant;
  small.intra_seconds = GetParam() % 2 == 0 ? 0 : 17 / 25.0;
  fba::EncodeReport report;
  auto stream = fba::encode(clip, small, {}, &report);
  if (!stream) {
    // Without quantisation angles of 9000 do not fit.
    EXPECT_EQ(stream.error().code, Code::out_of_range);
    EXPECT_EQ(quant, 0);
    return;
  }
  auto plain = fba::encode(clip, {.fap_quant = quant});
  ASSERT_TRUE(plain);
  EXPECT_GT(report.mirrored + report.left_out, 0U);
  const fap::Sequence reference = filled(*plain, false);
  // Whether the decoder heeds mask types or copies sides always: the same face.
  expect_same_values(reference, filled(*stream, false));
  expect_same_values(reference, filled(*stream, true));
}

TEST_P(Presets, KeptRangesChangeTheFirstFrameAlone) {
  const fap::Sequence clip = talking_clip(GetParam(), 100);
  fba::EncodeOptions options = fba::file_options();
  options.fap_quant = 1 + int(GetParam() % 5);
  const auto plain = fba::encode(clip, options);
  options.kept_ranges = true;
  fba::EncodeReport report;
  const auto kept = fba::encode(clip, options, {}, &report);
  ASSERT_TRUE(plain);
  ASSERT_TRUE(kept) << kept.error().describe();
  EXPECT_LE(kept->size(), plain->size());
  const auto decoded = fba::decode(*kept);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(report.kept_ranges, *kept != *plain);
  EXPECT_EQ(report.kept_ranges, decoded->planes[0].face_settings->fap_quant > options.fap_quant);
  fap::Sequence want = filled(*plain, false);
  fap::Sequence got = filled(*kept, false);
  want.frames.erase(want.frames.begin());
  got.frames.erase(got.frames.begin());
  expect_same_values(want, got);
  options.intra_seconds = 1;
  EXPECT_EQ(fba::encode(clip, options).error().code, Code::invalid_argument);
}

TEST(KeptRanges, SaveBitsWhereSmallChangesAreMany) {
  test::Random random(4);
  fap::Sequence clip;
  fap::Frame frame;
  for (int i = 0; i < 75; ++i) {
    frame.number = i;
    for (int fap = 3; fap <= 28; ++fap) {
      frame.set(fap, frame.value[std::size_t(fap)] + random.range(-3, 3));
    }
    clip.frames.push_back(frame);
  }
  fba::EncodeOptions options = fba::file_options();
  const auto plain = fba::encode(clip, options);
  options.kept_ranges = true;
  const auto kept = fba::encode(clip, options);
  ASSERT_TRUE(plain && kept);
  EXPECT_LT(double(kept->size()), 0.8 * double(plain->size()));
}

TEST_P(Presets, DefaultRangesAreNotSent) {
  const fap::Sequence clip = talking_clip(GetParam(), 120);
  fba::EncodeOptions options = fba::live_options();
  options.fap_quant = 1 + int(GetParam() % 5);
  options.intra_seconds = 1;
  const auto plain = fba::encode(clip, options);
  options.default_ranges = true;
  fba::EncodeReport report;
  const auto smaller = fba::encode(clip, options, {}, &report);
  ASSERT_TRUE(plain);
  ASSERT_TRUE(smaller) << smaller.error().describe();
  expect_same_values(filled(*plain, false), filled(*smaller, false));
  const auto decoded = fba::decode(*smaller);
  ASSERT_TRUE(decoded);
  for (const fba::Plane& plane : decoded->planes) {
    EXPECT_EQ(plane.face_settings->send_range[fba::kIntraMax], !report.default_ranges);
    EXPECT_EQ(plane.face_settings->send_range[fba::kIntraMin], !report.default_ranges);
    EXPECT_TRUE(plane.face_settings->send_range[fba::kPredictiveMax]);
  }
  EXPECT_TRUE(test::both_read(*smaller));
  options.kept_ranges = true;
  options.intra_seconds = 0;
  EXPECT_EQ(fba::encode(clip, options).error().code, Code::invalid_argument);
}

TEST(DefaultRanges, AreUsedWhereAllValuesLieWithinThem) {
  fap::Sequence clip;
  for (int i = 0; i < 100; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (int fap = 3; fap <= 28; ++fap) frame.set(fap, 5 * (i % 20));
    clip.frames.push_back(frame);
  }
  fba::EncodeOptions options = fba::live_options();
  options.intra_seconds = 1;
  const auto plain = fba::encode(clip, options);
  options.default_ranges = true;
  fba::EncodeReport report;
  const auto smaller = fba::encode(clip, options, {}, &report);
  ASSERT_TRUE(plain && smaller);
  EXPECT_TRUE(report.default_ranges);
  EXPECT_LT(smaller->size(), plain->size());
  EXPECT_TRUE(test::both_read(*smaller));
  // One value that is out of them: all intra planes send theirs.
  clip.frames[25].set(3, fap::info(3).quant_step * (fap::info(3).default_i_range + 60));
  const auto sent = fba::encode(clip, options, {}, &report);
  ASSERT_TRUE(sent);
  EXPECT_FALSE(report.default_ranges);
  EXPECT_TRUE(test::both_read(*sent));
}

TEST_P(Presets, FileIsSmaller) {
  const fap::Sequence clip = talking_clip(GetParam(), 60);
  auto plain = fba::encode(clip);
  auto small = fba::encode(clip, fba::file_options());
  ASSERT_TRUE(plain);
  ASSERT_TRUE(small);
  EXPECT_LT(small->size(), plain->size());
}

TEST_P(Presets, ErrorLimitIsKeptAndSavesBits) {
  const fap::Sequence clip = talking_clip(GetParam(), 60);
  std::size_t before = fba::encode(clip, fba::file_options())->size();
  for (const double rms : {1.0, 2.0, 5.0, 12.0}) {
    fba::EncodeOptions options = fba::file_options();
    options.max_rms = rms;
    fba::EncodeReport report;
    auto stream = fba::encode(clip, options, {}, &report);
    ASSERT_TRUE(stream) << stream.error().describe();
    EXPECT_LE(report.rms, rms);
    EXPECT_LE(report.rms_other, rms);
    EXPECT_LT(stream->size(), before);
    before = stream->size();
    // The report tells the truth: the same error from the decoded stream.
    const fap::Sequence shown = filled(*stream, false);
    double error = 0;
    double count = 0;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (fap::info(int(fap)).unit == fap::Unit::angle) continue;
      bool moves = false;
      for (const fap::Frame& frame : clip.frames) {
        moves |= frame.value[fap] != clip.frames[0].value[fap];
      }
      if (!moves) continue;
      for (std::size_t i = 0; i < clip.frames.size(); ++i) {
        const double difference = clip.frames[i].value[fap] - shown.frames[i].value[fap];
        error += difference * difference;
        ++count;
      }
    }
    EXPECT_NEAR(std::sqrt(error / count), report.rms, 1e-9);
  }
}

TEST_P(Presets, RateLimitIsKept) {
  const fap::Sequence clip = talking_clip(GetParam(), 120);
  double before = 0;
  for (const double rate : {2000.0, 4000.0}) {
    fba::EncodeOptions options = fba::file_options();
    options.max_bits_per_second = rate;
    fba::EncodeReport report;
    auto stream = fba::encode(clip, options, {}, &report);
    ASSERT_TRUE(stream);
    const double got = double(stream->size()) * 8 / clip.duration();
    EXPECT_LE(got, rate * 1.01) << "rms " << report.rms;
    EXPECT_GT(got, before) << "more bits allowed, none used";
    before = got;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Presets, testing::Range<std::uint64_t>(1, 9));

// A clip in which each FAP that is named moves by so much a frame.
fap::Sequence ramp_clip(std::initializer_list<std::pair<int, int>> speeds) {
  fap::Sequence clip;
  for (int i = 0; i < 20; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (const auto& [fap, speed] : speeds) frame.set(fap, speed * i);
    clip.frames.push_back(frame);
  }
  return clip;
}

TEST(Encode, AZeroSideIsCodedWhereADecoderWouldCopyTheOther) {
  const fap::Sequence clip = ramp_clip({{19, 30}, {20, 0}});  // the right lid stays open
  auto stream = fba::encode(clip, fba::file_options());
  ASSERT_TRUE(stream);
  for (const bool copies : {false, true}) {
    expect_same_values(filled(*fba::encode(clip), false), filled(*stream, copies));
  }
}

TEST(Encode, AZeroLipIsCodedWhereADecoderWouldInterpolateIt) {
  // Both corners alike, so that the group is of type 2; the inner lip rests, the outer one moves.
  const fap::Sequence clip = ramp_clip({{6, 10}, {7, 10}, {4, 0}, {51, 12}});
  fba::EncodeReport report;
  auto stream = fba::encode(clip, fba::file_options(), {}, &report);
  ASSERT_TRUE(stream);
  EXPECT_EQ(report.mirrored, 1U);
  EXPECT_EQ(report.left_out, 0U);
  expect_same_values(filled(*fba::encode(clip), false), filled(*stream, false));
}

TEST(Encode, AFapThatTheClipDoesNotHaveStaysAtRest) {
  // The group is of type 2; the other side of FAP 8 is not in the clip, nor the inner lip, FAP 4.
  const fap::Sequence clip = ramp_clip({{6, 10}, {7, 10}, {8, -8}, {51, 12}});
  fba::EncodeReport report;
  auto small = fba::decode(*fba::encode(clip, fba::file_options(), {}, &report));
  EXPECT_EQ(report.mirrored, 1U);
  EXPECT_EQ(report.left_out, 0U);
  EXPECT_EQ(report.coded, 5U);  // 6, 8, 51, and zeros of 4 and 9
  auto plain = fba::decode(*fba::encode(clip));
  const auto shown = [](const fba::DecodedStream& stream) {
    return fba::fill(stream, {.complete = true})->frames;
  };
  EXPECT_TRUE(shown(*plain) == shown(*small));
  EXPECT_EQ(shown(*small)[19].value[9], 0);
  EXPECT_EQ(shown(*small)[19].value[4], 0);
}

TEST(Encode, ParametersThatComeToRestDoNotKeepHazards) {
  // Forty FAPs fall once and rest: their 0 is then the highest symbol, and the planes are all
  // zeros. One climbs beyond what an intra plane can hold, so that there can be none.
  fap::Sequence clip;
  for (int i = 0; i < 40; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (int fap = 3; fap < 43; ++fap) frame.set(fap, i == 0 ? 0 : -500);
    frame.set(68, 300 * i);
    clip.frames.push_back(frame);
  }
  fba::EncodeReport report;
  auto stream = fba::encode(clip, {.fap_quant = 0}, {}, &report);
  ASSERT_TRUE(stream) << stream.error().describe();
  EXPECT_GT(report.retries, 0U);
  EXPECT_LT(report.retries, 10U) << "detours that make zeros instead of ending them";
  EXPECT_EQ(report.hazards, 0U);
}

TEST(Encode, NeverAnIntraRangeOfZeroForFap4) {
  // The reference decoder would install its default ranges.
  fap::Sequence clip;
  for (int i = 0; i < 20; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(4, 20 * (i % 3));
    clip.frames.push_back(frame);
  }
  auto decoded = fba::decode(*fba::encode(clip));
  ASSERT_TRUE(decoded);
  const auto& range = decoded->planes[0].face_settings->range;
  EXPECT_GT(range[fba::kIntraMax][4] + range[fba::kIntraMin][4], 0);
}

TEST(Encode, AnIntraPlaneWhereAJumpWouldWidenAllRanges) {
  fap::Sequence clip;
  test::Random random(5);
  for (int i = 0; i < 600; ++i) {
    fap::Frame frame;
    frame.number = i;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const int size = fap::info(fap).quant_step;
      frame.set(fap, (i < 300 ? 0 : 900 * size) + random.range(-20, 20) * size);
    }
    clip.frames.push_back(frame);
  }
  fba::EncodeOptions options = fba::file_options();
  fba::EncodeReport split;
  auto two = fba::encode(clip, options, {}, &split);
  options.extra_intra = false;
  fba::EncodeReport whole;
  auto one = fba::encode(clip, options, {}, &whole);
  ASSERT_TRUE(one);
  ASSERT_TRUE(two);
  EXPECT_EQ(whole.intra_planes, 1U);
  EXPECT_EQ(split.intra_planes, 2U);
  EXPECT_LT(two->size(), one->size());
  expect_same_values(filled(*one, false), filled(*two, false));
}

TEST(Encode, StillPlanesCanBeSkipped) {
  fap::Sequence clip;
  for (int i = 0; i < 100; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, i < 20 || i > 70 ? 10 * (i % 7) : 60);
    clip.frames.push_back(frame);
  }
  fba::EncodeOptions options = fba::file_options();
  options.skip_still = true;
  fba::EncodeReport report;
  auto stream = fba::encode(clip, options, {}, &report);
  ASSERT_TRUE(stream);
  EXPECT_GT(report.skipped, 40U);
  EXPECT_LT(stream->size(), fba::encode(clip, fba::file_options())->size());
  expect_same_values(filled(*fba::encode(clip), false), filled(*stream, false));
}

TEST(Encode, SmallMotionCanBeStilled) {
  fap::Sequence clip = talking_clip(3, 50);
  for (fap::Frame& frame : clip.frames) frame.set(3, 100 + int(frame.number % 4));
  fba::EncodeOptions options = fba::file_options();
  options.still_below = 5;
  fba::EncodeReport report;
  auto stream = fba::encode(clip, options, {}, &report);
  ASSERT_TRUE(stream);
  EXPECT_EQ(report.stilled, 1U);
  const fap::Sequence shown = filled(*stream, false);
  for (const fap::Frame& frame : shown.frames) EXPECT_NEAR(frame.value[3], 101, 2);
}

TEST(Encode, BlendsAndIntensitiesStayWithin63) {
  for (int quant = 1; quant <= 31; ++quant) {
    fap::Sequence clip;
    for (int i = 0; i < 64; ++i) {
      fap::Frame frame;
      frame.number = i;
      frame.mask.set(1).set(2);
      frame.viseme = {3, 4, i, false};
      frame.expression = {1, 63 - i, 2, i, false, false};
      clip.frames.push_back(frame);
    }
    fba::LiveEncoder live({.fap_quant = quant});
    auto decoded = fba::decode(*fba::encode(clip, {.fap_quant = quant}));
    ASSERT_TRUE(decoded);
    for (std::size_t i = 0; i < 64; ++i) {
      ASSERT_TRUE(live.write(clip.frames[i]));
      for (const fap::Frame& frame : {decoded->planes[i].face, live.reconstruction()}) {
        EXPECT_LE(frame.viseme.blend, 63) << "fap_quant " << quant;
        EXPECT_LE(frame.expression.intensity2, 63);
        EXPECT_LT(std::abs(frame.viseme.blend - int(i)), quant);
        EXPECT_LT(std::abs(frame.expression.intensity1 - int(63 - i)), quant);
      }
    }
  }
}

TEST(Encode, CodesBodies) {
  test::Random random(11);
  std::vector<fba::BodyFrame> body(30);
  for (std::size_t i = 0; i < body.size(); ++i) {
    body[i].number = std::int64_t(i) * 2;
    for (const std::size_t bap : {1, 40, 181, 296}) {
      if (i > 3 && random.chance(20)) continue;
      body[i].mask.set(bap);
      body[i].value[bap] = random.range(-200, 200) * (bap == 1 || bap == 40 ? 100 : 1);
    }
    body[i].mask.set(7);  // stays at 0
  }
  for (const bool with_face : {false, true}) {
    fap::Sequence face;
    if (with_face) face = talking_clip(2, 25);
    fba::EncodeReport report;
    auto stream = fba::encode(face, fba::file_options(), body, &report);
    ASSERT_TRUE(stream) << stream.error().describe();
    auto decoded = fba::decode(*stream);
    ASSERT_TRUE(decoded);
    fba::BodyFrame held;
    std::size_t next = 0;
    for (const fba::Plane& plane : decoded->planes) {
      ASSERT_TRUE(plane.body);
      EXPECT_EQ(plane.body->mask.count(), 4U);
      if (next < body.size() && body[next].number == plane.number) {
        for (std::size_t bap = 1; bap <= std::size_t(fba::kBapCount); ++bap) {
          if (body[next].mask[bap]) held.value[bap] = body[next].value[bap];
        }
        ++next;
      }
      for (std::size_t slot = 0; slot < fba::kBapOrder.size(); ++slot) {
        const std::size_t bap = fba::kBapOrder[slot];
        if (!plane.body->mask[bap]) continue;
        EXPECT_LE(std::abs(plane.body->value[bap] - held.value[bap]), fba::kBapSteps[slot] / 2);
      }
    }
    EXPECT_EQ(next, body.size());
    EXPECT_EQ(decoded->planes.size(), with_face ? 30U + 13U - 1U : 30U);
  }
}

TEST(Encode, LimitsOfABody) {
  std::vector<fba::BodyFrame> body(80);
  for (std::size_t i = 0; i < body.size(); ++i) {
    body[i].number = std::int64_t(i);
    for (std::size_t bap = 1; bap <= 40; ++bap) {
      body[i].mask.set(bap);
      body[i].value[bap] = int(20000 * std::sin(0.1 * double(i + bap)));
    }
  }
  fba::EncodeOptions options = fba::file_options();
  options.max_rms = 3;
  fba::EncodeReport report;
  auto stream = fba::encode({}, options, body, &report);
  ASSERT_TRUE(stream) << stream.error().describe();
  EXPECT_LE(report.rms_other, 3);
  EXPECT_GT(report.rms_other, 0.5);
  EXPECT_LT(stream->size(), fba::encode({}, fba::file_options(), body)->size());
}

TEST(Encode, SaysWhatIsWrong) {
  const fap::Sequence clip = talking_clip(1, 5);
  EXPECT_EQ(fba::encode({}).error().code, Code::invalid_argument);
  EXPECT_EQ(fba::encode(clip, {.bap_quant = 32}).error().code, Code::invalid_argument);
  EXPECT_EQ(fba::encode(clip, {.max_rms = -1}).error().code, Code::invalid_argument);
  EXPECT_EQ(fba::encode(clip, {.max_bits_per_second = NAN}).error().code, Code::invalid_argument);
}

}  // namespace encode_test
}  // namespace animeme

// Filling a decoded stream: what becomes of FAPs that are not coded is said by the mask types.
#include "codec/decode/fill.h"

#include <gtest/gtest.h>

#include "codec/encode/encoder.h"
#include "tests/support/reference_streams.h"

namespace animeme::fba {
namespace fill_test {

/// An intra plane: mask types of some groups, and the values that are coded.
struct Coded {
  std::vector<std::pair<int, MaskType>> types;
  std::vector<std::pair<int, std::int32_t>> values;
  bool intra = true;
  std::optional<std::uint32_t> skip;
};

DecodedStream stream_of(const std::vector<Coded>& planes) {
  Encoder encoder;
  for (const Coded& plane : planes) {
    FaceSettings settings;
    settings.fap_quant = 0;
    settings.send_range = {true, true, true, true};
    for (auto& range : settings.range) range.fill(31);
    for (const auto& [group, type] : plane.types) settings.mask_type[std::size_t(group - 1)] = type;
    fap::Frame frame;
    for (const auto& [fap, value] : plane.values) frame.set(fap, value);
    settings.mask = frame.mask;
    PlaneInput input;
    input.intra = plane.intra;
    input.temporal.skip = plane.skip;
    if (plane.intra) input.face_settings = &settings;
    input.face = &frame;
    const Result<void> written = encoder.write(input);
    EXPECT_TRUE(written) << (written ? "" : written.error().describe());
  }
  const Result<DecodedStream> decoded = decode(encoder.finish());
  EXPECT_TRUE(decoded) << (decoded ? "" : decoded.error().describe());
  return decoded ? *decoded : DecodedStream{};
}

fap::Sequence filled(const DecodedStream& stream, const fap::FillOptions& options = {}) {
  Result<fap::Sequence> result = fill(stream, options);
  EXPECT_TRUE(result) << (result ? "" : result.error().describe());
  return result ? *result : fap::Sequence{};
}

TEST(FillStream, RulesOfTheMaskTypes) {
  FaceSettings settings;
  settings.mask_type[0] = MaskType::all;
  settings.mask_type[1] = MaskType::interpolate;
  settings.mask_type[2] = MaskType::hold;
  const fap::GroupRules rules = group_rules(settings);
  EXPECT_EQ(rules[0], fap::GroupRule::hold);
  EXPECT_EQ(rules[1], fap::GroupRule::interpolate);
  EXPECT_EQ(rules[2], fap::GroupRule::hold);
  EXPECT_EQ(rules[9], fap::GroupRule::hold);
}

TEST(FillStream, Type2FollowsAndType1Holds) {
  // FAP 7 has a value of its own, then group 2 codes FAP 6 alone.
  for (const MaskType type : {MaskType::hold, MaskType::interpolate}) {
    const DecodedStream stream = stream_of({{{{2, MaskType::hold}}, {{6, 10}, {7, 20}}},
                                            {{{2, type}}, {{6, 30}}},
                                            {{}, {{6, 40}}, false}});
    const fap::Sequence f = filled(stream);
    ASSERT_EQ(f.frames.size(), 3u);
    const bool follows = type == MaskType::interpolate;
    EXPECT_EQ(f.frames[0].value[7], 20);
    EXPECT_EQ(f.frames[1].value[7], follows ? 30 : 20);
    EXPECT_EQ(f.frames[2].value[7], follows ? 40 : 20);
    // Group 8 is of type 0: the outer lip does not follow, and was never shown.
    EXPECT_FALSE(f.frames[2].mask[53]);
    EXPECT_EQ(f.frames[2].value[53], 0);
  }
}

TEST(FillStream, NeverSentIsNeutral) {
  const DecodedStream stream = stream_of({{{{3, MaskType::hold}}, {{19, 900}}}});
  EXPECT_EQ(filled(stream).frames[0].value[20], 0);
  EXPECT_EQ(filled(stream, {.like_public_decoder = true}).frames[0].value[20], 900);
}

TEST(FillStream, LipsFollowUnderType2) {
  const DecodedStream stream = stream_of(
      {{{{2, MaskType::interpolate}, {8, MaskType::interpolate}}, {{8, 5}, {12, 6}, {60, 7}}}});
  const fap::Frame f = filled(stream).frames.at(0);
  EXPECT_EQ(f.value[9], 5);
  EXPECT_EQ(f.value[55], 5);
  EXPECT_EQ(f.value[56], 5);
  EXPECT_EQ(f.value[13], 6);  // the other side comes before the outer lip
  EXPECT_EQ(f.value[59], 7);
  EXPECT_FALSE(filled(stream, {.like_public_decoder = true}).frames.at(0).mask[55]);
}

TEST(FillStream, ASourceThatIsNoLongerCodedLeavesItsValue) {
  const DecodedStream stream = stream_of({{{{4, MaskType::interpolate}}, {{31, 100}}},
                                          {{{4, MaskType::interpolate}}, {{33, 50}}},
                                          {{{4, MaskType::none}}, {}}});
  const fap::Sequence f = filled(stream);
  ASSERT_EQ(f.frames.size(), 3u);
  for (const fap::Frame& frame : f.frames) {
    EXPECT_EQ(frame.value[31], 100);
    EXPECT_EQ(frame.value[32], 100);
  }
  EXPECT_EQ(f.frames[2].value[33], 50);
  EXPECT_EQ(f.frames[2].value[34], 50);
}

TEST(FillStream, SkippedFramesHoldOrInterpolate) {
  const DecodedStream stream =
      stream_of({{{{5, MaskType::interpolate}}, {{39, 10}}, true, 3}, {{}, {{39, 50}}, false}});
  const fap::Sequence held = filled(stream);
  const fap::Sequence smooth = filled(stream, {.interpolate = true});
  ASSERT_EQ(held.frames.size(), 5u);
  ASSERT_EQ(smooth.frames.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(held.frames[i].value[40], i < 4 ? 10 : 50);
    EXPECT_EQ(smooth.frames[i].value[40], 10 + 10 * int(i));
  }
}

TEST(FillStream, MaxFramesBoundsSkips) {
  const DecodedStream stream =
      stream_of({{{{5, MaskType::hold}}, {{39, 10}}, true, 100000}, {{}, {{39, 50}}, false}});
  const Result<fap::Sequence> f = fill(stream, {.max_frames = 1000});
  ASSERT_FALSE(f);
  EXPECT_EQ(f.error().code, Code::out_of_range);
}

TEST(FillStream, WithoutAFace) { EXPECT_TRUE(filled(DecodedStream{}).frames.empty()); }

bool all_types_are(const DecodedStream& stream, MaskType a, MaskType b) {
  return std::all_of(stream.planes.begin(), stream.planes.end(), [&](const Plane& plane) {
    return !plane.face_settings ||
           std::all_of(
               plane.face_settings->mask_type.begin(), plane.face_settings->mask_type.end(),
               [&](MaskType type) { return type == a || type == b || type == MaskType::all; });
  });
}

TEST(FillStream, ReferenceStreams) {
  int streams = 0, held = 0, mixed = 0;
  for (const auto& path : test::reference_streams()) {
    const Result<DecodedStream> stream = decode(test::read_bytes(test::with(path, ".fba")));
    if (!stream) continue;  // tests of the decoder say which
    const fap::Sequence coded = face_sequence(*stream);
    const fap::FillOptions options{.keep_high_level = true};
    const fap::Sequence f = filled(*stream, options);
    ASSERT_EQ(f.frames.size(), coded.frames.empty() ? 0 : coded.frames.back().number + 1);
    for (const fap::Frame& frame : coded.frames) {
      const fap::Frame& shown = f.frames[std::size_t(frame.number)];
      ASSERT_EQ(frame.mask & ~shown.mask, fap::Mask()) << path;
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        if (!frame.mask[fap]) continue;
        ASSERT_EQ(shown.value[fap], frame.value[fap]) << path;
      }
    }
    ++streams;
    // Where no group interpolates, text that derives nothing gives the same.
    if (all_types_are(*stream, MaskType::none, MaskType::hold)) {
      const Result<fap::Sequence> text =
          fap::fill(coded, {.mirror = false, .lips = false, .keep_high_level = true});
      ASSERT_TRUE(text);
      EXPECT_EQ(f, *text) << path;
      ++held;
    } else {
      ++mixed;
    }
  }
  EXPECT_GE(streams, 50);
  EXPECT_GT(held, 0);
  EXPECT_GT(mixed, 0);
}

TEST(FillStream, AgreesWithTextThatPrefersPartners) {
  // All groups of type 2, one mask: text that always follows the partner shows the same.
  std::vector<std::pair<int, MaskType>> types;
  for (int group = 2; group <= 10; ++group) types.emplace_back(group, MaskType::interpolate);
  const std::vector<std::pair<int, std::int32_t>> first = {{3, 1},  {4, 2},  {7, 3},  {19, 4},
                                                           {24, 5}, {31, 6}, {56, 7}, {62, 8}};
  auto second = first;
  for (auto& [fap, value] : second) value += 100;
  const DecodedStream stream = stream_of({{types, first}, {{}, second, false}});
  const Result<fap::Sequence> text = fap::fill(face_sequence(stream), {.prefer_partner = true});
  ASSERT_TRUE(text);
  EXPECT_EQ(filled(stream), *text);
}

}  // namespace fill_test
}  // namespace animeme::fba

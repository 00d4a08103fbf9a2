// Hazards: bits that are legal and lead other decoders astray. First where they are found, then
// that encode() and LiveEncoder go around them.
#include "codec/encode/stream_trace_internal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "codec/encode/encoder.h"
#include "codec/encode/live.h"
#include "tests/support/random_clip.h"

namespace animeme {
namespace stream_trace_test {

using fba::internal::find_hazards;
using fba::internal::Hazard;
using fba::internal::StreamTrace;
using Bytes = std::vector<std::uint8_t>;

// Bits as text, filled up with ones.
Bytes bytes_of(const std::string& bits) {
  Bytes bytes((bits.size() + 7) / 8, 0xFF);
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (bits[i] == '0') bytes[i / 8] &= std::uint8_t(~(0x80U >> (i % 8)));
  }
  return bytes;
}

std::string zeros(std::size_t count) { return std::string(count, '0'); }
std::string ones(std::size_t count) { return std::string(count, '1'); }

class Alignment : public testing::TestWithParam<std::size_t> {};

TEST_P(Alignment, FindsAFalseStartCode) {
  const std::size_t at = GetParam() + 1;
  const auto hazards = find_hazards(bytes_of(ones(at) + zeros(23) + "1"), {});
  ASSERT_EQ(hazards.size(), 1U);
  EXPECT_EQ(hazards[0].kind, Hazard::Kind::start_code);
  EXPECT_EQ(hazards[0].bit, at);
  // More zeros are one all the more; the code is made of the last 23.
  const auto longer = find_hazards(bytes_of(ones(at) + zeros(40) + "1"), {});
  ASSERT_EQ(longer.size(), 1U);
  EXPECT_EQ(longer[0].bit, at + 40 - 23);
}

TEST_P(Alignment, TwentyTwoZerosAreNoStartCode) {
  EXPECT_TRUE(find_hazards(bytes_of(ones(GetParam() + 1) + zeros(22) + "1"), {}).empty());
  EXPECT_TRUE(find_hazards(bytes_of(zeros(22) + "1"), {}).empty());
}

TEST_P(Alignment, ZerosUpToTheEndAreNoStartCode) {
  const std::size_t at = GetParam();
  EXPECT_TRUE(find_hazards(bytes_of(ones(at) + zeros(64 - at)), {}).empty());
}

TEST_P(Alignment, KnowsRealStartCodes) {
  const std::size_t at = GetParam();
  StreamTrace trace;
  trace.start_codes = {at};
  const std::string code = zeros(23) + "1" + "10111011";
  EXPECT_TRUE(find_hazards(bytes_of(ones(at) + code), trace).empty());
  // Zeros before it do not make it another one, a second one is not excused by it.
  trace.start_codes = {at + 9};
  EXPECT_TRUE(find_hazards(bytes_of(ones(at) + zeros(9) + code), trace).empty());
  const auto hazards = find_hazards(bytes_of(ones(at) + zeros(9) + code + zeros(23) + "1"), trace);
  ASSERT_EQ(hazards.size(), 1U);
  EXPECT_EQ(hazards[0].bit, at + 9 + 32);
}

TEST_P(Alignment, FindsZerosThatReachPastASegment) {
  for (std::size_t tail = 8; tail <= 22; ++tail) {
    const std::size_t begin = GetParam();
    const std::string segment = "1011" + zeros(tail);
    StreamTrace trace;
    trace.segments = {{begin, begin + segment.size()}};
    const auto traps_behind = [&](const std::string& behind) {
      return find_hazards(bytes_of(ones(begin) + segment + behind), trace);
    };
    EXPECT_TRUE(traps_behind(zeros(21 - std::min<std::size_t>(tail, 21)) + "1").size() ==
                (tail == 22 ? 1U : 0U))
        << tail;
    const auto found = traps_behind(zeros(22 - tail) + "1");
    ASSERT_EQ(found.size(), 1U) << tail;
    EXPECT_EQ(found[0].kind, Hazard::Kind::look_ahead);
    EXPECT_EQ(found[0].bit, begin + 4);
  }
}

TEST_P(Alignment, LooksNoFurtherThanFourteenBits) {
  // 7 zeros and 14 are too few, whatever follows; only the segment's own zeros count.
  const std::size_t begin = GetParam();
  StreamTrace trace;
  trace.segments = {{begin, begin + 8}};
  EXPECT_TRUE(
      find_hazards(bytes_of(ones(begin) + "1" + zeros(7) + zeros(15) + "1"), trace).empty());
  trace.segments = {{begin + 1, begin + 8}};
  EXPECT_TRUE(find_hazards(bytes_of(ones(begin) + zeros(8) + zeros(14) + "1"), trace).empty());
}

INSTANTIATE_TEST_SUITE_P(Bits, Alignment, testing::Range<std::size_t>(0, 8));

TEST(Hazards, AStartCodeIsToFollowTheLastByte) {
  StreamTrace trace;
  trace.segments = {{0, 32}};
  EXPECT_EQ(find_hazards(bytes_of(ones(24) + zeros(8)), trace).size(), 1U);
  EXPECT_TRUE(find_hazards(bytes_of(ones(25) + zeros(7)), trace).empty());
}

TEST(Hazards, AllAreFoundInOrder) {
  StreamTrace trace;
  trace.segments = {{0, 10}, {80, 92}};
  const std::string bits = "11" + zeros(22) + "1" + ones(15) + zeros(30) + "1" + ones(9) + "11" +
                           zeros(10) + zeros(12) + "1";
  std::vector<std::size_t> found;
  for (const Hazard& hazard : find_hazards(bytes_of(bits), trace)) found.push_back(hazard.bit);
  EXPECT_EQ(found, (std::vector<std::size_t>{2, 47, 82}));
}

// --- encoders

bool bit_at(const Bytes& bytes, std::size_t bit) {
  return bit < bytes.size() * 8 && (bytes[bit / 8] >> (7 - bit % 8) & 1) != 0;
}

// Hazards that can be seen from outside: false start codes, and zeros behind planes.
std::size_t count_traps(const Bytes& bytes) {
  const auto decoded = fba::decode(bytes);
  EXPECT_TRUE(decoded) << decoded.error().describe();
  if (!decoded) return 0;
  std::vector<std::size_t> real = {0, bytes.size() * 8 - 32};
  std::size_t count = 0;
  for (const fba::Plane& plane : decoded->planes) {
    if (plane.start_code) real.push_back(std::size_t(plane.bit_begin) - 32);
    const std::size_t end = std::size_t(plane.bit_end);
    std::size_t tail = 0;
    while (!bit_at(bytes, end - 1 - tail)) ++tail;
    std::size_t behind = 0;
    while (behind < 14 && !bit_at(bytes, end + behind)) ++behind;
    count += tail + behind >= 22 ? 1 : 0;
  }
  std::size_t run = 0;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    if (!bit_at(bytes, bit)) {
      ++run;
      continue;
    }
    const bool is_real = run >= 23 && std::find(real.begin(), real.end(), bit - 23) != real.end();
    count += run >= 23 && !is_real ? 1 : 0;
    run = 0;
  }
  return count;
}

// Ears at rest make the ranges end in 20 zeros, and a viseme of the highest numbers begins with
// zeros.
fap::Sequence header_trap() {
  fap::Sequence clip;
  for (int i = 0; i < 5; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.mask.set(1);
    frame.viseme = {14, 14, 63, false};
    for (const int fap : {65, 66, 67, 68}) frame.set(fap, 0);
    clip.frames.push_back(frame);
  }
  return clip;
}

// Every plane begins with the highest symbols, which are zeros in the stream, behind a viseme at
// random: every few hundred planes the zeros reach back into it.
fap::Sequence look_ahead_traps(std::uint64_t seed, int frames) {
  test::Random random(seed);
  fap::Sequence clip;
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.mask.set(1);
    frame.viseme = {random.range(0, 14), random.range(0, 14), random.range(0, 63), false};
    for (const int fap : {3, 4, 5, 6}) frame.set(fap, 60 * fap::info(fap).quant_step);
    frame.set(7, random.range(-100, 100));
    clip.frames.push_back(frame);
  }
  return clip;
}

TEST(Hazards, AHeaderMayHoldOne) {
  fba::EncodeReport report;
  const auto stream = fba::encode(header_trap(), {}, {}, &report);
  ASSERT_TRUE(stream);
  EXPECT_GT(report.retries, 0U) << "not the clip that this test wants";
  EXPECT_EQ(report.hazards, 0U);
  EXPECT_EQ(count_traps(*stream), 0U);
}

TEST(Hazards, ABodyHeaderMayHoldOne) {
  // The first BAP of the last group alone: its mask, gender and coding type are 23 zeros.
  fba::BodyFrame body;
  body.mask.set(fba::kBapOrder[fba::kBapOrder.size() - fba::kBodyGroupSizes.back()]);
  fba::EncodeReport report;
  const auto stream = fba::encode({}, {}, std::span(&body, 1), &report);
  ASSERT_TRUE(stream);
  EXPECT_EQ(report.hazards, 0U);
  EXPECT_EQ(count_traps(*stream), 0U);
  fba::LiveEncoder live;
  auto unit = live.write({}, 0, &body);
  ASSERT_TRUE(unit);
  const Bytes end = live.finish();
  unit->insert(unit->end(), end.begin(), end.end());
  EXPECT_EQ(count_traps(*unit), 0U);
}

TEST(Hazards, EncodeAvoidsManyInOneClip) {
  // So many that no plan of the whole clip would be free of them by luck.
  std::size_t retries = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const fap::Sequence clip = look_ahead_traps(seed, 2000);
    fba::EncodeReport report;
    const auto stream = fba::encode(clip, {.intra_seconds = 1 / 25.0}, {}, &report);
    ASSERT_TRUE(stream);
    retries += report.retries;
    EXPECT_EQ(report.hazards, 0U);
    EXPECT_EQ(count_traps(*stream), 0U);
    const auto decoded = fba::decode(*stream);
    ASSERT_EQ(decoded->planes.size(), clip.frames.size());
    for (std::size_t i = 0; i < clip.frames.size(); ++i) {
      ASSERT_EQ(decoded->planes[i].face.viseme, clip.frames[i].viseme);
      ASSERT_EQ(decoded->planes[i].face.value[3], clip.frames[i].value[3]);
    }
  }
  EXPECT_GT(retries, 0U) << "not the clips that this test wants";
}

TEST(Hazards, LiveEncoderAvoidsThem) {
  // The same planes, written without choice, hold hazards: the unit would have.
  const fap::Sequence clip = look_ahead_traps(1, 2000);
  std::size_t without_choice = 0;
  fba::FaceSettings settings;
  settings.send_range.fill(true);
  settings.mask = clip.frames[0].mask;
  settings.mask_type[0] = settings.mask_type[1] = fba::MaskType::hold;
  for (const int fap : {3, 4, 5, 6, 7}) settings.range[fba::kIntraMax][std::size_t(fap)] = 1;
  settings.range[fba::kIntraMin][7] = 1;
  fba::Encoder plain({fba::PlaneStartCodes::all, false});
  fba::LiveEncoder live({.intra_seconds = 1 / 25.0});
  Bytes stream;
  for (const fap::Frame& frame : clip.frames) {
    fba::PlaneInput plane;
    plane.intra = true;
    plane.face = &frame;
    plane.face_settings = &settings;
    ASSERT_TRUE(plain.write(plane));
    plain.end_unit();
    without_choice += plain.hazard() ? 1 : 0;
    EXPECT_EQ(plain.hazard().has_value(), !plain.hazard_bits().empty());
    plain.take();
    const auto unit = live.write(frame);
    ASSERT_TRUE(unit);
    stream.insert(stream.end(), unit->begin(), unit->end());
  }
  EXPECT_GT(without_choice, 0U) << "not the clip that this test wants";
  const Bytes end = live.finish();
  stream.insert(stream.end(), end.begin(), end.end());
  EXPECT_EQ(count_traps(stream), 0U);
}

TEST(Hazards, ADroppedPlaneLeavesNothing) {
  fap::Frame frame;
  frame.set(3, 60 * 4);
  fba::FaceSettings settings;
  settings.send_range.fill(true);
  settings.mask = frame.mask;
  settings.mask_type[1] = fba::MaskType::hold;
  settings.range[fba::kIntraMax][3] = 1;
  fba::PlaneInput plane;
  plane.intra = true;
  plane.face = &frame;
  plane.face_settings = &settings;
  fba::Encoder once({fba::PlaneStartCodes::all, false});
  ASSERT_TRUE(once.write(plane));
  fba::Encoder twice({fba::PlaneStartCodes::all, false});
  fba::FaceSettings wide = settings;
  wide.range[fba::kIntraMax][3] = 2;
  plane.face_settings = &wide;
  ASSERT_TRUE(twice.write(plane));
  twice.end_unit();
  twice.drop();
  plane.intra = false;
  EXPECT_EQ(twice.write(plane).error().code, Code::invalid_argument);
  plane.intra = true;
  plane.face_settings = &settings;
  ASSERT_TRUE(twice.write(plane));
  EXPECT_EQ(twice.finish(), once.finish());
}

}  // namespace stream_trace_test
}  // namespace animeme

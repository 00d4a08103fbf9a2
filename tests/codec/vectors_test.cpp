// The two hand-annotated vectors of codec/bitstream.md, section 18, and small streams
// written bit by bit.
#include <gtest/gtest.h>

#include "codec/decode/decoder.h"
#include "codec/encode/encoder.h"
#include "codec/syntax/arith.h"
#include "codec/syntax/bits.h"

namespace animeme {
namespace vectors_test {

std::vector<std::uint8_t> from_hex(std::string_view hex) {
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    out.push_back(std::uint8_t(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  }
  return out;
}

const char* const kVisemeStream = "000001bab19001b492492402aa9927f094bf000001b1";
const char* const kJawStream =
    "000001bab19002960002492490f8bffff07fffe1ffffc3ffffc64e4ca094c7000001b1";

TEST(Vectors, VisemeOnlyDecodes) {
  auto decoded = fba::decode(from_hex(kVisemeStream));
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(decoded->planes.size(), 2u);
  EXPECT_EQ(decoded->rate, (fap::Rate{25, 1}));
  const fba::Plane& first = decoded->planes[0];
  EXPECT_TRUE(first.intra);
  EXPECT_EQ(first.bit_begin, 32);
  EXPECT_EQ(first.bit_end - first.bit_begin, 80);
  EXPECT_EQ(first.face.viseme, (fap::Viseme{5, 0, 0, false}));
  EXPECT_EQ(first.face_settings->fap_quant, 1);
  EXPECT_EQ(first.face_settings->mask_type[0], fba::MaskType::hold);
  EXPECT_EQ(decoded->planes[1].bit_end - decoded->planes[1].bit_begin, 25);
  EXPECT_EQ(decoded->planes[1].face.viseme, (fap::Viseme{5, 3, 20, false}));
  EXPECT_TRUE(decoded->warnings.empty());
}

TEST(Vectors, JawWithSkippedFramesDecodes) {
  auto decoded = fba::decode(from_hex(kJawStream));
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(decoded->planes.size(), 4u);
  const int values[] = {104, 128, 128, 88};
  const int numbers[] = {0, 1, 2, 5};
  const int sizes[] = {175, 11, 15, 11};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(decoded->planes[i].face.value[3], values[i]);
    EXPECT_EQ(decoded->planes[i].number, numbers[i]);
    EXPECT_EQ(decoded->planes[i].bit_end - decoded->planes[i].bit_begin, sizes[i]);
  }
  EXPECT_DOUBLE_EQ(decoded->planes[3].seconds, 0.2);
}

TEST(Vectors, JawIsEncodedToTheSameBytes) {
  fap::Sequence clip;
  clip.rate = {25, 1};
  const int values[] = {100, 130, 130, 87};
  const int numbers[] = {0, 1, 2, 5};
  fba::FaceSettings settings;
  settings.fap_quant = 2;
  settings.mask_type[1] = fba::MaskType::hold;
  settings.mask.set(3);
  settings.send_range = {true, true, true, true};
  settings.range[fba::kIntraMax][3] = 2;
  settings.range[fba::kPredictiveMax][3] = 1;
  settings.range[fba::kPredictiveMin][3] = 1;
  fba::Encoder encoder;
  for (int i = 0; i < 4; ++i) {
    fap::Frame frame;
    frame.number = numbers[i];
    frame.set(3, values[i]);
    fba::PlaneInput plane;
    plane.intra = i == 0;
    plane.face = &frame;
    plane.face_settings = &settings;
    if (i == 0) plane.temporal.rate = fba::code_rate(clip.rate);
    if (i == 2) plane.temporal.skip = 2;
    ASSERT_TRUE(encoder.write(plane));
  }
  EXPECT_EQ(encoder.finish(), from_hex(kJawStream));
}

TEST(Vectors, EmptySegmentIsTheBits01) {
  fba::BitWriter out;
  fba::SegmentEncoder(out).flush();
  out.bits(0, 6);
  EXPECT_EQ(out.bytes().front(), 0x40);
}

TEST(Headers, SequenceAndObjectHeadersMayComeBefore) {
  std::vector<std::uint8_t> stream = from_hex("000001b061000001b20102000001b58947");
  const std::vector<std::uint8_t> raw = from_hex(kVisemeStream);
  stream.insert(stream.end(), raw.begin(), raw.end());
  auto decoded = fba::decode(stream);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_EQ(decoded->planes.size(), 2u);
}

TEST(Headers, ShortObjectHeaderIsAccepted) {
  std::vector<std::uint8_t> stream = from_hex("000001b061000001b523");
  const std::vector<std::uint8_t> raw = from_hex(kVisemeStream);
  stream.insert(stream.end(), raw.begin(), raw.end());
  EXPECT_TRUE(fba::decode(stream));
}

TEST(Headers, VideoObjectIsNamed) {
  auto decoded = fba::decode(from_hex("000001b001000001b58913000001b60000"));
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, Code::unsupported);
  EXPECT_NE(decoded.error().message.find("video"), std::string::npos);
}

TEST(Headers, SomethingElseIsRefused) {
  auto decoded = fba::decode(from_hex("52494646aabbccdd57415645"));
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, Code::syntax);
  EXPECT_EQ(decoded.error().where.bit, 0);
  auto empty = fba::decode({});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, Code::truncated);
}

TEST(Headers, DctModeIsToldApart) {
  // Intra, face, no rate, no time code, no skip, quant 1, ten empty groups, gender 0, DCT 1.
  fba::BitWriter out;
  out.start_code(fba::kObjectStart);
  out.bits(0b101000, 6);
  out.bits(1, 5);
  for (int group = 0; group < 10; ++group) out.bits(0b100, 3);
  out.bits(0b01, 2);
  for (int i = 0; i < 64; ++i) out.bit(1);
  out.stuff();
  out.start_code(fba::kSequenceEnd);
  auto decoded = fba::decode(out.bytes());
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, Code::unsupported);
  EXPECT_NE(decoded.error().message.find("DCT"), std::string::npos);
  EXPECT_EQ(decoded.error().where.bit, 32 + 6 + 5 + 30 + 1);
}

TEST(Headers, PlanesThatCodeNothingSkipNothing) {
  // A face plane that skips 17 frames, a plane whose object mask is 0, a face plane again.
  fba::BitWriter out;
  out.start_code(fba::kObjectStart);
  out.bits(0b101001, 6);  // intra, face, no rate, no time code, skip
  out.bits(15, 4);
  out.bits(2, 4);
  out.bits(1, 5);
  for (int group = 0; group < 10; ++group) out.bits(0b100, 3);
  out.bits(0b000000, 6);  // gender, coding type, no ranges
  out.bits(0b01, 2);      // empty segment
  out.bits(0b000, 3);
  out.bits(0b001001, 6);
  out.stuff();
  out.start_code(fba::kSequenceEnd);
  auto decoded = fba::decode(out.bytes());
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(decoded->planes.size(), 3u);
  EXPECT_EQ(decoded->planes[1].number, 18);
  EXPECT_EQ(decoded->planes[2].number, 19);
}

TEST(Headers, ShortPlanesBeforeAStartCodeAreNotStuffing) {
  // Predictive planes of 6 bits, so many that the last one lies within the byte before the end
  // code, whatever the alignment.
  fba::FaceSettings settings;
  for (int planes = 2; planes < 12; ++planes) {
    for (const auto codes : {fba::PlaneStartCodes::none, fba::PlaneStartCodes::intra}) {
      fba::Encoder encoder({codes, false});
      fap::Frame frame;
      for (int i = 0; i < planes; ++i) {
        fba::PlaneInput plane;
        plane.intra = i == 0 || i == planes / 2;
        plane.face = &frame;
        plane.face_settings = &settings;
        ASSERT_TRUE(encoder.write(plane));
      }
      auto decoded = fba::decode(encoder.finish());
      ASSERT_TRUE(decoded) << decoded.error().describe();
      EXPECT_EQ(decoded->planes.size(), std::size_t(planes));
      EXPECT_TRUE(decoded->warnings.empty());
    }
  }
}

TEST(Rates, AreCodedExactlyOrNotAtAll) {
  EXPECT_EQ(fba::code_rate({25, 1}), (fba::CodedRate{25, 0, false}));
  EXPECT_EQ(fba::code_rate({25, 2}), (fba::CodedRate{12, 8, false}));
  EXPECT_EQ(fba::code_rate({30000, 1001}), (fba::CodedRate{30, 0, true}));
  EXPECT_EQ(fba::code_rate({1, 3}), std::nullopt);
  EXPECT_EQ(fba::code_rate({256, 1}), std::nullopt);
  for (unsigned sixteenths = 1; sixteenths <= 255 * 16 + 15; ++sixteenths) {
    for (const bool offset : {false, true}) {
      const fba::CodedRate coded{std::uint8_t(sixteenths / 16), std::uint8_t(sixteenths % 16),
                                 offset};
      auto again = fba::code_rate(coded.rate());
      ASSERT_TRUE(again);
      EXPECT_EQ(again->rate(), coded.rate());
    }
  }
}

}  // namespace vectors_test
}  // namespace animeme

// What may stand around and in planes: headers, start codes old, new and foreign, temporal headers,
// the coding type. Streams written bit by bit from the description (codec/bitstream.md, sections 1
// to 8 and 12).
#include <gtest/gtest.h>

#include "codec/decode/decoder.h"
#include "codec/encode/encoder.h"
#include "codec/syntax/arith.h"
#include "codec/syntax/bits.h"

namespace animeme {
namespace syntax_test {

// Object mask and temporal header of a plane without rate, time code and skipped frames.
void header(fba::BitWriter& out, bool intra, fba::ObjectMask mask) {
  out.bit(intra);
  out.bits(std::uint32_t(mask), 2);
  out.bits(0, intra ? 3 : 1);
}
// Of a predictive plane that skips 0 frames, so that it is too long to be taken for stuffing.
void long_header(fba::BitWriter& out, fba::ObjectMask mask) {
  out.bit(false);
  out.bits(std::uint32_t(mask), 2);
  out.bits(0b10000, 5);
}
// An intra face that codes no FAP; `dct` sets fba_object_coding_type.
void empty_face(fba::BitWriter& out, bool dct = false) {
  out.bits(1, 5);
  for (int group = 0; group < 10; ++group) out.bits(0b100, 3);
  out.bit(0);
  out.bit(dct);
  if (dct) return;
  out.bits(0, 4);
  out.bits(0b01, 2);
}
// An intra body that codes the BAP of the first slot if `one`: ranges of 60, level 7.
void small_body(fba::BitWriter& out, bool one, bool dct = false) {
  out.bits(1, 5);
  for (std::size_t group = 0; group < fba::kBodyGroupCount; ++group) {
    out.bits(one && group == 0 ? 0b101 : 0b100, 3);
    if (!one || group != 0) continue;
    for (int i = 0; i < fba::kBodyGroupSizes[0]; ++i) out.bit(i == 0);
  }
  out.bit(0);
  out.bit(dct);
  if (dct) return;
  out.bits(one ? 0xF : 0, 4);
  for (int kind = 0; one && kind < 4; ++kind) {
    for (std::size_t group = 0; group < fba::kBodyGroupCount; ++group) {
      for (int i = 0; i < fba::kBodyGroupSizes[group]; ++i) {
        if (i % 4 == 0) out.bit(1);
        if (group == 0 && i == 0) out.bits(1, 5);
      }
    }
  }
  fba::SegmentEncoder segment(out);
  if (one) segment.encode(fba::flat_interval(60 + 7, 121));
  segment.flush();
}
void end(fba::BitWriter& out) {
  out.stuff();
  out.start_code(fba::kSequenceEnd);
}
void plane_start(fba::BitWriter& out, std::uint32_t code = fba::kPlaneStart) {
  out.stuff();
  out.start_code(code);
}

// All events of a stream.
struct Trace {
  std::vector<fba::StreamInfo> infos;
  std::vector<fba::Plane> planes;
  std::vector<Error> errors;
  std::vector<std::string> warnings;
};
Trace trace(const std::vector<std::uint8_t>& bytes) {
  fba::Decoder decoder;
  decoder.push(bytes);
  decoder.finish();
  Trace out;
  for (;;) {
    auto event = decoder.next();
    if (!event) {
      if (event.error().code == Code::end_of_stream) return out;
      out.errors.push_back(event.error());
    } else if (event->kind == fba::Event::Kind::plane) {
      out.planes.push_back(event->plane);
    } else if (event->kind == fba::Event::Kind::info) {
      out.infos.push_back(event->info);
    } else {
      out.warnings.push_back(event->text);
    }
  }
}

TEST(Syntax, OldPlaneStartCodeMayFollowANewObjectCode) {
  for (const bool stuffing : {true, false}) {
    for (const std::uint32_t object : {fba::kObjectStart, fba::kOldObjectStart}) {
      fba::BitWriter out;
      out.start_code(object);
      if (stuffing) out.stuff();
      out.start_code(fba::kOldPlaneStart);
      header(out, true, fba::ObjectMask::face);
      empty_face(out);
      long_header(out, fba::ObjectMask::face);
      out.bits(0b01, 2);
      plane_start(out, fba::kOldPlaneStart);
      header(out, true, fba::ObjectMask::face);
      empty_face(out);
      end(out);
      const Trace got = trace(out.bytes());
      EXPECT_TRUE(got.errors.empty()) << got.errors[0].describe();
      EXPECT_TRUE(got.warnings.empty()) << got.warnings[0];
      ASSERT_EQ(got.planes.size(), 3U);
      EXPECT_TRUE(got.planes[0].start_code);
      EXPECT_FALSE(got.planes[1].start_code);
      EXPECT_TRUE(got.planes[2].start_code);
    }
  }
}

TEST(Syntax, HeadersMayComeBeforeTheObjectAndBetweenObjects) {
  fba::BitWriter out;
  for (int object = 0; object < 2; ++object) {
    out.start_code(fba::kSequenceStart);
    out.bits(0x61, 8);
    out.start_code(fba::kUserData);
    out.bits(0x000001, 24);  // user data may hold the beginning of a start code
    out.bits(0x55, 8);
    out.start_code(fba::kVisualObject);
    out.bit(1);
    out.bits(1, 4);
    out.bits(1, 3);
    out.bits(4, 4);
    out.stuff();
    out.start_code(fba::kUserData);
    out.bits(0x123456, 24);
    out.start_code(fba::kObjectStart);
    header(out, true, fba::ObjectMask::face);
    empty_face(out);
    out.stuff();
  }
  out.start_code(fba::kSequenceEnd);
  const Trace got = trace(out.bytes());
  EXPECT_TRUE(got.errors.empty()) << got.errors[0].describe();
  EXPECT_EQ(got.planes.size(), 2U);
  ASSERT_EQ(got.infos.size(), 2U);
  for (const fba::StreamInfo& info : got.infos) {
    EXPECT_EQ(info.profile_and_level, 0x61);
    EXPECT_EQ(info.verid, 1);
    EXPECT_EQ(info.priority, 1);
    EXPECT_TRUE(info.user_data);
    EXPECT_FALSE(info.old_start_code);
  }
}

TEST(Syntax, TheInfoOfABareObjectComesFirstAndOnce) {
  for (const std::uint32_t code : {fba::kObjectStart, fba::kOldObjectStart, fba::kPlaneStart}) {
    fba::BitWriter out;
    out.start_code(code);
    header(out, true, fba::ObjectMask::face);
    empty_face(out);
    plane_start(out, fba::kPlaneStart);
    header(out, true, fba::ObjectMask::face);
    empty_face(out);
    end(out);
    fba::Decoder decoder;
    decoder.push(out.bytes());
    decoder.finish();
    const auto first = decoder.next();
    ASSERT_TRUE(first);
    ASSERT_EQ(first->kind, fba::Event::Kind::info);
    EXPECT_EQ(first->bit, 0);
    EXPECT_EQ(first->info.old_start_code, code == fba::kOldObjectStart);
    EXPECT_FALSE(first->info.profile_and_level);
    EXPECT_EQ(trace(out.bytes()).infos.size(), 1U);
    EXPECT_EQ(fba::decode(out.bytes())->info, first->info);
  }
}

TEST(Syntax, ABodyAloneHasATemporalHeaderOfItsOwn) {
  fba::BitWriter out;
  out.start_code(fba::kObjectStart);
  out.bit(1);
  out.bits(2, 2);
  out.bit(1);  // rate 12.5
  out.bits(12, 8);
  out.bits(8, 4);
  out.bit(0);
  out.bit(1);  // time code 1:02:03
  out.bits(1, 5);
  out.bits(2, 6);
  out.bit(1);
  out.bits(3, 6);
  out.bit(1);  // 4 frames are skipped
  out.bits(4, 4);
  small_body(out, true);
  header(out, false, fba::ObjectMask::body);
  fba::SegmentEncoder segment(out);
  segment.encode(fba::flat_interval(60 - 9, 121));
  segment.flush();
  end(out);
  const Trace got = trace(out.bytes());
  EXPECT_TRUE(got.errors.empty()) << got.errors[0].describe();
  ASSERT_EQ(got.planes.size(), 2U);
  EXPECT_EQ(got.planes[0].rate, (fap::Rate{25, 2}));
  EXPECT_DOUBLE_EQ(got.planes[0].seconds, 3723);
  EXPECT_EQ(got.planes[1].number, 5);
  EXPECT_DOUBLE_EQ(got.planes[1].seconds, 3723.4);
  const std::size_t bap = fba::kBapOrder[0];
  ASSERT_TRUE(got.planes[0].body && got.planes[1].body);
  EXPECT_EQ(got.planes[0].face_settings, nullptr);
  EXPECT_EQ(got.planes[0].body->mask.count(), 1U);
  EXPECT_EQ(got.planes[0].body->value[bap], 7 * fba::kBapSteps[0]);
  EXPECT_EQ(got.planes[1].body->value[bap], -2 * fba::kBapSteps[0]);
}

TEST(Syntax, DctIsNamedAndTheNextIntraPlaneTaken) {
  for (const fba::ObjectMask mask :
       {fba::ObjectMask::face, fba::ObjectMask::body, fba::ObjectMask::face_and_body}) {
    for (const bool face_dct : {true, false}) {
      if (!face_dct && !fba::has_body(mask)) continue;
      const bool face = fba::has_face(mask);
      fba::BitWriter out;
      out.start_code(fba::kObjectStart);
      plane_start(out);
      header(out, true, mask);
      if (face) empty_face(out, face_dct);
      if (fba::has_body(mask) && !(face && face_dct)) small_body(out, false, true);
      const std::int64_t flag = std::int64_t(out.position()) - 1;
      for (int i = 0; i < 100; ++i) out.bit(1);
      plane_start(out);  // a predictive plane of the DCT run: not decodable
      header(out, false, mask);
      for (int i = 0; i < 20; ++i) out.bit(1);
      plane_start(out);
      header(out, true, mask);
      if (face) empty_face(out);
      if (fba::has_body(mask)) small_body(out, false);
      const std::size_t intra_end = out.position();
      long_header(out, mask);
      if (face) out.bits(0b01, 2);
      if (fba::has_body(mask)) out.bits(0b01, 2);
      end(out);
      const Trace got = trace(out.bytes());
      ASSERT_EQ(got.errors.size(), 1U);
      EXPECT_EQ(got.errors[0].code, Code::unsupported);
      const std::string part = face && face_dct ? "face" : "body";
      EXPECT_NE(got.errors[0].message.find("the " + part + " is coded in DCT mode"),
                std::string::npos)
          << got.errors[0].message;
      EXPECT_EQ(got.errors[0].where.bit, flag);
      ASSERT_EQ(got.planes.size(), 2U);
      EXPECT_TRUE(got.planes[0].intra);
      EXPECT_EQ(got.planes[0].bit_end, std::int64_t(intra_end));
      EXPECT_FALSE(got.planes[1].intra);
    }
  }
}

TEST(Syntax, PredictivePlanesAfterDamageWaitForAnIntraPlane) {
  // An object start code right behind damage does not bring old settings back.
  fba::BitWriter out;
  out.start_code(fba::kObjectStart);
  header(out, true, fba::ObjectMask::face);
  empty_face(out);
  plane_start(out);
  header(out, true, fba::ObjectMask::face);
  empty_face(out, true);
  out.stuff();
  out.start_code(fba::kObjectStart);
  for (int i = 0; i < 4; ++i) {
    header(out, false, fba::ObjectMask::face);
    out.bits(0b01, 2);
  }
  end(out);
  const Trace got = trace(out.bytes());
  EXPECT_EQ(got.planes.size(), 1U);
  ASSERT_EQ(got.errors.size(), 2U);
  EXPECT_EQ(got.errors[0].code, Code::unsupported);
  EXPECT_EQ(got.errors[1].code, Code::syntax);
}

TEST(Syntax, AForeignStartCodeEndsTheObject) {
  for (int code = 0; code < 256; ++code) {
    const std::uint32_t value = 0x100U + std::uint32_t(code);
    if (value == fba::kPlaneStart || value == fba::kOldPlaneStart) continue;
    fba::BitWriter out;
    out.start_code(fba::kObjectStart);
    header(out, true, fba::ObjectMask::face);
    empty_face(out);
    out.stuff();
    out.start_code(value);
    const bool known = value == fba::kSequenceEnd || value == fba::kSequenceStart ||
                       value == fba::kUserData || value == fba::kVisualObject ||
                       value == fba::kObjectStart || value == fba::kOldObjectStart;
    if (known) continue;
    for (int i = 0; i < 10; ++i) out.bits(0x55, 8);
    out.start_code(fba::kObjectStart);
    header(out, true, fba::ObjectMask::face);
    empty_face(out);
    end(out);
    const Trace got = trace(out.bytes());
    EXPECT_TRUE(got.errors.empty()) << got.errors[0].describe();
    ASSERT_EQ(got.planes.size(), 2U) << code;
    ASSERT_EQ(got.warnings.size(), 1U) << code;
    EXPECT_NE(got.warnings[0].find("start code"), std::string::npos);
  }
}

TEST(Syntax, PlanesInTheLastByteBeforeAStartCodeAreStuffing) {
  // Planes of three bits; the first comes in any case.
  for (std::size_t count = 1; count < 20; ++count) {
    fba::BitWriter out;
    out.start_code(fba::kObjectStart);
    for (std::size_t i = 0; i < count; ++i) out.bits(0b100, 3);
    end(out);
    const Trace got = trace(out.bytes());
    EXPECT_TRUE(got.errors.empty()) << got.errors[0].describe();
    const std::size_t last_byte = 3 * count / 8 * 8;
    const std::size_t read = std::max<std::size_t>(1, (last_byte + 2) / 3);
    EXPECT_EQ(got.planes.size(), read) << count;
    EXPECT_EQ(got.warnings.size(), read < count ? 1u : 0u) << count;
  }
}

TEST(Syntax, AStreamWithoutAPlaneIsAnError) {
  // Nothing, headers alone, an empty object, an object start code that has become user data.
  const std::vector<std::vector<std::uint8_t>> streams = {
      {},
      {0, 0, 1, 0xB0, 0x61},
      {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB1},
      {0, 0, 1, 0xBA, 0x7F, 0, 0, 1, 0xB1},
      {0, 0, 1, 0xB2, 0x12, 0x34, 0, 0, 1, 0xB1},
      {0, 0, 1, 0xB2, 0x12, 0x34},
  };
  for (const auto& stream : streams) {
    const Trace got = trace(stream);
    ASSERT_EQ(got.errors.size(), 1U);
    EXPECT_EQ(got.errors[0].code, Code::truncated) << got.errors[0].describe();
    EXPECT_EQ(got.errors[0].where.bit, std::int64_t(stream.size()) * 8);
    EXPECT_EQ(fba::decode(stream).error().message, got.errors[0].message);
  }
}

TEST(Syntax, BytesAfterTheEndCodeAreCounted) {
  fba::BitWriter out;
  out.start_code(fba::kObjectStart);
  header(out, true, fba::ObjectMask::face);
  empty_face(out);
  end(out);
  std::vector<std::uint8_t> bytes = out.bytes();
  const std::size_t size = bytes.size();
  EXPECT_TRUE(fba::decode(bytes)->warnings.empty());
  bytes.insert(bytes.end(), 100'000, 0);
  const auto decoded = fba::decode(bytes);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(decoded->warnings.size(), 1U);
  EXPECT_EQ(decoded->warnings[0],
            "bit " + std::to_string(size * 8) + ": 100000 bytes after the end code are ignored");
  // The push decoder says where the stream ended.
  fba::Decoder decoder;
  decoder.push(bytes);
  EXPECT_EQ(decoder.next()->kind, fba::Event::Kind::info);
  EXPECT_EQ(decoder.next()->kind, fba::Event::Kind::plane);
  EXPECT_EQ(decoder.next().error().code, Code::end_of_stream);
  EXPECT_EQ(decoder.next().error().where.bit, std::int64_t(size) * 8);
}

TEST(Syntax, ACopyOfADecoderGoesItsOwnWay) {
  fba::BitWriter out;
  out.start_code(fba::kObjectStart);
  header(out, true, fba::ObjectMask::body);
  small_body(out, true);
  end(out);
  const std::vector<std::uint8_t> bytes = out.bytes();
  fba::Decoder first;
  const std::size_t half = bytes.size() - 7;  // in the middle of the plane
  first.push(std::span(bytes).first(half));
  EXPECT_EQ(first.next()->kind, fba::Event::Kind::info);
  EXPECT_EQ(first.next().error().code, Code::need_data);
  fba::Decoder second = first;
  first.finish();
  EXPECT_EQ(first.next().error().code, Code::truncated);
  second.push(std::span(bytes).subspan(half));
  auto event = second.next();
  ASSERT_TRUE(event) << event.error().describe();
  EXPECT_EQ(event->plane.body->value[fba::kBapOrder[0]], 7 * fba::kBapSteps[0]);
  first = second;
  EXPECT_EQ(first.next().error().code, Code::end_of_stream);
}

}  // namespace syntax_test
}  // namespace animeme

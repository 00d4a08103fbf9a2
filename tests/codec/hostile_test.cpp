// Damaged streams end in a result or a clear error, and the decoder finds its way back.
#include <gtest/gtest.h>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "codec/text/epf.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace hostile_test {

// Pulls everything; returns the number of planes. Fails the test if the decoder does not end.
std::size_t drain(std::span<const std::uint8_t> stream) {
  fba::Decoder decoder;
  decoder.push(stream);
  decoder.finish();
  std::size_t planes = 0;
  for (std::size_t events = 0; events < stream.size() * 8 + 100; ++events) {
    auto event = decoder.next();
    if (event) {
      planes += event->kind == fba::Event::Kind::plane ? 1 : 0;
      continue;
    }
    if (event.error().code == Code::end_of_stream) return planes;
    EXPECT_NE(event.error().code, Code::need_data) << "nothing more will come";
    EXPECT_NE(event.error().code, Code::internal);
    EXPECT_FALSE(event.error().message.empty());
    EXPECT_GE(event.error().where.bit, 0) << event.error().message;
    EXPECT_LE(event.error().where.bit, std::int64_t(stream.size()) * 8);
  }
  ADD_FAILURE() << "the decoder does not come to an end";
  return planes;
}

std::vector<std::uint8_t> sample(std::uint64_t seed, fba::PlaneStartCodes codes) {
  fba::EncodeOptions options;
  options.intra_seconds = 5 / 25.0;
  options.stream.plane_start_codes = codes;
  auto stream = fba::encode(test::random_clip(seed, 20), options);
  EXPECT_TRUE(stream);
  return *stream;
}

TEST(Hostile, EveryTruncationIsNoticed) {
  const auto stream = sample(5, fba::PlaneStartCodes::none);
  auto whole = fba::decode(stream);
  ASSERT_TRUE(whole);
  for (std::size_t size = 0; size < stream.size(); ++size) {
    const auto part = std::span(stream).first(size);
    drain(part);
    auto decoded = fba::decode(part);
    // Only a cut inside the end code may leave a complete stream.
    if (size + 5 < stream.size()) {
      EXPECT_FALSE(decoded) << "cut at byte " << size;
    }
  }
}

TEST(Hostile, EverySingleBitFlipEnds) {
  for (const auto codes : {fba::PlaneStartCodes::none, fba::PlaneStartCodes::all}) {
    auto stream = sample(6, codes);
    const std::size_t bits = std::min<std::size_t>(stream.size(), 300) * 8;
    for (std::size_t bit = 0; bit < bits; ++bit) {
      stream[bit / 8] ^= std::uint8_t(0x80 >> (bit % 8));
      drain(stream);
      stream[bit / 8] ^= std::uint8_t(0x80 >> (bit % 8));
    }
  }
}

TEST(Hostile, RandomBytesEnd) {
  test::Random random(99);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::uint8_t> stream = {0, 0, 1, 0xBA};
    const int size = random.range(0, 400);
    const int zeros = random.range(0, 100);
    for (int i = 0; i < size; ++i) {
      stream.push_back(random.chance(zeros) ? std::uint8_t(0) : std::uint8_t(random.next()));
    }
    drain(stream);
  }
}

TEST(Hostile, ResynchronisesAtTheNextIntraPlane) {
  fba::EncodeOptions options;
  options.stream.plane_start_codes = fba::PlaneStartCodes::all;
  const fap::Sequence clip = test::random_clip(7, 20);
  options.intra_seconds = clip.rate.seconds(5);
  auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream);
  auto whole = fba::decode(*stream);
  ASSERT_TRUE(whole);
  // Break the marker bit of the masks of the first intra plane.
  auto broken = *stream;
  const std::int64_t begin = whole->planes[0].bit_begin;
  const std::int64_t marker = begin + 3 + 1 + 13 + 1 + 1 + 5;
  broken[std::size_t(marker / 8)] &= std::uint8_t(~(0x80 >> (marker % 8)));
  fba::Decoder decoder;
  decoder.push(broken);
  decoder.finish();
  ASSERT_EQ(decoder.next()->kind, fba::Event::Kind::info);
  auto first = decoder.next();
  ASSERT_FALSE(first);
  EXPECT_EQ(first.error().code, Code::syntax);
  std::size_t plane = 5;  // the next intra plane
  for (;;) {
    auto event = decoder.next();
    if (!event) {
      EXPECT_EQ(event.error().code, Code::end_of_stream) << event.error().describe();
      break;
    }
    if (event->kind == fba::Event::Kind::info) continue;
    ASSERT_EQ(event->kind, fba::Event::Kind::plane) << event->text;
    ASSERT_LT(plane, whole->planes.size());
    EXPECT_EQ(event->plane.face.value, whole->planes[plane].face.value);
    ++plane;
  }
  EXPECT_EQ(plane, whole->planes.size());
}

TEST(Hostile, ValuesThatLeave32BitsAreAnError) {
  // Head yaw up by the largest step in every plane.
  fba::FaceSettings settings;
  settings.fap_quant = 31;
  settings.mask_type[6] = fba::MaskType::hold;
  settings.mask.set(49);
  settings.send_range = {true, true, true, true};
  for (auto& set : settings.range) set[49] = 31;
  fba::Encoder encoder;
  fap::Frame frame;
  const int step = 170 * 31 * 60;
  std::int64_t value = 0;
  for (int i = 0; value + step < (std::int64_t(1) << 31); ++i) {
    frame.value[49] = std::int32_t(value);
    fba::PlaneInput plane;
    plane.intra = i == 0;
    plane.face = &frame;
    plane.face_settings = &settings;
    ASSERT_TRUE(encoder.write(plane)) << i;
    value += step;
  }
  const auto bytes = encoder.finish();
  EXPECT_TRUE(fba::decode(bytes));
}

TEST(Hostile, EpfErrorsNameTheLine) {
  const auto line_of = [](const char* text) {
    auto read = fba::read_epf(text);
    EXPECT_FALSE(read);
    return read ? 0 : read.error().where.line;
  };
  EXPECT_EQ(line_of("FBM 1\nFFR 0\nISI 1\nXYZ 3\n"), 4);
  EXPECT_EQ(line_of("FFR 0\n"), 1);
  EXPECT_EQ(line_of("FBM 1\nISI 0\n"), 1);
  EXPECT_EQ(line_of("FBM 1\nISI 1\nFQU 32\n"), 3);
  EXPECT_EQ(line_of("FBM 1\nISI 1\nFMT 1 2\n"), 3);
  EXPECT_EQ(line_of("FBM 1\nISI 1\nFMT 0 0 0 0 0 0 0 0 0 0 0\n"), 3);
  EXPECT_EQ(line_of("FBM 1\nISI 1\nCDM 1\n"), 3);
  EXPECT_EQ(line_of("FBM 1\nISI 1\nFRR 0 0 0\n"), 3);
  EXPECT_FALSE(fba::read_epf(""));
  EXPECT_TRUE(fba::read_epf("# comment\r\nFBM 1\r\n\r\nISI 1\r\nFQU 1\r\n"));
}

}  // namespace hostile_test
}  // namespace animeme

// Every reference stream: decodes to the expected text, and is written again byte for byte from
// its encoder parameter file.
#include <gtest/gtest.h>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "codec/text/epf.h"
#include "fap/text.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace conformance_test {

using test::read_bytes;
using test::slurp;
using test::with;

class ReferenceStream : public testing::TestWithParam<std::filesystem::path> {
 protected:
  std::filesystem::path path() const { return GetParam(); }
  bool has(const char* extension) const { return std::filesystem::exists(with(path(), extension)); }
};

// The switches of the encoder that wrote a stream: which planes have start codes, and which ones.
fba::StreamOptions start_codes_of(const fba::DecodedStream& decoded,
                                  const std::vector<std::uint8_t>& stream) {
  fba::StreamOptions options;
  bool all = true;
  for (const fba::Plane& plane : decoded.planes) {
    all = all && plane.start_code;
    if (!plane.start_code) continue;
    options.plane_start_codes = fba::PlaneStartCodes::intra;
    options.old_codes = stream[std::size_t(plane.bit_begin / 8) - 1] == 0x03;
  }
  if (all) options.plane_start_codes = fba::PlaneStartCodes::all;
  return options;
}

TEST_P(ReferenceStream, DecodesToTheExpectedFrames) {
  auto decoded = fba::decode(read_bytes(with(path(), ".fba")));
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_TRUE(has(".dec.fap") || has(".dec.bap"));
  if (has(".dec.fap")) {
    auto expected = fap::read_text(slurp(with(path(), ".dec.fap")));
    ASSERT_TRUE(expected) << expected.error().describe();
    const fap::Sequence got = fba::face_sequence(*decoded);
    ASSERT_EQ(got.frames.size(), expected->frames.size());
    for (std::size_t i = 0; i < got.frames.size(); ++i) {
      ASSERT_EQ(got.frames[i], expected->frames[i]) << "frame " << i;
    }
  }
  if (has(".dec.bap")) {
    auto expected = fba::read_bap_text(slurp(with(path(), ".dec.bap")));
    ASSERT_TRUE(expected) << expected.error().describe();
    ASSERT_FALSE(expected->frames.empty());
    const fba::BodySequence got = fba::body_sequence(*decoded);
    ASSERT_EQ(got.frames.size(), expected->frames.size());
    for (std::size_t i = 0; i < got.frames.size(); ++i) {
      ASSERT_EQ(got.frames[i], expected->frames[i]) << "body frame " << i;
    }
  }
}

TEST_P(ReferenceStream, IsWrittenByteForByteFromItsEpf) {
  if (!has(".epf")) GTEST_SKIP() << "this stream comes without encoder parameters";
  const std::vector<std::uint8_t> stream = read_bytes(with(path(), ".fba"));
  auto planes = fba::read_epf(slurp(with(path(), ".epf")));
  ASSERT_TRUE(planes) << planes.error().describe();
  fap::Sequence clip;
  if (has(".src.fap")) {
    auto read = fap::read_text(slurp(with(path(), ".src.fap")));
    ASSERT_TRUE(read) << read.error().describe();
    clip = *read;
  }
  std::vector<fba::BodyFrame> bodies;
  if (has(".src.bap")) {
    auto read = fba::read_bap_text(slurp(with(path(), ".src.bap")));
    ASSERT_TRUE(read) << read.error().describe();
    bodies = std::move(read->frames);
  }

  auto decoded = fba::decode(stream);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  auto written = fba::encode_epf(clip, bodies, *planes, start_codes_of(*decoded, stream));
  ASSERT_TRUE(written) << written.error().describe();
  const auto [a, b] = std::mismatch(written->begin(), written->end(), stream.begin(), stream.end());
  EXPECT_TRUE(*written == stream) << "first difference at byte " << a - written->begin() << " of "
                                  << stream.size() << " (written " << written->size() << ")";
}

TEST_P(ReferenceStream, SurvivesAccessUnits) {
  const std::vector<std::uint8_t> stream = read_bytes(with(path(), ".fba"));
  auto decoded = fba::decode(stream);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  auto units = fba::split_access_units(stream);
  ASSERT_TRUE(units) << units.error().describe();
  ASSERT_EQ(units->units.size(), decoded->planes.size());
  for (const bool headers : {false, true}) {
    auto again = fba::decode(fba::join_access_units(*units, headers));
    ASSERT_TRUE(again) << again.error().describe();
    ASSERT_EQ(again->planes.size(), decoded->planes.size());
    for (std::size_t i = 0; i < again->planes.size(); ++i) {
      EXPECT_EQ(again->planes[i].face, decoded->planes[i].face);
      EXPECT_EQ(again->planes[i].intra, units->units[i].intra);
    }
    EXPECT_LE(again->warnings.size(), decoded->warnings.size()) << again->warnings.front();
  }
}

TEST_P(ReferenceStream, DecodesTheSameInAnySplit) {
  const std::vector<std::uint8_t> stream = read_bytes(with(path(), ".fba"));
  auto whole = fba::decode(stream);
  ASSERT_TRUE(whole) << whole.error().describe();
  for (const std::size_t step : {std::size_t(1), std::size_t(7), stream.size()}) {
    fba::Decoder decoder;
    std::size_t planes = 0;
    std::size_t at = 0;
    for (;;) {
      auto event = decoder.next();
      if (event) {
        if (event->kind != fba::Event::Kind::plane) continue;
        ASSERT_LT(planes, whole->planes.size());
        const fba::Plane& expected = whole->planes[planes];
        EXPECT_EQ(event->plane.face, expected.face);
        EXPECT_EQ(event->plane.bit_begin, expected.bit_begin);
        EXPECT_EQ(event->plane.bit_end, expected.bit_end);
        EXPECT_EQ(event->plane.temporal, expected.temporal);
        ASSERT_EQ(event->plane.body != nullptr, expected.body != nullptr);
        if (expected.body) {
          EXPECT_EQ(*event->plane.body, *expected.body);
        }
        ++planes;
        continue;
      }
      if (event.error().code == Code::end_of_stream) break;
      ASSERT_EQ(event.error().code, Code::need_data) << event.error().describe();
      if (at >= stream.size()) {
        decoder.finish();
        continue;
      }
      const std::size_t count = std::min(step, stream.size() - at);
      decoder.push(std::span(stream).subspan(at, count));
      at += count;
    }
    EXPECT_EQ(planes, whole->planes.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Streams, ReferenceStream, testing::ValuesIn(test::reference_streams()),
                         [](const auto& param_info) {
                           return param_info.param.filename().string();
                         });

}  // namespace conformance_test
}  // namespace animeme

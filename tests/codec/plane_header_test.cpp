#include "codec/decode/plane_header.h"

#include <gtest/gtest.h>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "tests/support/reference_streams.h"

namespace animeme::fba {
namespace plane_header_test {

TEST(PlaneHeader, IsThatOfTheDecodedPlaneInAllReferenceStreams) {
  int planes = 0;
  for (const auto& base : test::reference_streams()) {
    const auto stream = test::read_bytes(test::with(base, ".fba"));
    const auto decoded = decode(stream);
    const auto units = split_access_units(stream);
    if (!decoded || !units) continue;
    for (std::size_t i = 0; i < units->units.size(); ++i, ++planes) {
      const auto header = read_plane_header(units->units[i].bytes);
      ASSERT_TRUE(header) << base << " plane " << i;
      EXPECT_EQ(header->intra, decoded->planes[i].intra);
      EXPECT_EQ(header->object_mask, decoded->planes[i].object_mask);
      EXPECT_EQ(header->temporal, decoded->planes[i].temporal) << base << " plane " << i;
    }
  }
  EXPECT_GT(planes, 1000);
}

TEST(PlaneHeader, NeedsStartCodeAndWholeHeader) {
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_FALSE(read_plane_header(Bytes{}));
  EXPECT_FALSE(read_plane_header(Bytes{0, 0, 1, 0xBA, 0x7F}));
  EXPECT_FALSE(read_plane_header(Bytes{0, 0, 1, 0xB6, 0x30, 0x30}));
  EXPECT_FALSE(read_plane_header(Bytes{0, 0, 1, 0xBB}));
  EXPECT_FALSE(read_plane_header(Bytes{0, 0, 1, 0xBB, 0b001'1'1111, 0xFF}));     // skip goes on
  EXPECT_FALSE(read_plane_header(Bytes{0, 0, 1, 0xBB, 0b101'1'0000, 0, 0, 0}));  // rate 0

  const auto predicted = read_plane_header(Bytes{0, 0, 1, 0xBB, 0b001'1'1111, 0b0010'0000});
  ASSERT_TRUE(predicted);
  EXPECT_FALSE(predicted->intra);
  EXPECT_EQ(predicted->temporal.skip, 17u);
  const auto old = read_plane_header(Bytes{0, 0, 1, 1, 0x7F, 0, 0, 1, 3, 0b001'0'0000});
  ASSERT_TRUE(old);
  EXPECT_FALSE(old->temporal.skip);
}

}  // namespace plane_header_test
}  // namespace animeme::fba

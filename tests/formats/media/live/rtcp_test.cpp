#include "tools/formats/media/rtp/rtcp.h"

#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"

namespace animeme::media {
namespace rtcp_test {

using test::Bytes;

RtcpMessage some_message() {
  RtcpMessage message;
  const ReportBlock block{0x11111111, 64, -5, 0x00020003, 77, 0x22222222, 65536};
  message.reports.push_back({0xAABBCCDD, SenderInfo{0xE0000000'80000000, 90000, 12, 345}, {block}});
  message.reports.push_back({0xAABBCCDE, std::nullopt, {block, block}});
  message.names = {{0xAABBCCDD, "animeme"}, {0xAABBCCDE, "x"}, {1, ""}, {2, "abc"}};
  message.byes = {0xAABBCCDD, 9};
  message.requests = {{5, 6, std::nullopt}, {5, 6, 255}};
  return message;
}

TEST(Rtcp, CompoundComesBackAsItWas) {
  const Bytes wire = write_rtcp(some_message());
  EXPECT_EQ(wire.size() % 4, 0u);
  EXPECT_EQ(read_rtcp(wire), some_message());
}

// RFC 4585, section 6.3.1; RFC 5104, section 4.3.1.
TEST(Rtcp, RequestsAreThoseOfTheRfc) {
  RtcpMessage message;
  message.requests = {{1, 2, std::nullopt}};
  EXPECT_EQ(write_rtcp(message), (Bytes{0x81, 206, 0, 2, 0, 0, 0, 1, 0, 0, 0, 2}));
  message.requests = {{1, 2, 9}};
  EXPECT_EQ(write_rtcp(message),
            (Bytes{0x84, 206, 0, 4, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 9, 0, 0, 0}));
  EXPECT_EQ(read_rtcp(Bytes{0x81, 206, 0, 1, 0, 0, 0, 1}), std::nullopt);
}

TEST(Rtcp, SenderReportIsThatOfTheRfc) {
  const RtcpMessage message{{{1, SenderInfo{0x0000000200000003, 4, 5, 6}, {}}}, {}, {}};
  const Bytes expected = {0x80, 200, 0, 6, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0,
                          0,    3,   0, 0, 0, 4, 0, 0, 0, 5, 0, 0, 0, 6};
  EXPECT_EQ(write_rtcp(message), expected);
}

TEST(Rtcp, LossIsLimitedTo24Bits) {
  for (const std::int32_t lost : {-9000000, 9000000}) {
    const RtcpMessage message{{{1, std::nullopt, {{.ssrc = 2, .lost = lost}}}}, {}, {}};
    const auto read = read_rtcp(write_rtcp(message));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->reports[0].blocks[0].lost, lost < 0 ? -0x800000 : 0x7FFFFF);
  }
}

TEST(Rtcp, UnknownPacketsAndPaddingArePassedOver) {
  Bytes wire = write_rtcp({{{1, std::nullopt, {}}}, {}, {}});
  wire.insert(wire.end(), {0x80, 204, 0, 2, 0, 0, 0, 1, 'n', 'a', 'm', 'e'});
  wire.insert(wire.end(), {0xA1, 203, 0, 2, 0, 0, 0, 7, 0, 0, 0, 4});  // goodbye, four of padding
  const auto read = read_rtcp(wire);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->reports.size(), 1u);
  EXPECT_EQ(read->byes, std::vector<std::uint32_t>{7});
}

TEST(Rtcp, DamagedPacketsAreRefused) {
  const Bytes wire = write_rtcp(some_message());
  int refused = 0;
  for (std::size_t size = 0; size < wire.size(); ++size) {
    refused += read_rtcp({wire.data(), size}) ? 0 : 1;
  }
  // It ends well only where a packet of the compound does: two reports, names, goodbyes and a
  // request.
  EXPECT_EQ(refused, int(wire.size()) - 5);
  EXPECT_FALSE(read_rtcp(Bytes{0x40, 201, 0, 1, 0, 0, 0, 1}));  // version 1
  EXPECT_FALSE(read_rtcp(Bytes{0x81, 201, 0, 1, 0, 0, 0, 1}));  // a block that is not there
  EXPECT_FALSE(read_rtcp(Bytes{0x81, 202, 0, 1, 0, 0, 0, 1}));  // a name that is not there
  EXPECT_FALSE(read_rtcp(Bytes{0xA0, 201, 0, 1, 0, 0, 0, 9}));  // padding past the begin
  EXPECT_FALSE(read_rtcp(Bytes{0x83, 203, 0, 1, 0, 0, 0, 1}));  // three goodbyes in one word
}

TEST(Rtcp, NtpCountsFrom1900) {
  const std::uint64_t seconds = ntp_now() >> 32;
  EXPECT_GT(seconds, 3900000000u);  // 2023
  EXPECT_NE(random_number(), random_number());
}

}  // namespace rtcp_test
}  // namespace animeme::media

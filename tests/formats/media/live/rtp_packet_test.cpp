#include "tools/formats/media/rtp/rtp_packet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"
#include "tools/formats/media/detail/sound/audio_headers.h"
#include "tools/formats/media/rtp/rtp_payload.h"

namespace animeme::media {
namespace rtp_packet_test {

using test::Bytes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

RtpPacket some_packet() {
  RtpPacket packet;
  packet.marker = true;
  packet.payload_type = 96;
  packet.sequence = 0xFFFE;
  packet.timestamp = 0x89ABCDEF;
  packet.ssrc = 0x12345678;
  packet.payload = {1, 2, 3, 4, 5};
  return packet;
}

TEST(RtpPacket, HeaderIsThatOfTheRfc) {
  EXPECT_THAT(write_rtp(some_packet()), ElementsAre(0x80, 0xE0, 0xFF, 0xFE, 0x89, 0xAB, 0xCD, 0xEF,
                                                    0x12, 0x34, 0x56, 0x78, 1, 2, 3, 4, 5));
}

TEST(RtpPacket, ComesBackAsItWas) { EXPECT_EQ(read_rtp(write_rtp(some_packet())), some_packet()); }

TEST(RtpPacket, BundleTableComesBackAndIsPassedOverByOthers) {
  RtpPacket packet = some_packet();
  packet.bundle = {{2, 3600}, {1, 7200}};
  const Bytes wire = write_rtp(packet);
  EXPECT_EQ(wire.size(), rtp_header_size(3) + packet.payload.size());
  EXPECT_EQ(read_rtp(wire, kBundleExtensionId), packet);
  EXPECT_EQ(read_rtp(wire), some_packet());
}

TEST(RtpPacket, BundleLargerThanItsPacketIsNoPacket) {
  RtpPacket packet = some_packet();
  packet.bundle = {{5, 3600}};
  EXPECT_FALSE(read_rtp(write_rtp(packet), kBundleExtensionId));
}

TEST(RtpPacket, PaddingSourcesAndForeignExtensionsAreLeftOut) {
  Bytes wire = {0xB2, 0x60, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
  wire.insert(wire.end(), {9, 9, 9, 9, 8, 8, 8, 8});  // two contributing sources
  wire.insert(wire.end(), {0xBE, 0xDE, 0, 1, 0x10, 7, 0, 0});
  wire.insert(wire.end(), {42, 43, 0, 0, 3});  // two bytes, three of padding
  const auto packet = read_rtp(wire, 5);
  ASSERT_TRUE(packet);
  EXPECT_THAT(packet->payload, ElementsAre(42, 43));
  EXPECT_FALSE(packet->marker);
  EXPECT_EQ(packet->ssrc, 3u);
}

TEST(RtpPacket, TruncatedHeadersAreNoPackets) {
  Bytes wire = {0xB1, 0x60, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 9, 9, 9, 9, 0xBE, 0xDE, 0, 1, 0, 0, 0, 0};
  wire.insert(wire.end(), {7, 1});  // one byte, one of padding
  ASSERT_TRUE(read_rtp(wire));
  for (std::size_t size = 0; size + 2 < wire.size(); ++size) {
    EXPECT_FALSE(read_rtp({wire.data(), size})) << size;
  }
}

TEST(RtpPacket, PaddingLongerThanThePayloadIsNoPacket) {
  Bytes wire = write_rtp(some_packet());
  wire[0] |= 0x20;
  wire.back() = 6;
  EXPECT_FALSE(read_rtp(wire));
  wire.back() = 5;
  EXPECT_TRUE(read_rtp(wire));
  wire.back() = 0;
  EXPECT_FALSE(read_rtp(wire));
}

TEST(RtpPacket, RtcpIsNotTakenForRtp) {
  const Bytes report = write_rtcp({{{7, std::nullopt, {}}}, {}, {}});
  EXPECT_TRUE(looks_like_rtcp(report));
  EXPECT_FALSE(read_rtp(report));
  EXPECT_FALSE(looks_like_rtcp(write_rtp(some_packet())));
}

// Feeds pieces to a joiner, times in steps of one a plane.
std::vector<RtpUnit> join(const std::vector<std::vector<RtpPayload>>& planes) {
  PlaneJoiner joiner;
  std::vector<RtpUnit> units;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (const RtpPayload& piece : planes[i]) {
      RtpPacket packet;
      packet.marker = piece.marker;
      packet.payload = piece.bytes;
      EXPECT_TRUE(joiner.add(packet, std::int64_t(i), units));
    }
  }
  return units;
}

Bytes plane_of(std::size_t size) {
  Bytes plane = {0, 0, 1, 0xBB};
  while (plane.size() < size) plane.push_back(std::uint8_t(plane.size()));
  return plane;
}

TEST(PlaneJoiner, JoinsWhatWasSplit) {
  for (const std::size_t size : {4u, 99u, 100u, 101u, 200u, 1248u}) {
    const auto pieces = split_plane(plane_of(size), 100);
    EXPECT_EQ(pieces.size(), (size + 99) / 100);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      EXPECT_EQ(pieces[i].marker, i + 1 == pieces.size());
    }
    const auto units = join({pieces, pieces});
    ASSERT_EQ(units.size(), 2u);
    EXPECT_EQ(units[0].bytes, plane_of(size));
    EXPECT_EQ(units[1], (RtpUnit{plane_of(size), 1}));
  }
}

TEST(PlaneJoiner, AMissingMarkIsMadeUpForByTheNextTime) {
  auto pieces = split_plane(plane_of(150), 100);
  pieces.back().marker = false;
  const auto units = join({pieces, split_plane(plane_of(20), 100)});
  ASSERT_EQ(units.size(), 2u);
  EXPECT_EQ(units[0].bytes, plane_of(150));
}

TEST(PlaneJoiner, DropsPlanesThatLackAPiece) {
  const auto pieces = split_plane(plane_of(250), 100);
  for (std::size_t lost = 0; lost < pieces.size(); ++lost) {
    PlaneJoiner joiner;
    std::vector<RtpUnit> units;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      RtpPacket packet;
      packet.marker = pieces[i].marker;
      packet.payload = pieces[i].bytes;
      if (i == lost) {
        joiner.gap();
      } else {
        joiner.add(packet, 0, units);
      }
    }
    RtpPacket next;
    next.marker = true;
    next.payload = plane_of(30);
    EXPECT_TRUE(joiner.add(next, 1, units));
    ASSERT_EQ(units.size(), 1u) << lost;
    EXPECT_EQ(units[0].bytes, plane_of(30));
  }
}

TEST(PlaneJoiner, MemoryIsBounded) {
  PlaneJoiner joiner;
  std::vector<RtpUnit> units;
  RtpPacket packet;
  packet.payload = plane_of(60000);
  int dropped = 0;
  for (int i = 0; i < 100; ++i) dropped += joiner.add(packet, 0, units) ? 0 : 1;
  EXPECT_EQ(dropped, 1);  // once; the rest of that plane is passed over
  EXPECT_THAT(units, IsEmpty());
}

std::vector<RtpUnit> join_aac(const std::vector<RtpPayload>& payloads, std::int64_t time) {
  AacJoiner joiner({}, 1024);
  std::vector<RtpUnit> units;
  for (const RtpPayload& payload : payloads) {
    RtpPacket packet;
    packet.marker = payload.marker;
    packet.payload = payload.bytes;
    EXPECT_TRUE(joiner.add(packet, time, units));
  }
  return units;
}

TEST(AacJoiner, PacketOfOneFrameIsThatOfTheRfc) {
  const std::vector<Bytes> frames = {{7, 8, 9}};
  const auto payloads = pack_aac(frames, 1000);
  ASSERT_EQ(payloads.size(), 1u);
  EXPECT_TRUE(payloads[0].marker);
  EXPECT_THAT(payloads[0].bytes, ElementsAre(0, 16, 0, 3 << 3, 7, 8, 9));
}

TEST(AacJoiner, BundlesAndPiecesComeBack) {
  const std::vector<Bytes> three = {Bytes(10, 1), Bytes(300, 2), Bytes(7, 3)};
  const auto bundle = pack_aac(three, 1000);
  ASSERT_EQ(bundle.size(), 1u);
  EXPECT_EQ(bundle[0].bytes.size(), aac_packet_size(3, 317));
  EXPECT_EQ(join_aac(bundle, 5000),
            (std::vector<RtpUnit>{{three[0], 5000}, {three[1], 6024}, {three[2], 7048}}));

  Bytes big(3000);
  for (std::size_t i = 0; i < big.size(); ++i) big[i] = std::uint8_t(i * 7);
  const std::vector<Bytes> one = {big};
  const auto pieces = pack_aac(one, 1000);
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_FALSE(pieces[0].marker);
  EXPECT_TRUE(pieces[3].marker);
  EXPECT_EQ(join_aac(pieces, 9), (std::vector<RtpUnit>{{big, 9}}));
}

TEST(AacJoiner, AFrameWithoutItsEndIsDropped) {
  const std::vector<Bytes> big = {Bytes(3000, 5)};
  auto pieces = pack_aac(big, 1000);
  AacJoiner joiner({}, 1024);
  std::vector<RtpUnit> units;
  RtpPacket packet;
  packet.payload = pieces[0].bytes;
  EXPECT_TRUE(joiner.add(packet, 0, units));
  packet.payload = {0, 16, 0, 1 << 3, 77};
  EXPECT_FALSE(joiner.add(packet, 1024, units));
  EXPECT_EQ(units, (std::vector<RtpUnit>{{{77}, 1024}}));
}

TEST(AacJoiner, HostilePacketsAreDropped) {
  for (const Bytes& payload :
       {Bytes{}, Bytes{0}, Bytes{0, 16}, Bytes{0, 16, 0, 0}, Bytes{0, 16, 0, 0, 1},
        Bytes{0xFF, 0xFF, 1, 2, 3}, Bytes{0, 32, 0, 8, 0xFF, 0xF8, 1, 2}}) {
    AacJoiner joiner({}, 1024);
    std::vector<RtpUnit> units;
    RtpPacket packet;
    packet.payload = payload;
    EXPECT_FALSE(joiner.add(packet, 0, units)) << payload.size();
  }
}

TEST(Opus, DurationsAreThoseOfTheRfc) {
  EXPECT_EQ(opus_samples(Bytes{}), 0);
  EXPECT_EQ(opus_samples(Bytes{0x00}), 480);         // SILK, 10 ms
  EXPECT_EQ(opus_samples(Bytes{0x18}), 2880);        // SILK, 60 ms
  EXPECT_EQ(opus_samples(Bytes{0x60}), 480);         // hybrid, 10 ms
  EXPECT_EQ(opus_samples(Bytes{0x68}), 960);         // hybrid, 20 ms
  EXPECT_EQ(opus_samples(Bytes{0x80}), 120);         // CELT, 2.5 ms
  EXPECT_EQ(opus_samples(Bytes{0xF9}), 1920);        // two frames of 20 ms
  EXPECT_EQ(opus_samples(Bytes{0xFB, 0x03}), 2880);  // three
  EXPECT_EQ(opus_samples(Bytes{0xFB}), 0);
  EXPECT_EQ(opus_samples(Bytes{0xFB, 0x3F}), 0);  // over 120 ms
}

}  // namespace rtp_packet_test
}  // namespace animeme::media

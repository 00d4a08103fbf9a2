// The program receiving from senders that lie, and beside strangers who talk into the conversation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fap/text.h"
#include "tests/formats/media/live/rtp_sockets.h"
#include "tests/formats/media/live/rtp_support.h"
#include "tests/formats/media/live/stream_support.h"
#include "tools/formats/media/live/ts_live.h"

namespace animeme {
namespace receive_hostile_test {

using test::container;
using test::kMostMegabytes;
using test::Running;
using test::size_of;
using test::Streams;
using test::wait_for;
using testing::HasSubstr;

/// Sends datagrams to the four ports of a description, until the receiver has begun.
class Sender {
 public:
  explicit Sender(int port) : to_(*media::UdpAddress::resolve("127.0.0.1", port)) {
    for (int i = 0; i < 2; ++i) sockets_.push_back(*media::UdpSocket::open_for(to_));
  }
  void send(const media::RtpSender::Datagrams& datagrams) {
    for (const media::RtpDatagram& each : datagrams) {
      const int behind = (each.track == media::LiveTrack::audio ? 2 : 0) + (each.control ? 1 : 0);
      (void)sockets_[each.control ? 1 : 0].send(each.bytes, to_.with_port(to_.port() + behind));
    }
  }

 private:
  media::UdpAddress to_;
  std::vector<media::UdpSocket> sockets_;
};

// Twenty planes, an hour from each to the next by their times: text for all of it would be 1.8
// million frames.
TEST(ReceiveHostile, TimesThatPacketsClaimCostNothing) {
  const test::LiveTalk talk = test::random_talk(40, 2);
  for (const std::string output : {"got.fap", "-", "got.mp4"}) {
    const test::TempDir dir;
    const int port = test::free_ports();
    media::RtpSender sender(talk.info, {.repeat = 1}, "127.0.0.1", port, 1, media::ntp_now());
    test::spill(dir / "talk.sdp", media::write_sdp(sender.session()));
    Running receive({"receive", dir / "talk.sdp", "-o", output == "-" ? "-" : dir / output,
                     "--fill", "--timeout", "1"},
                    dir / "out", dir / "err");
    ASSERT_TRUE(wait_for([&] { return !media::UdpSocket::bind("127.0.0.1", port); }));
    Sender wire(port);
    for (std::size_t i = 0; i < talk.units.size(); ++i) {
      media::LiveUnit unit = talk.units[i];
      unit.time = std::int64_t(i) * 3600 * talk.info.timescale;
      media::RtpSender::Datagrams out;
      ASSERT_TRUE(sender.send(unit, 0.001 * double(i), out));
      wire.send(out);
    }
    receive.wait();
    EXPECT_LT(receive.peak_mb(), kMostMegabytes) << output;
    EXPECT_LT(size_of(dir / "out") + size_of(dir / "got.fap") + size_of(dir / "got.mp4"), 1000000u)
        << output << test::slurp(dir / "err");
  }
}

TEST(ReceiveHostile, StampsOfATransportStreamCostNothing) {
  const test::LiveTalk talk = test::random_talk(200, 2);
  const test::TempDir dir;
  const std::string url = "udp://127.0.0.1:" + std::to_string(test::free_ports());
  Running receive({"receive", url, "-o", dir / "got.fap", "--timeout", "1", "--wait", "20"},
                  dir / "out", dir / "err");
  auto sink = media::make_ts_sink(url);
  ASSERT_TRUE((*sink)->start(talk.info));
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  ASSERT_TRUE(wait_for([&] { return !media::UdpSocket::bind("127.0.0.1", port); }));
  for (std::size_t i = 0; i < talk.units.size(); ++i) {
    media::LiveUnit unit = talk.units[i];
    unit.time = std::int64_t(i) * 600 * talk.info.timescale;
    ASSERT_TRUE((*sink)->send(unit));
  }
  receive.wait();
  EXPECT_LT(receive.peak_mb(), kMostMegabytes);
  EXPECT_LT(size_of(dir / "got.fap"), 1000000u) << test::slurp(dir / "err");
}

// Junk to all four ports, RTP of another sender and goodbyes in the name of all: the recording is
// whole and ends when its sender says so.
TEST_F(Streams, StrangersDoNotDisturbARecording) {
  Running send(sender({dir / "talk.mp4", "--loop", "--duration", "4"}), dir / "s.out",
               dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running receive({"receive", dir / "talk.sdp", "-o", dir / "got.mp4", "--json"}, dir / "1.out",
                  dir / "1.err");
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  ASSERT_TRUE(wait_for([&] { return !media::UdpSocket::bind("127.0.0.1", port + 3); }));
  const auto session = media::read_sdp(test::slurp(dir / "talk.sdp"));
  ASSERT_TRUE(session);
  test::Random random(3);
  auto to = *media::UdpAddress::resolve("127.0.0.1", port);
  auto socket = *media::UdpSocket::open_for(to);
  for (int i = 0; i < 2000; ++i) {
    test::Bytes junk(std::size_t(random.range(0, 200)));
    for (auto& byte : junk) byte = std::uint8_t(random.next());
    media::RtpPacket packet;
    packet.payload_type = std::uint8_t(i % 4 < 2 ? 96 : 97);
    packet.ssrc = 4711;
    packet.sequence = std::uint16_t(i / 4);
    packet.payload = {0, 0, 1, 0xBB, 0x20, 1, 2, 3};
    if (i % 3 == 0) junk = media::write_rtp(packet);
    media::RtcpMessage bye;
    bye.reports.push_back({4711, media::SenderInfo{1, 2, 3, 4}, {}});
    bye.byes = {4711, session->face->ssrc.value_or(0) + 1, random.next() & 0xFFFFFFFFu ? 7u : 8u};
    if (i % 3 == 1) junk = media::write_rtcp(bye);
    ASSERT_TRUE(socket.send(junk, to.with_port(port + i % 4)));
    if (i % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(15));
  }
  EXPECT_EQ(send.wait(), 0) << test::slurp(dir / "s.err");
  EXPECT_EQ(receive.wait(), 0) << test::slurp(dir / "1.err");
  const auto json = nlohmann::json::parse(test::slurp(dir / "1.out"));
  EXPECT_GT(json["face_seconds"].get<double>(), 2.5) << test::slurp(dir / "1.err");
  EXPECT_EQ(json["sessions"], 1);
  EXPECT_GT(json["ignored"].get<int>(), 100);
  EXPECT_EQ(json["planes_dropped"].get<int>() > 20, false) << test::slurp(dir / "1.err");
}

TEST_F(Streams, ARecordingThatFallsSilentIsKeptAndTold) {
  Running send(sender({dir / "talk.mp4", "--loop"}), dir / "s.out", dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running receive({"receive", dir / "talk.sdp", "-o", dir / "got.mp4", "--stats", "--timeout", "1"},
                  dir / "1.out", dir / "1.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "1.err").find("1 s: ") != std::string::npos; }));
  send.signal(SIGKILL);
  EXPECT_EQ(receive.wait(), 1);
  EXPECT_THAT(test::slurp(dir / "1.err"), HasSubstr("nothing came for 1 s"));
  EXPECT_GT(container(dir / "got.mp4").face.units.size(), 10u);
}

}  // namespace receive_hostile_test
}  // namespace animeme

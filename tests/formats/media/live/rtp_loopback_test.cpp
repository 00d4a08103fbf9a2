// Sink and source over the sockets of this machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/formats/media/live/rtp_sockets.h"
#include "tests/formats/media/live/rtp_support.h"
#include "tests/support/reference_streams.h"
#include "tools/formats/media/live/open.h"

namespace animeme::media {
namespace rtp_loopback_test {

using test::LiveTalk;
using ::testing::HasSubstr;

struct Received {
  LiveInfo info;
  std::vector<LiveUnit> units;
  int gaps = 0;
  bool end = false;

  void add(LiveEvent event) {
    if (const auto* now = std::get_if<LiveInfo>(&event)) info = *now;
    if (auto* unit = std::get_if<LiveUnit>(&event)) units.push_back(std::move(*unit));
    if (std::holds_alternative<LiveGap>(event)) ++gaps;
    if (std::holds_alternative<LiveEnd>(event)) end = true;
  }
};

// Takes what is there; at most `seconds` without anything.
void hear(LiveSource& source, double seconds, Received& received) {
  for (;;) {
    auto event = source.next(seconds);
    ASSERT_TRUE(event) << event.error().describe();
    if (std::holds_alternative<LiveIdle>(*event) || received.end) return;
    received.add(std::move(*event));
    if (received.end) return;
  }
}

// Sends without pauses; the receiver reads after each unit, so that no buffer overflows.
Received over_sockets(const LiveTalk& talk, RtpOptions options = {}) {
  const test::TempDir dir;
  options.sdp_path = dir.file("talk.sdp");
  Received received;
  auto sink = open_sink("rtp://127.0.0.1:" + std::to_string(test::free_ports()), {options});
  EXPECT_TRUE(sink) << sink.error().describe();
  const auto started = (*sink)->start(talk.info);
  EXPECT_TRUE(started) << started.error().describe();
  // In order, as they are here, nothing is to be waited for; that makes the end come at once.
  auto source = open_source(options.sdp_path, {.rtp = {.reorder_seconds = 0.01}});
  EXPECT_TRUE(source) << source.error().describe();
  if (!sink || !started || !source) return received;
  for (const LiveUnit& unit : talk.units) {
    EXPECT_TRUE((*sink)->send(unit));
    hear(**source, 0, received);
  }
  EXPECT_TRUE((*sink)->finish());
  hear(**source, 5, received);
  EXPECT_EQ((*source)->stats().lost, 0);
  return received;
}

TEST(RtpLoopback, EveryReferenceStreamComesBackByteForByte) {
  int streams = 0;
  for (const auto& base : test::reference_streams()) {
    const auto face = fba::split_access_units(test::read_bytes(test::with(base, ".fba")));
    if (!face) continue;
    const LiveTalk talk = test::talk_of(*face);
    const Received received = over_sockets(talk, {.seed = std::uint64_t(++streams)});
    SCOPED_TRACE(base.filename());
    EXPECT_EQ(received.info, talk.info);
    EXPECT_TRUE(received.end);
    EXPECT_EQ(received.gaps, 0);
    ASSERT_EQ(received.units.size(), talk.units.size());
    for (std::size_t i = 0; i < received.units.size(); ++i) {
      ASSERT_EQ(received.units[i].bytes, talk.units[i].bytes) << i;
      ASSERT_EQ(received.units[i].intra, talk.units[i].intra) << i;
      ASSERT_EQ(received.units[i].time, talk.units[i].time) << i;
      const bool last = i + 1 == received.units.size();
      if (!last) {
        ASSERT_EQ(received.units[i].duration, talk.units[i].duration) << i;
      }
    }
  }
  EXPECT_GT(streams, 100);
}

TEST(RtpLoopback, FaceAndSoundOfBothCodecs) {
  AudioFormat opus{AudioCodec::opus, 48000, 1, 960, 312, {}};
  opus.config = {'O', 'p', 'u', 's', 'H', 'e', 'a', 'd', 1, 1, 56, 1, 0x80, 0xBB, 0, 0, 0, 0, 0};
  for (const AudioFormat& format : {test::aac_format(), opus}) {
    LiveTalk talk = test::random_talk(50);
    test::add_sound(talk, format);
    const Received received = over_sockets(talk);
    EXPECT_EQ(received.info, talk.info);
    for (const LiveTrack track : {LiveTrack::face, LiveTrack::audio}) {
      EXPECT_EQ(test::only(received.units, track), test::only(talk.units, track));
    }
  }
}

TEST(RtpLoopback, BetweenIpv6Addresses) {
  if (!UdpSocket::bind("::1", 0)) GTEST_SKIP() << "this machine has no IPv6";
  const LiveTalk talk = test::random_talk(10);
  const int port = test::free_ports();
  auto source = open_source("rtp://[::1]:" + std::to_string(port));
  ASSERT_TRUE(source) << source.error().describe();
  auto sink = open_sink("rtp://[::1]:" + std::to_string(port));
  ASSERT_TRUE((*sink)->start(talk.info));
  for (const LiveUnit& unit : talk.units) ASSERT_TRUE((*sink)->send(unit));
  ASSERT_TRUE((*sink)->finish());
  Received received;
  hear(**source, 5, received);
  ASSERT_EQ(received.units.size(), talk.units.size());
  EXPECT_EQ(received.units[9].bytes, talk.units[9].bytes);
  EXPECT_EQ(received.info.face_config, talk.info.face_config);
  EXPECT_EQ(received.info.timescale, 90000u);
  EXPECT_EQ(received.units[9].time, 9 * 3600);
}

TEST(RtpLoopback, OverMulticast) {
  const std::string group = "239.255.77.7";
  const int port = test::free_ports();
  const Multicast on_loopback{1, "127.0.0.1"};
  if (!UdpSocket::bind(group, port, on_loopback)) GTEST_SKIP() << "no multicast here";
  const LiveTalk talk = test::random_talk(10);
  const std::string url = "rtp://" + group + ":" + std::to_string(port);
  auto source = open_source(url, {.rtp = {.interface = "127.0.0.1"}});
  ASSERT_TRUE(source) << source.error().describe();
  auto sink = open_sink(url, {.rtp = {.interface = "127.0.0.1"}});
  ASSERT_TRUE((*sink)->start(talk.info));
  for (const LiveUnit& unit : talk.units) ASSERT_TRUE((*sink)->send(unit));
  ASSERT_TRUE((*sink)->finish());
  Received received;
  hear(**source, 5, received);
  EXPECT_EQ(received.units.size(), talk.units.size());
}

TEST(RtpLoopback, ALossyRelayBetweenThem) {
  LiveTalk talk = test::random_talk(400, 25);
  test::add_sound(talk, test::aac_format());
  const test::TempDir dir;
  const int front = test::free_ports();
  const int back = test::free_ports(front + 4);
  for (const int loss : {0, 5}) {
    const std::string sdp = dir.file("talk.sdp");
    auto sink = open_sink("rtp://127.0.0.1:" + std::to_string(front),
                          {.rtp = {.repeat = 1, .sdp_path = sdp, .seed = 3}});
    ASSERT_TRUE((*sink)->start(talk.info));
    test::shift_ports(sdp, back);
    auto source = open_source(sdp, {.rtp = {.reorder_seconds = 0.02}});
    ASSERT_TRUE(source) << source.error().describe();
    test::UdpRelay relay(front, back, 9, loss);
    Received received;
    for (const LiveUnit& unit : talk.units) {
      ASSERT_TRUE((*sink)->send(unit));
      relay.pump();
      hear(**source, 0, received);
    }
    ASSERT_TRUE((*sink)->finish());
    relay.pump();
    hear(**source, 5, received);
    EXPECT_TRUE(received.end);
    EXPECT_EQ(received.units.size() == talk.units.size(), loss == 0);
    EXPECT_EQ(received.gaps > 0, loss > 0);
    EXPECT_EQ((*source)->stats().lost > 0, loss > 0);
  }
}

// The receiver looks at the description now and then: the packets that come before it looks again
// must not begin a presentation of their own.
TEST(RtpLoopback, ASenderThatBeginsAgainIsOnePresentation) {
  const test::TempDir dir;
  const std::string sdp = dir.file("talk.sdp");
  const std::string url = "rtp://127.0.0.1:" + std::to_string(test::free_ports());
  const LiveTalk talk = test::talk_of(
      *fba::split_access_units(test::read_bytes(test::with(test::reference_streams()[0], ".fba"))));
  std::unique_ptr<LiveSource> source;
  int restarts = 0;
  for (const std::uint64_t seed : {1, 2}) {
    auto sink = open_sink(url, {.rtp = {.sdp_path = sdp, .seed = seed}});
    ASSERT_TRUE(sink) << sink.error().describe();
    if (source != nullptr) {
      // Long enough for another sender to take over; the last look is a moment ago.
      for (int i = 0; i < 22; ++i) ASSERT_TRUE(source->next(0.05));
    }
    ASSERT_TRUE((*sink)->start(talk.info));
    if (source == nullptr) {
      auto opened = open_source(sdp, {.rtp = {.reorder_seconds = 0.01}});
      ASSERT_TRUE(opened) << opened.error().describe();
      source = std::move(*opened);
    }
    for (const LiveUnit& unit : talk.units) {
      ASSERT_TRUE((*sink)->send(unit));
      for (;;) {
        const auto event = source->next(0);
        ASSERT_TRUE(event) << event.error().describe();
        if (std::holds_alternative<LiveIdle>(*event)) break;
        restarts += std::holds_alternative<LiveRestart>(*event);
      }
    }
  }
  EXPECT_EQ(source->stats().sessions, 2);
  for (int i = 0; i < 20; ++i) {  // and none begins when it looks
    const auto event = source->next(0.05);
    ASSERT_TRUE(event);
    restarts += std::holds_alternative<LiveRestart>(*event);
  }
  EXPECT_EQ(source->stats().sessions, 2);
  EXPECT_EQ(restarts, 1);
}

// Copies that lie in the socket have come, however late the receiver reads them.
TEST(RtpLoopback, AReceiverThatIsHeldUpTakesWhatLiesInTheSocketBeforeItGivesUp) {
  const test::TempDir dir;
  const RtpOptions options{.repeat = 2, .repeat_after = 3, .sdp_path = dir.file("talk.sdp")};
  const LiveTalk talk = test::talk_of(
      *fba::split_access_units(test::read_bytes(test::with(test::reference_streams()[0], ".fba"))));
  ASSERT_GT(talk.units.size(), 6u);
  auto sink = open_sink("rtp://127.0.0.1:" + std::to_string(test::free_ports()), {options});
  ASSERT_TRUE(sink && (*sink)->start(talk.info));
  const auto send = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) ASSERT_TRUE((*sink)->send(talk.units[i]));
  };
  send(0, 3);  // nobody is there
  auto source = open_source(options.sdp_path, {.rtp = {.reorder_seconds = 0.01}});
  ASSERT_TRUE(source) << source.error().describe();
  Received received;
  send(3, 4);  // with a copy of the first
  hear(**source, 0, received);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  send(4, 7);  // with copies of the second to the fourth
  hear(**source, 0.2, received);
  EXPECT_EQ((*source)->stats().lost, 0);
  EXPECT_EQ(received.gaps, 0);
  ASSERT_EQ(received.units.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(received.units[i].bytes, talk.units[i].bytes) << i;
}

// What is sent on this machine is answered on this machine: the port is taken at one address only.
TEST(RtpLoopback, SocketsForThisMachineListenToThisMachine) {
  const auto socket = UdpSocket::open_for(*UdpAddress::resolve("127.0.0.1", 5004));
  ASSERT_TRUE(socket);
  EXPECT_GT(socket->port(), 0);
  EXPECT_TRUE(UdpSocket::bind("127.0.0.2", socket->port()));
  EXPECT_FALSE(UdpSocket::bind("127.0.0.1", socket->port()));
}

TEST(RtpLoopback, ErrorsSayWhatToDo) {
  const auto message = [](const auto& result) {
    return result ? std::string("no error") : result.error().describe();
  };
  EXPECT_THAT(message(open_sink("rtp://127.0.0.1:5005")), HasSubstr("even port"));
  EXPECT_THAT(message(open_sink("rtp://:5004")), HasSubstr("where to send"));
  EXPECT_THAT(message(open_sink("rtp://127.0.0.1:x")), HasSubstr("scheme://host:port"));
  EXPECT_THAT(message(open_sink("rtp://no-such-host.invalid:5004")), HasSubstr("no host"));
  EXPECT_THAT(message(open_sink("talk.sdp")), HasSubstr("rtp://host:port"));
  EXPECT_THAT(message(open_sink("rtp://127.0.0.1", {.rtp = {.repeat = 9}})), HasSubstr("repeat"));
  EXPECT_THAT(message(open_source("nowhere.sdp")), HasSubstr("nowhere.sdp"));
  EXPECT_THAT(message(open_source("rtp://127.0.0.1", {.rtp = {.reorder_seconds = -1}})),
              HasSubstr("reorder_seconds"));
  const int port = test::free_ports();
  const std::string url = "rtp://127.0.0.1:" + std::to_string(port);
  const auto first = open_source(url);
  ASSERT_TRUE(first);
  EXPECT_THAT(message(open_source(url)), HasSubstr("cannot be bound: Address already in use"));
  auto sink = open_sink(url);
  EXPECT_EQ((*sink)->send({}).error().code, Code::invalid_argument);
  EXPECT_FALSE((*sink)->start({}));
}

TEST(RtpLoopback, ADescriptionThatCannotBeWrittenIsAnError) {
  auto sink = open_sink("rtp://127.0.0.1", {.rtp = {.sdp_path = "/no/such/folder/talk.sdp"}});
  ASSERT_TRUE(sink);
  EXPECT_EQ((*sink)->start(test::random_talk(1).info).error().code, Code::io);
}

}  // namespace rtp_loopback_test
}  // namespace animeme::media

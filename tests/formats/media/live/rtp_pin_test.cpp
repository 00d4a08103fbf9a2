// Whom a receiver listens to, and when it goes over to another sender.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"
#include "tools/formats/media/rtp/session_clock.h"

namespace animeme::media {
namespace rtp_pin_test {

using test::LiveTalk;
using test::random_talk;
using test::units_in;

UdpAddress at(const std::string& host, int port) { return *UdpAddress::resolve(host, port); }

const UdpAddress kSender = at("192.0.2.1", 4000), kControl = at("192.0.2.1", 4001);
const UdpAddress kStranger = at("192.0.2.66", 666);

/// A receiver and all that it gave out.
struct Listener {
  RtpReceiver receiver;
  std::vector<LiveEvent> events;

  explicit Listener(const RtpSession& session, const RtpReceiveOptions& options = {})
      : receiver(session, options, 1) {}
  void hear(const RtpDatagram& datagram, const UdpAddress& from, double now) {
    if (datagram.control) {
      receiver.rtcp(datagram.track, datagram.bytes, from, now);
    } else {
      receiver.rtp(datagram.track, datagram.bytes, from, now);
    }
    collect(now);
  }
  void collect(double now) {
    while (auto event = receiver.next(now)) events.push_back(std::move(*event));
  }
  std::size_t units() const { return units_in(events).size(); }
  bool ended() const {
    return std::any_of(events.begin(), events.end(),
                       [](const auto& each) { return std::holds_alternative<LiveEnd>(each); });
  }
};

RtpSession described(const RtpSender& sender) { return *read_sdp(write_sdp(sender.session())); }

/// As descriptions of others have it: nobody in particular.
RtpSession undescribed(const RtpSender& sender) {
  RtpSession session = described(sender);
  session.face->ssrc.reset();
  session.face->clock_offset.reset();
  return session;
}

/// Sends a talk from `from`, a plane each 40 ms; returns the time behind it.
double send(const LiveTalk& talk, RtpSender& sender, Listener& listener, double now,
            const UdpAddress& from = kSender, bool bye = false) {
  const UdpAddress control = from.with_port(from.port() + 1);
  const auto give = [&](const RtpSender::Datagrams& out) {
    for (const RtpDatagram& each : out) listener.hear(each, each.control ? control : from, now);
  };
  for (const LiveUnit& unit : talk.units) {
    RtpSender::Datagrams out;
    EXPECT_TRUE(sender.send(unit, now, out));
    give(out);
    now += 0.04;
  }
  if (!bye) return now;
  RtpSender::Datagrams out;
  sender.finish(now, out);
  give(out);
  return now;
}

RtpPacket packet(std::uint32_t ssrc, int sequence) {
  RtpPacket made;
  made.ssrc = ssrc;
  made.sequence = std::uint16_t(sequence);
  made.payload = {0, 0, 1, 0xBB, 0x20};
  return made;
}

TEST(RtpPin, StrangersAreIgnoredAndCounted) {
  const LiveTalk talk = random_talk(100);
  RtpSender sender(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
  Listener listener(described(sender));
  double now = 0;
  std::uint32_t ssrc = *described(sender).face->ssrc;
  for (int i = 0; i < 100; ++i, now += 0.04) {
    RtpSender::Datagrams out;
    ASSERT_TRUE(sender.send(talk.units[std::size_t(i)], now, out));
    for (const RtpDatagram& each : out) {
      listener.hear(each, each.control ? kControl : kSender, now);
    }
    for (int k = 0; k < 3; ++k) {  // a whole sender of its own
      listener.hear({LiveTrack::face, false, write_rtp(packet(77, 3 * i + k))}, kStranger, now);
    }
    // The right identifier from the wrong place.
    listener.hear({LiveTrack::face, false, write_rtp(packet(ssrc, 40000 + i))}, kStranger, now);
    RtcpMessage bye;
    bye.reports.push_back({ssrc, SenderInfo{ntp_now(), 0, 0, 0}, {}});
    bye.byes.push_back(ssrc);
    listener.hear({LiveTrack::face, true, write_rtcp(bye)}, kStranger, now);
    listener.hear({LiveTrack::face, true, write_rtcp(bye)}, at("192.0.2.1", 9), now);
    listener.hear({LiveTrack::face, true, {1, 2, 3}}, kStranger, now);
  }
  listener.collect(now + 5);
  EXPECT_EQ(listener.units(), 100u);
  EXPECT_FALSE(listener.ended());
  EXPECT_EQ(listener.receiver.stats().sessions, 1);
  EXPECT_GE(listener.receiver.stats().foreign, 700);
  // Its own goodbye counts.
  RtpSender::Datagrams out;
  sender.finish(now, out);
  for (const RtpDatagram& each : out) listener.hear(each, each.control ? kControl : kSender, now);
  listener.collect(now + 5);
  EXPECT_TRUE(listener.ended());
}

TEST(RtpPin, JunkBeforeTheSenderDoesNotTakeItsPlace) {
  const LiveTalk talk = random_talk(50);
  for (const bool known : {true, false}) {
    RtpSender sender(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
    Listener listener(known ? described(sender) : undescribed(sender));
    test::Random random(5);
    double now = 0;
    for (int i = 0; i < 5000; ++i, now += 0.001) {
      test::Bytes junk(std::size_t(random.range(0, 60)));
      for (auto& byte : junk) byte = std::uint8_t(random.next());
      if (i % 3 == 0) junk = write_rtp(packet(std::uint32_t(random.next()), i));
      listener.hear({LiveTrack::face, i % 5 == 0, junk}, kStranger.with_port(1000 + i % 50), now);
    }
    EXPECT_TRUE(listener.events.empty());
    send(talk, sender, listener, now);
    listener.collect(now + 10);
    EXPECT_EQ(listener.units(), 50u) << known;
  }
}

// Somebody who speaks proper RTP comes first; the one whose identifier was described is believed.
TEST(RtpPin, TheSenderOfTheDescriptionComesBeforeAllOthers) {
  const LiveTalk talk = random_talk(50);
  RtpSender sender(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
  RtpSender other(talk.info, {}, "192.0.2.1", 5004, 2, ntp_now());
  Listener listener(described(sender));
  double now = send(talk, other, listener, 0, kStranger);
  listener.collect(now);
  EXPECT_EQ(listener.units(), 50u);
  now = send(talk, sender, listener, now);
  EXPECT_EQ(listener.receiver.stats().sessions, 2);
  now = send(talk, other, listener, now, kStranger);  // too late
  listener.collect(now);
  EXPECT_EQ(listener.receiver.stats().sessions, 3) << "silent for more than a second";
  EXPECT_GT(listener.units(), 110u);
}

TEST(RtpPin, ARestartedSenderIsHeardFromItsFirstPlaneOn) {
  const LiveTalk talk = random_talk(50);
  for (const double pause : {0.0, 0.5, 2.0, 30.0}) {
    RtpSender first(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
    RtpSender second(talk.info, {}, "192.0.2.1", 5004, 2, ntp_now());
    Listener listener(described(first));
    const double before = send(talk, first, listener, 0) + pause;
    const double end = send(talk, second, listener, before, at("192.0.2.1", 4010), true);
    listener.collect(end + 3);
    ASSERT_EQ(listener.units(), 100u) << pause;
    EXPECT_TRUE(listener.ended());
    EXPECT_EQ(listener.receiver.stats().sessions, 2);
    const auto restarts =
        std::count(listener.events.begin(), listener.events.end(), LiveEvent(LiveRestart{}));
    EXPECT_EQ(restarts, 1);
    // On one clock, behind each other, and each begins with an intra plane.
    SessionClock clock;
    FaceRecovery recovery;
    std::deque<LiveEvent> steady;
    double now = 0;
    for (const LiveEvent& event : listener.events) {
      if (std::holds_alternative<LiveRestart>(event)) now = before;
      if (std::holds_alternative<LiveUnit>(event)) now += 0.04;
      clock.push(event, now, steady);
    }
    std::vector<LiveUnit> shown;
    for (LiveEvent& event : steady) {
      if (auto unit = recovery.accept(std::move(event))) shown.push_back(std::move(*unit));
    }
    ASSERT_EQ(shown.size(), 100u);
    EXPECT_TRUE(shown[50].intra);
    EXPECT_NEAR(double(shown[50].time - shown[49].time) / talk.info.timescale, 0.04 + pause, 0.3);
    for (std::size_t i = 1; i < shown.size(); ++i) EXPECT_GT(shown[i].time, shown[i - 1].time);
  }
}

// What is joined in the middle must not go on with differences to another face.
TEST(RtpPin, APredictedPlaneOfAnotherSenderIsNeverShown) {
  const LiveTalk talk = random_talk(100, 25);
  RtpSender first(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
  RtpSender second(talk.info, {}, "192.0.2.1", 5004, 2, ntp_now());
  Listener listener(described(first));
  double now = send(talk, first, listener, 0);
  LiveTalk middle = talk;  // its first planes are lost, and so is the intra plane of second 1
  middle.units.erase(middle.units.begin(), middle.units.begin() + 30);
  now = send(middle, second, listener, now + 5, at("192.0.2.1", 4010));
  listener.collect(now);
  SessionClock clock;
  FaceRecovery recovery;
  std::deque<LiveEvent> steady;
  for (const LiveEvent& event : listener.events) clock.push(event, 0, steady);
  std::vector<LiveUnit> shown;
  for (LiveEvent& event : steady) {
    if (auto unit = recovery.accept(std::move(event))) shown.push_back(std::move(*unit));
  }
  ASSERT_EQ(shown.size(), 150u);
  EXPECT_EQ(shown[100].bytes, talk.units[50].bytes);
  EXPECT_TRUE(shown[100].intra);
  EXPECT_EQ(recovery.stats().freezes, 1);
}

TEST(RtpPin, FaceAndSoundOfARestartedSenderStayTogether) {
  LiveTalk talk = random_talk(75);
  test::add_sound(talk, test::aac_format());
  RtpSender first(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
  RtpSender second(talk.info, {}, "192.0.2.1", 5004, 2, ntp_now());
  Listener listener(described(first));
  double begin = 0;
  for (RtpSender* sender : {&first, &second}) {
    const UdpAddress from = sender == &first ? kSender : at("192.0.2.1", 4010);
    for (const LiveUnit& unit : talk.units) {
      RtpSender::Datagrams out;
      const double now = begin + 0.1 + test::seconds_of(talk, unit);
      ASSERT_TRUE(sender->send(unit, now, out));
      for (const RtpDatagram& each : out) {
        // Each socket has its port; face and sound come from the same one.
        listener.hear(each, each.control ? from.with_port(from.port() + 1) : from, now);
      }
    }
    begin += 5;
  }
  listener.collect(20);
  EXPECT_EQ(listener.receiver.stats().sessions, 2);
  const auto units = units_in(listener.events);
  EXPECT_GE(units.size(), 2 * talk.units.size() - 3);
  // Within what followed, as in the talk: sound and face of one instant have the times of it.
  double face = 0, sound = 0;
  for (const LiveUnit& unit : units) {
    if (unit.track == LiveTrack::face) face = test::seconds_of(talk, unit);
    if (unit.track == LiveTrack::audio) sound = test::seconds_of(talk, unit);
  }
  const auto last = [&](LiveTrack track) {
    return test::seconds_of(talk, test::only(talk.units, track).back());
  };
  EXPECT_NEAR(face - sound, last(LiveTrack::face) - last(LiveTrack::audio), 0.1);
}

TEST(RtpPin, WithAnySourceThePacketsOfARelayFarmAreOneStream) {
  const LiveTalk talk = random_talk(50);
  for (const bool any : {false, true}) {
    RtpSender sender(talk.info, {.repeat = 1}, "192.0.2.1", 5004, 1, ntp_now());
    Listener listener(described(sender), {.any_source = any});
    double now = 0;
    for (std::size_t i = 0; i < talk.units.size(); ++i, now += 0.04) {
      RtpSender::Datagrams out;
      ASSERT_TRUE(sender.send(talk.units[i], now, out));
      for (const RtpDatagram& each : out) {
        listener.hear(each, at("192.0.2." + std::to_string(1 + i % 3), 4000), now);
      }
    }
    listener.collect(now + 5);
    EXPECT_EQ(listener.units() == 50, any);
  }
}

// A sender with fixed numbers that begins again from the same port: everything looks like a copy.
TEST(RtpPin, ASenderWithTheSameNumbersIsHeardAgain) {
  const LiveTalk talk = random_talk(400);
  Listener listener(described(RtpSender(talk.info, {}, "192.0.2.1", 5004, 1, 0)));
  double now = 0;
  for (int life = 0; life < 2; ++life) {
    RtpSender sender(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
    now = send(talk, sender, listener, now + 2);
  }
  listener.collect(now + 2);
  EXPECT_GE(listener.units(), 795u);
}

}  // namespace rtp_pin_test
}  // namespace animeme::media

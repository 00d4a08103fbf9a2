// Sender and receiver together, without sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/live/rtp_support.h"

namespace animeme::media {
namespace rtp_session_test {

using test::BadNetwork;
using test::LiveTalk;
using test::random_talk;
using test::transfer;
using test::units_in;

std::int64_t count_gaps(const std::vector<LiveEvent>& events) {
  return std::count_if(events.begin(), events.end(), [](const LiveEvent& event) {
    return std::holds_alternative<LiveGap>(event);
  });
}

void expect_same(const std::vector<LiveUnit>& got, const std::vector<LiveUnit>& sent) {
  ASSERT_EQ(got.size(), sent.size());
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_EQ(got[i], sent[i]) << "unit " << i;
}

void expect_all(const LiveTalk& talk, const std::vector<LiveEvent>& events) {
  ASSERT_FALSE(events.empty());
  ASSERT_TRUE(std::holds_alternative<LiveInfo>(events.front()));
  EXPECT_EQ(std::get<LiveInfo>(events.front()), talk.info);
  EXPECT_TRUE(std::holds_alternative<LiveEnd>(events.back()));
  EXPECT_EQ(count_gaps(events), 0);
  for (const LiveTrack track : {LiveTrack::face, LiveTrack::audio}) {
    expect_same(test::only(units_in(events), track), test::only(talk.units, track));
  }
}

AudioFormat opus() {
  AudioFormat format{AudioCodec::opus, 48000, 1, 960, 312, {}};
  format.config = {'O', 'p', 'u', 's', 'H', 'e', 'a', 'd', 1, 1, 56, 1, 0x80, 0xBB, 0, 0, 0, 0, 0};
  return format;
}

TEST(RtpSession, FaceAndSoundComeBackWithTheirTimes) {
  for (const AudioFormat& format : {test::aac_format(), opus()}) {
    LiveTalk talk = random_talk(60);
    test::add_sound(talk, format);
    expect_all(talk, transfer(talk));
  }
}

TEST(RtpSession, AllSettingsGiveTheSameUnits) {
  LiveTalk talk = random_talk(60, 20);
  test::add_sound(talk, test::aac_format());
  for (const RtpOptions& options :
       {RtpOptions{.mtu = 256, .repeat = 1}, RtpOptions{.repeat = 4}, RtpOptions{.bundle = 5},
        RtpOptions{.mtu = 256, .repeat = 3, .bundle = 16, .audio_bundle = 3},
        RtpOptions{.audio_bundle = 32, .config_in_band = false}}) {
    expect_all(talk, transfer(talk, options, {}, 5));
  }
}

TEST(RtpSession, ExactRates) {
  for (const fap::Rate rate : {fap::make_rate(30000, 1001), fap::make_rate(479, 16),
                               fap::make_rate(25, 2), fap::make_rate(24000, 1001)}) {
    const LiveTalk talk = random_talk(40, 20, rate);
    expect_all(talk, transfer(talk));
  }
}

TEST(RtpSession, BundlesSaveHeaders) {
  const LiveTalk talk = random_talk(100);
  const auto packets = [&talk](const RtpOptions& options) {
    RtpSender sender(talk.info, options, "192.0.2.1", 5004, 1, 0);
    RtpReceiver receiver(*read_sdp(write_sdp(sender.session())), {}, 1);
    BadNetwork network(1, {});
    transfer(talk, network, receiver, sender);
    return sender.stats(0).packets;
  };
  EXPECT_GT(packets({.repeat = 1}), 100);
  EXPECT_LT(packets({.mtu = 60000, .repeat = 1, .bundle = 5}), 40);
}

// Numbers of the packets of a face as they are sent, from 0 on.
std::vector<int> order_of_packets(const LiveTalk& talk, RtpOptions options) {
  options.mtu = 60000;
  RtpSender sender(talk.info, options, "192.0.2.1", 5004, 1, 0);
  RtpSender::Datagrams out;
  for (std::size_t i = 0; i < talk.units.size(); ++i) {
    EXPECT_TRUE(sender.send(talk.units[i], 0.04 * double(i), out));
  }
  sender.finish(0.04 * double(talk.units.size()), out);
  std::vector<int> order;
  std::optional<std::uint16_t> first;
  for (const RtpDatagram& each : out) {
    if (each.control) continue;
    const std::uint16_t sequence = read_rtp(each.bytes)->sequence;
    if (!first) first = sequence;
    order.push_back(std::uint16_t(sequence - *first));
  }
  return order;
}

TEST(RtpSession, RepeatedPacketsFollowTheirPlanes) {
  const LiveTalk talk = random_talk(4), longer = random_talk(6);
  using ::testing::ElementsAre;
  EXPECT_THAT(order_of_packets(talk, {.repeat = 2, .repeat_after = 1}),
              ElementsAre(0, 1, 0, 2, 1, 3, 2, 3));
  EXPECT_THAT(order_of_packets(longer, {.repeat = 2, .repeat_after = 3}),
              ElementsAre(0, 1, 2, 3, 0, 4, 1, 5, 2, 3, 4, 5));
  EXPECT_THAT(order_of_packets(talk, {.repeat = 3, .repeat_after = 2}),
              ElementsAre(0, 1, 2, 0, 3, 1, 0, 1, 2, 2, 3, 3));
}

// A burst of six packets never has both, with sound in between or without.
TEST(RtpSession, ABurstOfLossesDoesNotTakeACopy) {
  LiveTalk silent = random_talk(100), talk = silent;
  test::add_sound(talk, test::aac_format());
  for (const LiveTalk* each : {&silent, &talk}) {
    for (int begin = 60; begin < 100; ++begin) {
      RtpSender sender(each->info, {}, "192.0.2.1", 5004, 1, 0);
      RtpReceiver receiver(*read_sdp(write_sdp(sender.session())), {}, 1);
      BadNetwork network(1, {});
      std::vector<LiveEvent> events;
      int packet = 0;
      double now = 0;
      for (const LiveUnit& unit : each->units) {
        RtpSender::Datagrams out, kept;
        now = 1 + test::seconds_of(*each, unit);
        ASSERT_TRUE(sender.send(unit, now, out));
        for (const RtpDatagram& datagram : out) {
          if (++packet <= begin || packet > begin + 6) kept.push_back(datagram);
        }
        network.put(kept, now);
        test::deliver(network, receiver, now, events);
      }
      test::deliver(network, receiver, now + 2, events);
      EXPECT_EQ(test::only(units_in(events), LiveTrack::face).size(), 100u) << begin;
    }
  }
}

TEST(RtpSession, JitterIsAdaptedTo) {
  const LiveTalk talk = random_talk(492);
  FaceRecovery recovery;
  const auto events = transfer(talk, {.repeat = 1}, {.jitter = 0.3});
  const auto shown = test::recovered(events, recovery);
  EXPECT_GT(shown.size(), 430u);
  test::expect_right(talk, shown);
}

TEST(RtpSession, APauseDoesNotHoldRepetitionsAndBundlesBack) {
  const LiveTalk talk = random_talk(2);
  RtpSender sender(talk.info, {.bundle = 4}, "192.0.2.1", 5004, 1, 0);
  RtpSender::Datagrams out;
  ASSERT_TRUE(sender.send(talk.units[0], 0, out));
  const std::size_t reports = out.size();
  sender.poll(0.1, out);
  EXPECT_EQ(out.size(), reports);  // the bundle waits for planes
  sender.poll(0.5, out);
  EXPECT_GT(out.size(), reports);
  const std::size_t sent = out.size();
  sender.poll(0.8, out);
  EXPECT_GT(out.size(), sent);  // the copy
}

TEST(RtpSession, SameSeedSameBytes) {
  LiveTalk talk = random_talk(10);
  test::add_sound(talk, test::aac_format());
  const auto bytes = [&talk](std::uint64_t seed) {
    RtpSender sender(talk.info, {}, "192.0.2.1", 5004, seed, 0);
    RtpSender::Datagrams out;
    for (const LiveUnit& unit : talk.units) EXPECT_TRUE(sender.send(unit, 0, out));
    sender.finish(1, out);
    return out;
  };
  EXPECT_EQ(bytes(1), bytes(1));
  EXPECT_NE(bytes(1), bytes(2));
}

TEST(RtpSession, ReorderingAndDuplicatesAreMended) {
  LiveTalk talk = random_talk(300);
  test::add_sound(talk, test::aac_format());
  expect_all(talk, transfer(talk, {}, {.duplicate = 20, .reorder = 20}, 3));
}

TEST(RtpSession, WithTheSyncOfReportsFaceAndSoundStayTogether) {
  LiveTalk talk = random_talk(100);
  test::add_sound(talk, test::aac_format());
  RtpSender sender(talk.info, {}, "192.0.2.1", 5004, 9, ntp_now());
  RtpSession foreign = *read_sdp(write_sdp(sender.session()));
  for (RtpTrack* track :
       {static_cast<RtpTrack*>(&*foreign.face), static_cast<RtpTrack*>(&*foreign.audio)}) {
    track->ssrc.reset();  // as others write descriptions
    track->clock_offset.reset();
  }
  foreign.face->timescale = 0;
  RtpReceiver receiver(foreign, {}, 1);
  BadNetwork network(1, {});
  const auto events = transfer(talk, network, receiver, sender);
  EXPECT_EQ(receiver.sync(), RtpSync::reports);
  const auto got = units_in(events);
  ASSERT_EQ(got.size(), talk.units.size());
  const auto face = test::only(got, LiveTrack::face);
  EXPECT_EQ(face[0].time, 0);
  EXPECT_EQ(face[1].time, 3600);
  EXPECT_EQ(face[0].duration, 3600);
  EXPECT_EQ(test::only(got, LiveTrack::audio), test::only(talk.units, LiveTrack::audio));
}

TEST(RtpSession, JoiningInTheMiddleWorksWithAndWithoutADescription) {
  const LiveTalk talk = random_talk(100, 25);
  for (const bool described : {true, false}) {
    RtpSender sender(talk.info, {}, "192.0.2.1", 5004, 4, ntp_now());
    RtpSession session = *read_sdp(write_sdp(sender.session()));
    if (!described) {
      session.face->config.clear();
      session.face->ssrc.reset();
      session.face->clock_offset.reset();
      session.face->payload_type = -1;
    }
    RtpReceiver receiver(session, {}, 1);
    BadNetwork network(1, {});
    FaceRecovery recovery;
    std::vector<LiveEvent> events;
    for (std::size_t i = 0; i < talk.units.size(); ++i) {
      RtpSender::Datagrams out;
      ASSERT_TRUE(sender.send(talk.units[i], 0.04 * double(i), out));
      if (i < 33) continue;
      network.put(out, 0.04 * double(i));
      test::deliver(network, receiver, 0.04 * double(i), events);
    }
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(std::get<LiveInfo>(events.front()).face_config, talk.info.face_config);
    const auto units = test::recovered(events, recovery);
    ASSERT_FALSE(units.empty());
    EXPECT_TRUE(units.front().intra);
    EXPECT_EQ(units.front().bytes, talk.units[talk.units.size() - units.size()].bytes);
    if (described) test::expect_right(talk, units);
  }
}

TEST(RtpSession, ASenderThatBeginsAnewIsFollowed) {
  const LiveTalk talk = random_talk(50);
  RtpSender first(talk.info, {}, "192.0.2.1", 5004, 1, ntp_now());
  RtpSender second(talk.info, {}, "192.0.2.1", 5004, 2, ntp_now());
  RtpReceiver receiver(*read_sdp(write_sdp(first.session())), {}, 1);
  BadNetwork network(1, {});
  std::vector<LiveEvent> events;
  double now = 0;
  for (RtpSender* sender : {&first, &second}) {  // the first one does not say goodbye
    now += 2;
    for (const LiveUnit& unit : talk.units) {
      RtpSender::Datagrams out;
      ASSERT_TRUE(sender->send(unit, now += 0.04, out));
      network.put(out, now);
      test::deliver(network, receiver, now, events);
    }
  }
  EXPECT_EQ(count_gaps(events), 0);
  EXPECT_EQ(std::count(events.begin(), events.end(), LiveEvent(LiveRestart{})), 1);
  const auto units = units_in(events);
  ASSERT_EQ(units.size(), 100u);
  expect_same({units.begin(), units.begin() + 50}, talk.units);
  expect_same({units.begin() + 50, units.end()}, talk.units);
  int infos = 0;
  for (const LiveEvent& event : events) infos += std::holds_alternative<LiveInfo>(event) ? 1 : 0;
  EXPECT_EQ(infos, 2);
}

TEST(RtpSession, AStrayPacketOfAnotherSenderChangesNothing) {
  const LiveTalk talk = random_talk(10);
  RtpSender sender(talk.info, {.repeat = 1}, "192.0.2.1", 5004, 1, ntp_now());
  RtpReceiver receiver(*read_sdp(write_sdp(sender.session())), {}, 1);
  BadNetwork network(1, {});
  std::vector<LiveEvent> events;
  for (std::size_t i = 0; i < talk.units.size(); ++i) {
    RtpSender::Datagrams out;
    ASSERT_TRUE(sender.send(talk.units[i], double(i), out));
    RtpPacket stray;
    stray.ssrc = 1;
    stray.sequence = std::uint16_t(i * 7);
    stray.payload = {0, 0, 1, 0xBB, 0x20};
    network.put(out, double(i));
    test::deliver(network, receiver, double(i), events);
    receiver.rtp(LiveTrack::face, write_rtp(stray), {}, double(i));
  }
  expect_same(units_in(events), talk.units);
}

TEST(RtpSession, ReportsComeBack) {
  LiveTalk talk = random_talk(500);
  RtpSender sender(talk.info, {.repeat = 1}, "192.0.2.1", 5004, 1, ntp_now());
  RtpReceiver receiver(*read_sdp(write_sdp(sender.session())), {}, 77);
  BadNetwork network(5, {.loss = 20});
  std::vector<LiveEvent> events;
  double now = 0;
  for (const LiveUnit& unit : talk.units) {
    RtpSender::Datagrams out;
    ASSERT_TRUE(sender.send(unit, now += 0.04, out));
    network.put(out, now);
    test::deliver(network, receiver, now, events);
    for (const RtpDatagram& report : receiver.reports(now)) sender.rtcp(report.bytes, now);
  }
  EXPECT_EQ(sender.stats(now).receivers, 1);
  EXPECT_NEAR(sender.stats(now).reported_loss, 0.2, 0.1);
  EXPECT_NEAR(double(receiver.stats().lost), 100, 40);
  EXPECT_EQ(sender.stats(now + 60).receivers, 0);
}

TEST(RtpSession, UnitsThatCannotBeSentAreRefused) {
  const LiveTalk talk = random_talk(1);
  RtpSender sender(talk.info, {}, "192.0.2.1", 5004, 1, 0);
  RtpSender::Datagrams out;
  EXPECT_EQ(sender.send({}, 0, out).error().code, Code::invalid_argument);
  EXPECT_FALSE(sender.send({LiveTrack::audio, {1}, false, 0, 1024}, 0, out));
  EXPECT_TRUE(out.empty());
  LiveTalk sound = random_talk(1);
  test::add_sound(sound, opus());
  RtpSender other(sound.info, {}, "192.0.2.1", 5004, 1, 0);
  EXPECT_FALSE(other.send({LiveTrack::audio, test::Bytes(1390), false, 0, 960}, 0, out));
  EXPECT_TRUE(other.send({LiveTrack::audio, test::Bytes(1388), false, 0, 960}, 0, out));
}

TEST(RtpSession, OptionsHaveBounds) {
  const LiveInfo info{{1}, 25000, 0x61, std::nullopt};
  EXPECT_TRUE(check(info, {}));
  for (const RtpOptions& bad :
       {RtpOptions{.mtu = 255}, RtpOptions{.repeat = 0}, RtpOptions{.bundle = 17},
        RtpOptions{.repeat_after = 0}, RtpOptions{.audio_bundle = 0}, RtpOptions{.ttl = 256}}) {
    EXPECT_EQ(check(info, bad).error().code, Code::invalid_argument);
  }
  EXPECT_FALSE(check(LiveInfo{}, {}));
  EXPECT_FALSE(check(LiveInfo{{1}, 0, 0x61, std::nullopt}, {}));
}

}  // namespace rtp_session_test
}  // namespace animeme::media

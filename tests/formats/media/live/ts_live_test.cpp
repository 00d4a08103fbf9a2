// Transport streams over UDP and SRT, there and back.
#include "tools/formats/media/live/ts_live.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/formats/media/live/ports.h"
#include "tests/support/live_reference.h"

namespace animeme::test {
namespace ts_live_test {

using media::LiveGap;
using media::LiveTrack;
using media::LiveUnit;
using media::make_ts_sink;
using media::make_ts_source;
using ::testing::HasSubstr;

std::string local_url(const char* scheme, int port, const std::string& query = "") {
  return std::string(scheme) + "://127.0.0.1:" + std::to_string(port) + query;
}

bool has_srt() {
  const auto sink = make_ts_sink("srt://127.0.0.1:9");
  return sink || sink.error().code != Code::unsupported;
}

/// What a transport stream must give back, but for the durations.
std::vector<LiveUnit> expected(const Presentation& show, LiveTrack track) {
  std::vector<LiveUnit> units = of_track(show.units, track);
  if (track != LiveTrack::face) return units;
  for (LiveUnit& unit : units) unit = through_clock(unit, show.info.timescale, 90000);
  return units;
}

void expect_whole(const Received& got, const Presentation& show) {
  EXPECT_EQ(got.error, "");
  EXPECT_TRUE(got.ended);
  EXPECT_TRUE(got.gaps.empty());
  ASSERT_EQ(got.infos.size(), 1u);
  EXPECT_EQ(got.infos[0].face_config, show.info.face_config);
  EXPECT_EQ(got.infos[0].timescale, 90000u);
  EXPECT_EQ(got.infos[0].visual_profile, show.info.visual_profile);
  EXPECT_EQ(got.infos[0].audio, show.info.audio);
  expect_equal(got.of(LiveTrack::face), expected(show, LiveTrack::face), Durations::ignored);
  expect_equal(got.of(LiveTrack::audio), expected(show, LiveTrack::audio), Durations::ignored);
}

// One source for all of them: the end of one presentation must not disturb the next.
TEST(TsLive, EveryReferenceStreamComesBackOverUdp) {
  const std::string url = local_url("udp", free_udp_port());
  auto source = make_ts_source(url);
  ASSERT_TRUE(source) << source.error().describe();
  const int count = for_each_reference([&](const Presentation& show, int) {
    auto sink = make_ts_sink(url);
    ASSERT_TRUE((*sink)->start(show.info));
    expect_whole(loop(**sink, **source, show), show);
  });
  EXPECT_GT(count, 100);
  EXPECT_EQ((*source)->stats().lost, 0);
}

TEST(TsLive, ReferenceStreamsComeBackOverSrt) {
  if (!has_srt()) GTEST_SKIP() << "this FFmpeg was built without srt";
  const auto streams = reference_streams();
  for (std::size_t i = 0; i < streams.size(); i += 20) {
    SCOPED_TRACE(streams[i].filename());
    Presentation show = reference(streams[i]);
    add_sound(show, i % 40 == 0 ? aac_format() : opus_format());
    const int port = free_udp_port();
    auto source = make_ts_source(local_url("srt", port, "?mode=listener&latency=20000"));
    ASSERT_TRUE(source) << source.error().describe();
    auto sink = make_ts_sink(local_url("srt", port, "?mode=caller&latency=20000"));
    Result<void> started;
    for (int attempt = 0; attempt < 20; ++attempt) {  // the listener opens in the background
      started = (*sink)->start(show.info);
      if (started) break;
    }
    ASSERT_TRUE(started) << started.error().describe();
    EXPECT_EQ((*sink)->stats().receivers, 1);
    expect_whole(loop(**sink, **source, show), show);
    if (HasFatalFailure()) return;
  }
}

// The sink listens, and a second receiver comes when the first has gone.
TEST(TsLive, AnSrtSinkWaitsForReceivers) {
  if (!has_srt()) GTEST_SKIP() << "this FFmpeg was built without srt";
  const auto streams = reference_streams();
  Presentation show = reference(streams[0]);
  const int port = free_udp_port();
  auto sink = make_ts_sink(local_url("srt", port, "?mode=listener&passphrase=0123456789abc"));
  ASSERT_TRUE((*sink)->start(show.info));
  ASSERT_TRUE((*sink)->send(show.units[0]));
  EXPECT_EQ((*sink)->stats().dropped, 1) << "nobody is there yet";
  std::atomic<bool> over = false;
  std::thread sender([&] {
    LiveUnit unit = show.units[0];
    while (!over) {
      unit.time += unit.duration;
      EXPECT_TRUE((*sink)->send(unit));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  for (int visitor = 0; visitor < 2; ++visitor) {
    auto source = make_ts_source(local_url("srt", port, "?mode=caller&passphrase=0123456789abc"));
    EXPECT_TRUE(source) << source.error().describe();
    Received got;
    while (source && got.units.size() < 3 && receive(**source, got, 5)) {
    }
    EXPECT_EQ(got.units.size(), 3u);
    for (const LiveUnit& unit : got.units) EXPECT_EQ(unit.bytes, show.units[0].bytes);
  }
  over = true;
  sender.join();
}

// The end comes while the receiver leaves: not the moment to wait for another one.
TEST(TsLive, AnSrtSinkEndsWhenItsReceiverHasJustGone) {
  if (!has_srt()) GTEST_SKIP() << "this FFmpeg was built without srt";
  Presentation show = reference(reference_streams()[0]);
  for (int round = 0; round < 5; ++round) {
    const int port = free_udp_port();
    auto sink = make_ts_sink(local_url("srt", port, "?mode=listener&latency=20000"));
    ASSERT_TRUE((*sink)->start(show.info));
    auto source = make_ts_source(local_url("srt", port, "?mode=caller&latency=20000"));
    ASSERT_TRUE(source) << source.error().describe();
    LiveUnit unit = show.units[0];
    const auto send = [&] {
      unit.time += unit.duration;
      ASSERT_TRUE((*sink)->send(unit));
    };
    Received got;
    while (got.units.empty()) {
      send();
      receive(**source, got, 0.05);
    }
    source->reset();
    for (int i = 0; i < 200 * round; ++i) send();
    EXPECT_TRUE((*sink)->finish());  // it once waited for ever here
  }
}

TEST(TsLive, AMulticastGroupCarriesIt) {
  Presentation show = reference(reference_streams()[0]);
  const std::string url =
      "udp://239.255.77.1:" + std::to_string(free_udp_port()) + "?localaddr=127.0.0.1&ttl=0";
  auto source = make_ts_source(url);
  if (!source) GTEST_SKIP() << "no multicast on this machine: " << source.error().describe();
  auto sink = make_ts_sink(url);
  if (!(*sink)->start(show.info)) GTEST_SKIP() << "no multicast on this machine";
  const Received first = [&] {
    Received got;
    EXPECT_TRUE((*sink)->send(show.units[0]));
    receive(**source, got, 2);
    return got;
  }();
  if (first.infos.empty()) GTEST_SKIP() << "multicast does not come back on this machine";
  show.units.erase(show.units.begin());
  const Received got = loop(**sink, **source, show);
  EXPECT_TRUE(got.ended);
  EXPECT_TRUE(got.gaps.empty());
  EXPECT_EQ(got.units.size(), show.units.size() + 1);
}

TEST(TsLive, ErrorsNameTheRemedy) {
  for (const char* url :
       {"", "udp://", "http://127.0.0.1:80", "udp://127.0.0.1", "udp://:5000", "udp://127.0.0.1:0",
        "udp://127.0.0.1:70000", "udp://127.0.0.1:5x", "srt://127.0.0.1:5000?mode=both"}) {
    const auto sink = make_ts_sink(url);
    ASSERT_FALSE(sink) << url;
    EXPECT_EQ(sink.error().code, Code::invalid_argument) << url;
    EXPECT_THAT(sink.error().message, HasSubstr("udp://HOST:PORT"));
  }
  EXPECT_FALSE(make_ts_sink("udp://127.0.0.1:5000", {.datagram_bytes = 100}));
  EXPECT_FALSE(make_ts_sink("udp://127.0.0.1:5000", {.table_period = 5}));

  UdpSocket taken;
  const auto busy = make_ts_source(local_url("udp", taken.port()));
  ASSERT_FALSE(busy);
  EXPECT_EQ(busy.error().code, Code::io);
  EXPECT_THAT(busy.error().message, HasSubstr("in use"));

  if (!has_srt()) return;
  const auto alone = make_ts_source(
      local_url("srt", free_udp_port(), "?connect_timeout=300&passphrase=secretsecret"));
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, Code::io);
  EXPECT_THAT(alone.error().message, HasSubstr("listening"));
  EXPECT_THAT(alone.error().message, ::testing::Not(HasSubstr("secret")));
}

TEST(TsLive, TheSinkRefusesWhatItCannotSend) {
  auto sink = make_ts_sink(local_url("udp", free_udp_port()));
  EXPECT_EQ((*sink)->send({}).error().code, Code::invalid_argument) << "not started";
  EXPECT_EQ((*sink)->start({}).error().code, Code::invalid_argument) << "nothing to send";
  EXPECT_EQ((*sink)->start({.face_config = {0, 0, 1, 0xB5, 9}}).error().code,
            Code::invalid_argument);
  const Presentation show = reference(reference_streams()[0]);
  ASSERT_TRUE((*sink)->start(show.info));
  LiveUnit unit = show.units[0];
  EXPECT_TRUE((*sink)->send(unit)) << "no listener is no error";
  EXPECT_EQ((*sink)->send(unit).error().code, Code::invalid_argument) << "time does not ascend";
  unit.track = LiveTrack::audio;
  EXPECT_EQ((*sink)->send(unit).error().code, Code::invalid_argument) << "no such track";
  unit = show.units[0];
  unit.time = -10 * std::int64_t(show.info.timescale);
  EXPECT_EQ((*sink)->send(unit).error().code, Code::invalid_argument) << "too early";
  EXPECT_TRUE((*sink)->finish());
}

TEST(TsLive, ASourceWaitsNoLongerThanItIsTold) {
  auto source = make_ts_source(local_url("udp", free_udp_port()));
  ASSERT_TRUE(source);
  for (const double seconds : {0.0, -1.0, 0.05}) {
    const auto event = (*source)->next(seconds);
    ASSERT_TRUE(event);
    EXPECT_TRUE(std::holds_alternative<media::LiveIdle>(*event));
  }
}

}  // namespace ts_live_test
}  // namespace animeme::test

// The web server and its client, there and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/live/web/http.h"
#include "tests/support/live_reference.h"
#include "tools/live/web/web.h"

namespace animeme::test {
namespace web_live_test {

using media::LiveTrack;
using media::LiveUnit;
using ::testing::HasSubstr;
using web::make_web_sink;
using web::make_web_source;

std::unique_ptr<web::WebSink> serve(const Presentation& show, const web::WebOptions& options = {}) {
  auto sink = make_web_sink("http://127.0.0.1:0/", options);
  EXPECT_TRUE(sink);
  const Result<void> started = (*sink)->start(show.info);
  EXPECT_TRUE(started) << (started ? "" : started.error().describe());
  return std::move(*sink);
}

TEST(WebLive, EveryReferenceStreamComesBack) {
  const int count = for_each_reference([](const Presentation& show, int number) {
    const auto sink = serve(show, {.packets_per_segment = 1 + number % 5});
    auto source = make_web_source(sink->address());
    ASSERT_TRUE(source) << source.error().describe();
    const Received got = loop(*sink, **source, show);
    EXPECT_EQ(got.error, "");
    EXPECT_TRUE(got.ended);
    EXPECT_TRUE(got.gaps.empty());
    ASSERT_EQ(got.infos.size(), 1u);
    EXPECT_EQ(got.infos[0], show.info);
    expect_equal(got.of(LiveTrack::face), of_track(show.units, LiveTrack::face));
    expect_equal(got.of(LiveTrack::audio), of_track(show.units, LiveTrack::audio));
  });
  EXPECT_GT(count, 100);
}

TEST(WebLive, SoundAloneIsServed) {
  Presentation show = live_presentation(50, 10);
  add_sound(show, aac_format());
  std::erase_if(show.units, [](const LiveUnit& unit) { return unit.track == LiveTrack::face; });
  show.info.face_config.clear();
  const auto sink = serve(show);
  auto source = make_web_source(sink->address());
  ASSERT_TRUE(source);
  const Received got = loop(*sink, **source, show);
  EXPECT_TRUE(got.ended);
  expect_equal(got.of(LiveTrack::audio), show.units);
}

// A newcomer begins with the newest intra plane, at once or with the next one.
TEST(WebLive, LateJoinersBeginAtAnIntraPlane) {
  Presentation show = live_presentation(100, 20);
  add_sound(show, aac_format());
  for (const bool catch_up : {true, false}) {
    const auto sink = serve(show, {.catch_up = catch_up});
    std::size_t i = 0;
    for (int planes = 0; planes < 50; ++i) {
      ASSERT_TRUE(sink->send(show.units[i]));
      planes += show.units[i].track == LiveTrack::face ? 1 : 0;
    }
    auto source = make_web_source(sink->address());
    ASSERT_TRUE(source);
    Received got;
    receive(**source, got, catch_up ? 5 : 0.2);
    for (; i < show.units.size(); ++i) ASSERT_TRUE(sink->send(show.units[i]));
    ASSERT_TRUE(sink->finish());
    while (receive(**source, got, 5)) {
    }
    EXPECT_TRUE(got.ended);
    const auto face = got.of(LiveTrack::face), sent = of_track(show.units, LiveTrack::face);
    const std::size_t first = catch_up ? 40 : 60;
    ASSERT_EQ(face.size(), 100 - first);
    for (std::size_t k = 0; k < face.size(); ++k) EXPECT_EQ(face[k], sent[first + k]);
    ASSERT_EQ(got.infos.size(), 1u);
    EXPECT_EQ(got.infos[0].audio->priming, 0);
    const auto sound = got.of(LiveTrack::audio);
    ASSERT_FALSE(sound.empty());
    const double lead = double(face[0].time) / 25000 - double(sound[0].time) / 48000;
    if (catch_up) {
      EXPECT_NEAR(lead, 0.25, 0.1) << "sound from a little before the plane";
    }
  }
}

TEST(WebLive, AClientThatDoesNotReadLosesUnitsAndIsTold) {
  Presentation show = live_presentation(3000, 50);
  const auto sink = serve(show, {.client_bytes = 4096});
  auto source = make_web_source(sink->address(), {.queue_bytes = 2000});
  ASSERT_TRUE(source);
  // The sockets between the two take some megabytes, so the units have to be large.
  const std::vector<std::uint8_t> ballast(200000, 0x55);
  std::vector<LiveUnit> sent;
  for (int i = 0; i < 120; ++i) {
    LiveUnit unit = show.units[std::size_t(i)];
    unit.bytes.insert(unit.bytes.end(), ballast.begin(), ballast.end());
    sent.push_back(unit);
    ASSERT_TRUE(sink->send(unit));
  }
  EXPECT_GT(sink->stats().dropped, 0);
  Received got;
  while (receive(**source, got, 0.5)) {
  }
  const std::size_t before = got.units.size();
  EXPECT_LT(before, sent.size());
  for (int i = 120; i < 220; ++i) {  // now it reads
    sent.push_back(show.units[std::size_t(i)]);
    ASSERT_TRUE(sink->send(sent.back()));
    while (receive(**source, got, 0.002)) {
    }
  }
  ASSERT_TRUE(sink->finish());
  while (receive(**source, got, 5)) {
  }
  EXPECT_TRUE(got.ended);
  EXPECT_FALSE(got.gaps.empty());
  std::size_t at = 0;
  for (std::size_t i = 0; i < got.units.size(); ++i) {
    const bool gap = std::any_of(got.gaps.begin(), got.gaps.end(),
                                 [&](const auto& each) { return each.first == i; });
    const std::size_t from = at;
    while (at < sent.size() && sent[at] != got.units[i]) ++at;
    ASSERT_LT(at, sent.size());
    EXPECT_TRUE(at == from || gap) << "a loss that nobody tells of at " << i;
    EXPECT_TRUE(!gap || got.units[i].intra);
    ++at;
  }
  EXPECT_EQ(got.units.back(), sent.back());
}

TEST(WebLive, ErrorsNameTheRemedy) {
  for (const char* url : {"", "http:/", "udp://127.0.0.1:80", "http://127.0.0.1:99999",
                          "http://127.0.0.1:80/live", "http://a b:80/", "http://h:x/"}) {
    const auto sink = make_web_sink(url);
    ASSERT_FALSE(sink) << url;
    EXPECT_EQ(sink.error().code, Code::invalid_argument) << url;
  }
  EXPECT_EQ(make_web_sink("https://127.0.0.1/").error().code, Code::unsupported);
  EXPECT_EQ(make_web_sink("http://127.0.0.1:0", {.max_clients = 0}).error().code,
            Code::invalid_argument);
  EXPECT_EQ(make_web_sink("http://127.0.0.1:0", {.packets_per_segment = 99}).error().code,
            Code::invalid_argument);
  const Presentation show = live_presentation(3, 2);
  const auto sink = serve(show);
  auto second = make_web_sink(sink->address());
  const Result<void> busy = (*second)->start(show.info);
  ASSERT_FALSE(busy);
  EXPECT_EQ(busy.error().code, Code::io);
  EXPECT_THAT(busy.error().message, HasSubstr("in use"));
  auto elsewhere = make_web_sink("http://192.0.2.1:0/");  // of no machine
  EXPECT_EQ((*elsewhere)->start(show.info).error().code, Code::io);
  const std::string address = sink->address();
  ASSERT_TRUE(sink->finish());
  const auto alone = make_web_source(address);
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, Code::io);
  EXPECT_THAT(alone.error().message, HasSubstr("does a server"));
}

TEST(WebLive, TheSinkRefusesWhatItCannotSend) {
  const Presentation show = live_presentation(3, 2);
  auto sink = make_web_sink("http://127.0.0.1:0/");
  EXPECT_EQ((*sink)->address(), "");
  EXPECT_EQ((*sink)->send(show.units[0]).error().code, Code::invalid_argument);
  EXPECT_EQ((*sink)->start({}).error().code, Code::invalid_argument);
  ASSERT_TRUE((*sink)->start(show.info));
  EXPECT_EQ((*sink)->start(show.info).error().code, Code::invalid_argument);
  LiveUnit unit = show.units[0];
  unit.time = -25001;
  EXPECT_EQ((*sink)->send(unit).error().code, Code::invalid_argument);
  unit.track = LiveTrack::audio;
  EXPECT_EQ((*sink)->send(unit).error().code, Code::invalid_argument);
  EXPECT_TRUE((*sink)->finish());
  EXPECT_TRUE((*sink)->finish()) << "twice is no error";
  EXPECT_EQ((*sink)->send(show.units[0]).error().code, Code::invalid_argument);
}

// What is told between the frames reaches both sockets, on their clock; who wants frames alone does
// not see it.
TEST(WebLive, WhatIsToldStandsBetweenTheFrames) {
  const Presentation show = live_presentation(20, 10);
  const auto sink = serve(show);
  auto source = make_web_source(sink->address());
  ASSERT_TRUE(source);
  const int port = port_of(sink->address());
  Connection values(port), units(port);
  values.send(upgrade(port, "/faps"));
  units.send(upgrade(port, "/face"));
  const auto read_until = [](Connection& connection, const std::string& part) {
    return connection.read([&](const std::string& got) { return got.find(part) != got.npos; });
  };
  ASSERT_THAT(read_until(values, "\"faps\""), HasSubstr(" 101 "));
  ASSERT_THAT(read_until(units, "A\x01"), HasSubstr(" 101 "));
  for (std::size_t i = 0; i < show.units.size(); ++i) {
    ASSERT_TRUE(sink->send(show.units[i]));
    ASSERT_TRUE(sink->tell("{\"event\": \"word\", \"time\": 0.25, \"word\": \"größe\"}"));
  }
  EXPECT_FALSE(sink->tell("no JSON"));
  EXPECT_FALSE(sink->tell("[]"));
  const std::string told = "{\"event\":\"word\",\"time\":1.25,\"word\":\"größe\"}";
  EXPECT_THAT(read_until(values, told), HasSubstr(told));
  EXPECT_THAT(read_until(units, told), HasSubstr(told));
  ASSERT_TRUE(sink->finish());
  Received got;
  while (receive(**source, got, 5)) {
  }
  EXPECT_TRUE(got.ended);
  expect_equal(got.of(LiveTrack::face), of_track(show.units, LiveTrack::face));
}

}  // namespace web_live_test
}  // namespace animeme::test

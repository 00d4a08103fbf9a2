// Whose transport stream is heard, and what becomes of one that begins again.
#include <gtest/gtest.h>

#include "tests/formats/media/live/ports.h"
#include "tests/support/live_loop.h"
#include "tools/formats/media/detail/ts/ts_input.h"
#include "tools/formats/media/live/recovery.h"
#include "tools/formats/media/live/ts_live.h"
#include "tools/formats/media/rtp/session_clock.h"

namespace animeme::test {
namespace ts_pin_test {

using media::LiveEvent;
using media::LiveTrack;
using media::LiveUnit;
using media::TsInput;
using media::UdpAddress;

using Datagram = std::vector<std::uint8_t>;

/// The datagrams of each unit of a presentation; those behind its end at the end.
std::vector<std::vector<Datagram>> recorded(const Presentation& show) {
  UdpSocket socket;
  auto sink = media::make_ts_sink("udp://127.0.0.1:" + std::to_string(socket.port()));
  EXPECT_TRUE((*sink)->start(show.info));
  std::vector<std::vector<Datagram>> all;
  std::int64_t taken = 0;
  const auto take = [&] {
    all.emplace_back();
    while (taken < (*sink)->stats().bytes) {
      all.back().push_back(socket.take(5000));
      if (all.back().back().empty()) break;
      taken += std::int64_t(all.back().back().size());
    }
  };
  for (const LiveUnit& unit : show.units) {
    EXPECT_TRUE((*sink)->send(unit));
    take();
  }
  EXPECT_TRUE((*sink)->finish());
  take();
  return all;
}

/// A source without sockets, on a clock that goes on, and what can be shown of it.
struct Hearing {
  TsInput input;
  media::SessionClock clock;
  media::FaceRecovery recovery;
  std::vector<LiveUnit> shown;
  std::vector<double> arrivals;
  bool ended = false;

  explicit Hearing(bool any_source = false) : input(any_source) {}
  void push(const Datagram& datagram, const std::string& host, double now) {
    std::deque<LiveEvent> raw, steady;
    input.push(datagram, *UdpAddress::resolve(host, 4000), now, raw);
    for (LiveEvent& event : raw) clock.push(std::move(event), now, steady);
    for (LiveEvent& event : steady) {
      if (std::holds_alternative<media::LiveEnd>(event)) ended = true;
      auto unit = recovery.accept(std::move(event));
      if (!unit || unit->track != LiveTrack::face) continue;
      if (!shown.empty()) {
        EXPECT_GT(unit->time, shown.back().time);
      }
      shown.push_back(std::move(*unit));
      arrivals.push_back(now);
    }
  }
  /// Units [first, last) in their time; returns the time behind them.
  double play(const std::vector<std::vector<Datagram>>& stream, std::size_t first, std::size_t last,
              const std::string& host, double now) {
    for (std::size_t i = first; i < last; ++i, now += 0.04) {
      for (const Datagram& each : stream[i]) push(each, host, now);
    }
    return now;
  }
};

Presentation face_of(int planes, unsigned seed) { return live_presentation(planes, 10, seed); }

TEST(TsPin, ASecondSenderIsIgnoredAsLongAsTheFirstIsThere) {
  const auto stream = recorded(face_of(100, 1)), other = recorded(face_of(100, 2));
  Hearing hearing;
  double now = hearing.play(stream, 0, 10, "192.0.2.1", 0);
  for (std::size_t i = 10; i < 100; ++i, now += 0.04) {
    for (const Datagram& each : stream[i]) hearing.push(each, "192.0.2.1", now);
    for (const Datagram& each : other[i]) hearing.push(each, "192.0.2.9", now);
  }
  for (const Datagram& each : other.back()) hearing.push(each, "192.0.2.9", now);
  EXPECT_FALSE(hearing.ended);
  EXPECT_EQ(hearing.shown.size(), 100u);
  EXPECT_EQ(hearing.input.stats().sessions, 1);
  EXPECT_GE(hearing.input.stats().foreign, 90);
  for (const Datagram& each : stream.back()) hearing.push(each, "192.0.2.1", now);
  EXPECT_TRUE(hearing.ended);

  Hearing all(true);  // both are one stream, for what that is worth
  now = all.play(stream, 0, 50, "192.0.2.1", 0);
  all.play(stream, 50, 100, "192.0.2.9", now);
  EXPECT_EQ(all.shown.size(), 100u);
}

TEST(TsPin, ANewSenderGoesOnBehindASilentOne) {
  const Presentation first = face_of(100, 1), second = face_of(100, 2);
  const auto stream = recorded(first), other = recorded(second);
  for (const double pause : {0.1, 3.0}) {
    Hearing hearing;
    double now = hearing.play(stream, 0, 60, "192.0.2.1", 0);  // and then nothing, not even an end
    const double begin = now + pause;
    hearing.play(other, 0, 100, "192.0.2.2", begin);
    EXPECT_EQ(hearing.shown.size(), 160u) << pause;
    EXPECT_EQ(hearing.shown[60].bytes, second.units[0].bytes);
    EXPECT_LT(hearing.arrivals[60], std::max(now + 1.1, begin + 0.1));
    const double ours = double(hearing.shown[60].time - hearing.shown[0].time) / 90000;
    EXPECT_NEAR(ours, hearing.arrivals[60], 0.3) << pause;
    EXPECT_EQ(hearing.clock.sessions(), 2);
    EXPECT_EQ(hearing.recovery.stats().freezes, 1) << "the pause was seen";
  }
}

// From the same port, so that only the stream itself tells.
TEST(TsPin, AStreamThatBeginsAgainGoesOnAtTheNextIntraPlane) {
  const Presentation show = face_of(200, 1), second = face_of(100, 2);
  const auto stream = recorded(show), other = recorded(second);
  for (const std::size_t joined : {0u, 5u, 6u, 7u}) {
    Hearing hearing;
    double now = hearing.play(stream, 0, 200, "192.0.2.1", 0) + 0.2;
    hearing.play(other, joined, 100, "192.0.2.1", now);
    ASSERT_GE(hearing.shown.size(), 280u) << joined;
    const LiveUnit& next = hearing.shown[200];
    EXPECT_TRUE(next.intra);
    const bool of_the_second = std::any_of(second.units.begin(), second.units.end(),
                                           [&](const auto& u) { return u.bytes == next.bytes; });
    EXPECT_TRUE(of_the_second);
    const double gap = double(next.time - hearing.shown[199].time) / 90000;
    EXPECT_LT(gap, 1.1);
  }
}

}  // namespace ts_pin_test
}  // namespace animeme::test

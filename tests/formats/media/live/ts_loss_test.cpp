// Transport streams that lose packets, that are joined late, and that are none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "tests/formats/media/live/ports.h"
#include "tests/support/files.h"
#include "tests/support/live_loop.h"
#include "tests/support/reference_streams.h"
#include "tests/support/shared.h"
#include "tests/support/temp_dir.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/detail/ts/ts_events.h"
#include "tools/formats/media/live/ts_live.h"
#include "tools/formats/media/mux.h"

namespace animeme::test {
namespace ts_loss_test {

using media::LiveGap;
using media::LiveTrack;
using media::LiveUnit;

std::string url_of(int port) { return "udp://127.0.0.1:" + std::to_string(port); }

/// Hands on the datagrams of a sink, or does not.
class Relay {
 public:
  explicit Relay(int to) : to_(to) {}
  std::string url() const { return url_of(socket_.port()); }

  /// What the sink has sent so far, each datagram if `keep` says so.
  void run(const media::LiveSink& sink, const std::function<bool()>& keep) {
    while (bytes_ < sink.stats().bytes) {
      const auto datagram = socket_.take(5000);
      ASSERT_FALSE(datagram.empty());
      bytes_ += std::int64_t(datagram.size());
      if (keep()) socket_.send(datagram, to_);
    }
  }

 private:
  UdpSocket socket_;
  const int to_;
  std::int64_t bytes_ = 0;
};

/// Sends all units over a relay that keeps datagrams of unit i by `keep(i)`.
Received send_with_loss(const Presentation& show, const std::function<bool(std::size_t)>& keep) {
  const int port = free_udp_port();
  auto source = media::make_ts_source(url_of(port));
  Relay relay(port);
  auto sink = media::make_ts_sink(relay.url());
  EXPECT_TRUE(source);
  EXPECT_TRUE((*sink)->start(show.info));
  Received got;
  for (std::size_t i = 0; i < show.units.size(); ++i) {
    EXPECT_TRUE((*sink)->send(show.units[i]));
    relay.run(**sink, [&] { return keep(i); });
    while (receive(**source, got, 0)) {
    }
  }
  EXPECT_TRUE((*sink)->finish());
  relay.run(**sink, [] { return true; });
  while (!got.ended && receive(**source, got, 5)) {
  }
  EXPECT_TRUE(got.ended);
  return got;
}

/// Position of each received unit in what was sent.
std::vector<std::size_t> positions(const std::vector<LiveUnit>& got,
                                   const std::vector<LiveUnit>& sent) {
  std::vector<std::size_t> found;
  std::size_t at = 0;
  for (const LiveUnit& unit : got) {
    while (at < sent.size() && sent[at].bytes != unit.bytes) ++at;
    found.push_back(at);
    EXPECT_LT(at, sent.size()) << "a unit that nobody sent";
  }
  return found;
}

/// Nothing is missing that no gap tells of: what is used without one follows its predecessor.
/// Returns the number of face units that can be shown.
int expect_told(const Received& got, const Presentation& show, LiveTrack track) {
  std::vector<LiveUnit> sent;
  for (const LiveUnit& unit : show.units) {
    if (unit.track == track) sent.push_back(unit);
  }
  const std::vector<LiveUnit> units = got.of(track);
  const std::vector<std::size_t> position = positions(units, sent);
  std::size_t number = 0, shown = 0;
  bool usable = false;
  for (std::size_t i = 0; i < got.units.size(); ++i) {
    for (const auto& [where, gap] : got.gaps) {
      if (where == i && gap.track == track) usable = false;
    }
    if (got.units[i].track != track) continue;
    const LiveUnit& unit = units[number];
    if (track == LiveTrack::audio || unit.intra) {
      usable = true;
    } else if (usable) {
      EXPECT_EQ(position[number], position[number - 1] + 1) << "a loss that no gap tells of";
    }
    const std::int64_t want = through_clock(sent[position[number]], 25000, 90000).time;
    EXPECT_EQ(unit.time, track == LiveTrack::face ? want : sent[position[number]].time);
    shown += usable ? 1 : 0;
    ++number;
  }
  return int(shown);
}

TEST(TsLoss, EveryLossIsTold) {
  Presentation show = live_presentation(300, 12);
  add_sound(show, aac_format());
  for (const double loss : {0.01, 0.05, 0.3}) {
    std::mt19937 random(unsigned(loss * 1000));
    int lost = 0;
    const Received got = send_with_loss(show, [&](std::size_t i) {
      const bool keep = i < 8 || random() % 1000 >= unsigned(loss * 1000);
      lost += keep ? 0 : 1;
      return keep;
    });
    SCOPED_TRACE(loss);
    EXPECT_GT(lost, 2);
    EXPECT_FALSE(got.gaps.empty());
    const int shown = expect_told(got, show, LiveTrack::face);
    EXPECT_GT(shown, 300 * (1 - 13 * loss) - 40);
    expect_told(got, show, LiveTrack::audio);
    EXPECT_LT(got.units.size(), show.units.size());
  }
}

// The counters of a transport stream turn over after 16 packets.
TEST(TsLoss, LongOutagesAreTold) {
  Presentation show = live_presentation(60, 1000);
  add_sound(show, aac_format());
  for (std::size_t length = 1; length <= 100; length += 3) {
    SCOPED_TRACE(length);
    const Received got =
        send_with_loss(show, [&](std::size_t i) { return i < 20 || i >= 20 + length; });
    expect_told(got, show, LiveTrack::face);
  }
}

TEST(TsLoss, LateJoinersBeginAtAnIntraPlane) {
  Presentation show = live_presentation(150, 25);
  add_sound(show, aac_format());
  const Received got = send_with_loss(show, [](std::size_t i) { return i >= 120; });
  ASSERT_EQ(got.infos.size(), 1u);
  EXPECT_EQ(got.infos[0].face_config, show.info.face_config);
  ASSERT_TRUE(got.infos[0].audio);
  EXPECT_EQ(got.infos[0].audio->priming, 0) << "the first packet is long gone";
  ASSERT_FALSE(got.of(LiveTrack::face).empty());
  EXPECT_TRUE(got.of(LiveTrack::face)[0].intra);
  EXPECT_EQ(expect_told(got, show, LiveTrack::face), 100) << "joined behind plane 41";
}

std::vector<std::uint8_t> whole_stream(const Presentation& show) {
  UdpSocket socket;
  auto sink = media::make_ts_sink(url_of(socket.port()));
  EXPECT_TRUE((*sink)->start(show.info));
  std::vector<std::uint8_t> bytes;
  const auto collect = [&] {
    while (std::int64_t(bytes.size()) < (*sink)->stats().bytes) {
      const auto datagram = socket.take(5000);
      ASSERT_FALSE(datagram.empty());
      EXPECT_EQ(datagram.size() % 188, 0u);
      EXPECT_LE(datagram.size(), 1316u);
      bytes.insert(bytes.end(), datagram.begin(), datagram.end());
    }
  };
  for (const LiveUnit& unit : show.units) {
    EXPECT_TRUE((*sink)->send(unit));
    collect();
  }
  EXPECT_TRUE((*sink)->finish());
  collect();
  return bytes;
}

// What we send is what libavformat reads, and the tables come often.
TEST(TsLoss, OthersReadTheStream) {
  Presentation show = live_presentation(100, 25);
  const auto bytes = whole_stream(show);
  const auto file = media::read_container(bytes);
  ASSERT_TRUE(file) << file.error().describe();
  ASSERT_EQ(file->face.units.size(), show.units.size());
  for (std::size_t i = 0; i < show.units.size(); ++i) {
    EXPECT_EQ(file->face.units[i].bytes, show.units[i].bytes);
    EXPECT_EQ(file->face.units[i].time, std::int64_t(i) * 3600);
  }
  std::size_t tables = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 188) {
    tables += (bytes[at + 1] & 0x1F) == 0 && bytes[at + 2] == 0 ? 1 : 0;
  }
  EXPECT_GE(tables, 4 * 3u) << "every quarter of four seconds, and the end";
}

Received parse(const std::vector<std::uint8_t>& bytes, std::size_t piece) {
  media::TsDemuxer demuxer;
  media::TsEvents parser;
  std::deque<media::LiveEvent> events;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    std::vector<media::TsEvent> found;
    demuxer.push(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)), found);
    for (auto& event : found) parser.push(std::move(event), events);
  }
  parser.finish(events);
  Received got;
  for (auto& event : events) {
    if (auto* info = std::get_if<media::LiveInfo>(&event)) got.infos.push_back(*info);
    if (auto* gap = std::get_if<LiveGap>(&event)) got.gaps.emplace_back(got.units.size(), *gap);
    if (auto* unit = std::get_if<LiveUnit>(&event)) got.units.push_back(*unit);
  }
  return got;
}

TEST(TsLoss, TheCutOfTheBytesDoesNotMatter) {
  Presentation show = live_presentation(40, 10);
  add_sound(show, opus_format());
  const auto bytes = whole_stream(show);
  for (const std::size_t piece : {1u, 7u, 187u, 188u, 189u, 5000u}) {
    const Received got = parse(bytes, piece);
    EXPECT_EQ(got.units.size(), show.units.size()) << piece;
    EXPECT_TRUE(got.gaps.empty());
  }
}

// Other writers put several planes in a PES packet; so does mux, if asked to.
TEST(TsLoss, SharedPacketsArePartedAgain) {
  const TempDir dir;
  std::size_t streams = 0, most = 0;
  for (const auto& base : reference_streams()) {
    const auto face = fba::split_access_units(read_bytes(with(base, ".fba")));
    ASSERT_TRUE(face) << face.error().describe();
    std::vector<std::size_t> packets;
    for (const double shared : {0.0, 0.4}) {
      const auto written =
          media::write_container(dir / "a.ts", {.face = &*face}, {.shared_seconds = shared});
      ASSERT_TRUE(written) << written.error().describe();
      const auto bytes = read_bytes(dir / "a.ts");
      packets.push_back(bytes.size() / 188);
      const Received got = parse(bytes, 1316);
      EXPECT_TRUE(got.gaps.empty()) << base;
      const auto units = got.of(LiveTrack::face);
      ASSERT_EQ(units.size(), face->units.size()) << base << " " << shared;
      for (std::size_t i = 0; i < units.size(); ++i) {
        EXPECT_EQ(units[i].bytes, face->units[i].bytes);
        EXPECT_EQ(units[i].intra, face->units[i].intra);
        const double time = double(units[i].time - units[0].time) / 90000;
        EXPECT_NEAR(time, double(face->units[i].time) / face->timescale, 1.51 / 90000);
      }
    }
    ++streams;
    most = std::max(most, packets[0] - std::min(packets[0], packets[1]));
  }
  if (streams == 0) GTEST_SKIP() << "no reference streams";
  EXPECT_GT(most, 20u) << "nothing was shared";
}

TEST(TsLoss, PacketsThatComeTwiceCountOnce) {
  Presentation show = live_presentation(20, 10);
  const auto bytes = whole_stream(show);
  std::vector<std::uint8_t> twice;
  for (std::size_t at = 0; at < bytes.size(); at += 188) {
    for (int i = 0; i < 2; ++i) {
      twice.insert(twice.end(), bytes.begin() + std::ptrdiff_t(at),
                   bytes.begin() + std::ptrdiff_t(at + 188));
    }
  }
  const Received got = parse(twice, 188);
  EXPECT_EQ(got.units.size(), show.units.size());
  EXPECT_TRUE(got.gaps.empty());
}

// A film in stream type 0x10 is no face.
TEST(TsLoss, AFilmIsNoFace) {
  const Bytes bytes = read_bytes(data_dir() / "containers" / "mpeg4_video.ts");
  ASSERT_FALSE(bytes.empty());
  const Received got = parse(bytes, 1316);
  EXPECT_TRUE(got.of(LiveTrack::face).empty());
  for (const auto& info : got.infos) EXPECT_TRUE(info.face_config.empty());
}

TEST(TsLoss, DamagedStreamsAreSurvived) {
  Presentation show = live_presentation(40, 10);
  add_sound(show, aac_format());
  const auto bytes = whole_stream(show);
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    auto damaged = bytes;
    for (unsigned i = 0; i < 1 + random() % 60; ++i) {
      damaged[random() % damaged.size()] = std::uint8_t(random());
    }
    if (round % 3 == 1) damaged.erase(damaged.begin(), damaged.begin() + random() % 3000);
    const Received got = parse(damaged, 1 + random() % 3000);
    for (const LiveUnit& unit : got.units) EXPECT_LE(unit.bytes.size(), std::size_t(1) << 20);
    EXPECT_LE(got.units.size(), 2 * show.units.size());
  }
}

// A megabyte of noise is no reason to leave before the sender comes.
TEST(TsLoss, NoiseIsPassedOver) {
  const int port = free_udp_port();
  auto source = media::make_ts_source(url_of(port));
  UdpSocket noise;
  std::mt19937 random(9);
  Received got;
  for (int i = 0; i < 3000 && got.error.empty(); ++i) {
    std::vector<std::uint8_t> datagram(random() % 1400);
    for (auto& byte : datagram) byte = std::uint8_t(random());
    if (i % 2 == 0 && !datagram.empty()) datagram[0] = 0x47;
    noise.send(datagram, port);
    while (receive(**source, got, 0)) {
    }
  }
  EXPECT_EQ(got.error, "");
  EXPECT_TRUE(got.units.empty());
  EXPECT_FALSE(got.ended);
  const Presentation show = live_presentation(50, 10);
  auto sink = media::make_ts_sink(url_of(port));
  ASSERT_TRUE((*sink)->start(show.info));
  const Received talk = loop(**sink, **source, show);
  EXPECT_TRUE(talk.ended);
  EXPECT_EQ(talk.units.size(), show.units.size());
  EXPECT_GT((*source)->stats().foreign, 1000);
}

}  // namespace ts_loss_test
}  // namespace animeme::test

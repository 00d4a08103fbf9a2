// Senders, ours and those of others, that are killed and come back while the program receives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fap/text.h"
#include "tests/formats/media/live/stream_support.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme {
namespace receive_restart_test {

using test::container;
using test::Running;
using test::Streams;
using test::TempDir;
using test::wait_for;

struct Route {
  const char* name;
  std::string to, from;  // PORT, DIR
  const char* output;
};

void PrintTo(const Route& route, std::ostream* out) { *out << route.name; }

std::string fill_in(std::string text, int port, const std::string& dir) {
  const auto replace = [&](const std::string& what, const std::string& by) {
    if (const auto at = text.find(what); at != std::string::npos) text.replace(at, what.size(), by);
  };
  replace("PORT", std::to_string(port));
  replace("DIR", dir);
  return text;
}

class Restarts : public Streams, public testing::WithParamInterface<Route> {};

// The receiver is there first, the sender is killed without a goodbye and comes back on another
// clock; the second time it ends in good order.
TEST_P(Restarts, AreRecordedOn) {
  const int port = test::free_ports();
  const std::string folder = dir / "";
  const std::string to = fill_in(GetParam().to, port, folder);
  const std::string from = fill_in(GetParam().from, port, folder);
  const std::string output = dir / GetParam().output;
  const std::string listed = dir / "1.err";
  Running receive({"receive", from, "-o", output, "--json", "--stats", "--timeout", "30"},
                  dir / "1.out", listed);
  std::vector<std::string> stream = {"stream", dir / "talk.mp4", "--to", to, "--loop"};
  if (to.starts_with("rtp")) stream.insert(stream.end(), {"--sdp", dir / "talk.sdp"});
  {
    Running first(stream, dir / "s1.out", dir / "s1.err");
    ASSERT_TRUE(wait_for([&] { return test::slurp(listed).find("2 s: ") != std::string::npos; }))
        << test::slurp(dir / "s1.err") << test::slurp(listed);
    first.signal(SIGKILL);
    first.wait();
  }
  stream.insert(stream.end(), {"--duration", "4"});
  Running second(stream, dir / "s2.out", dir / "s2.err");
  EXPECT_EQ(second.wait(), 0) << test::slurp(dir / "s2.err");
  EXPECT_EQ(receive.wait(), 0) << test::slurp(listed);
  const auto json = nlohmann::json::parse(test::slurp(dir / "1.out"));
  EXPECT_EQ(json["sessions"], 2) << test::slurp(listed);
  EXPECT_EQ(json["freezes"], 1) << test::slurp(listed);
  // Both parts are there, and the time between them: neither dropped nor shown twice.
  const int planes = json["planes_usable"].get<int>();
  EXPECT_GT(planes, 40 + 60) << test::slurp(listed);
  const double seconds = json["face_seconds"].get<double>();
  EXPECT_NEAR(seconds, planes / 25.0 + json["frozen_seconds"].get<double>(), 1.5);
  if (output.ends_with(".fap")) {
    const auto text = fap::read_text(test::slurp(output));
    ASSERT_TRUE(text) << text.error().describe();
    EXPECT_NEAR(double(text->frames.size()) / 25, seconds, 0.5);
  } else {
    const media::Container got = container(output);
    EXPECT_EQ(int(got.face.units.size()), planes);
    for (std::size_t i = 1; i < got.face.units.size(); ++i) {
      ASSERT_GT(got.face.units[i].time, got.face.units[i - 1].time);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Restarts,
    testing::Values(Route{"rtp", "rtp://127.0.0.1:PORT", "DIRtalk.sdp", "got.mp4"},
                    Route{"rtp_text", "rtp://127.0.0.1:PORT", "DIRtalk.sdp", "got.fap"},
                    Route{"udp", "udp://127.0.0.1:PORT", "udp://127.0.0.1:PORT", "got.fap"},
                    Route{"web", "http://127.0.0.1:PORT", "ws://127.0.0.1:PORT", "got.mp4"}),
    [](const auto& route) { return route.param.name; });

/// Runs FFmpeg for a while, then kills it.
void run_ffmpeg(const std::string& arguments, double seconds) {
  (void)test::run("timeout -s KILL " + std::to_string(seconds) + " ffmpeg -v quiet -re -i " +
                  (test::data_dir() / "containers" / "fba_aac.mkv").string() + " " + arguments +
                  " 2>&1");
}

TEST(RestartsOfFfmpeg, AreRecordedOn) {
  if (!test::has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not there";
  for (const bool rtp : {true, false}) {
    const TempDir dir;
    const int port = test::free_ports();
    const std::string first = std::to_string(port), second = std::to_string(port + 2);
    std::string from = "udp://127.0.0.1:" + first;
    std::string arguments = "-map 0 -c copy -f mpegts udp://127.0.0.1:" + first;
    if (rtp) {
      from = dir / "talk.sdp";
      test::spill(from,
                  "v=0\nc=IN IP4 127.0.0.1\nm=video " + first +
                      " RTP/AVP 96\na=rtpmap:96 MP4V-ES/90000\n"
                      "a=fmtp:96 profile-level-id=1; config=000001B061000001B58947\nm=audio " +
                      second +
                      " RTP/AVP 97\na=rtpmap:97 MPEG4-GENERIC/48000/1\n"
                      "a=fmtp:97 profile-level-id=1;mode=AAC-hbr;sizelength=13;indexlength=3;"
                      "indexdeltalength=3; config=118856E500\n");
      arguments = "-map 0:v -c copy -f rtp rtp://127.0.0.1:" + first +
                  " -map 0:a -c copy -f rtp rtp://127.0.0.1:" + second;
    }
    Running receive({"receive", from, "-o", dir / "got.mp4", "--json", "--timeout", "3"},
                    dir / "1.out", dir / "1.err");
    ASSERT_TRUE(wait_for([&] { return !media::UdpSocket::bind("127.0.0.1", port); }));
    run_ffmpeg(arguments, 2);
    run_ffmpeg(arguments, 3);
    EXPECT_EQ(receive.wait(), 1) << "it was killed: nobody said goodbye";
    const auto json = nlohmann::json::parse(test::slurp(dir / "1.out"));
    EXPECT_EQ(json["sessions"], 2) << rtp << test::slurp(dir / "1.err");
    EXPECT_GT(json["planes_usable"].get<int>(), 60) << rtp << test::slurp(dir / "1.err");
    EXPECT_GT(json["sound_seconds"].get<double>(), 2.5) << rtp << test::slurp(dir / "1.err");
    EXPECT_NEAR(json["face_seconds"].get<double>(), 4.5, 1.5) << rtp << test::slurp(dir / "1.err");
  }
}

}  // namespace receive_restart_test
}  // namespace animeme

// Every transport, end to end, and what is said when something is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fap/text.h"
#include "tests/formats/media/live/stream_support.h"
#include "tests/support/random_clip.h"
#include "tools/formats/media/audio.h"

namespace animeme {
namespace stream_transports_test {

using test::animeme;
using test::container;
using test::Running;
using test::Streams;
using test::TempDir;
using test::wait_for;
using testing::HasSubstr;
using testing::Not;

struct Way {
  const char* name;
  std::string (*to)(const std::string& port);
  std::string (*from)(const std::string& port);
};

class Transports : public Streams, public testing::WithParamInterface<Way> {};

TEST_P(Transports, CarryEveryFrame) {
  const std::string port = std::to_string(test::free_ports());
  Running send({"stream", dir / "talk.mp4", "--loop", "--to", GetParam().to(port)}, dir / "s.out",
               dir / "s.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("sending") != std::string::npos; }));
  ASSERT_EQ(animeme({"decode", dir / "talk.mp4", "-o", dir / "talk.fap"}).exit_code, 0);
  const auto got = animeme(
      {"receive", GetParam().from(port), "-o", dir / "got.mp4", "--duration", "2", "--wait", "30"});
  send.signal(SIGINT);
  const int sent = send.wait();
  if (sent == 3) GTEST_SKIP() << test::slurp(dir / "s.err");
  EXPECT_EQ(sent, 130) << test::slurp(dir / "s.err");
  ASSERT_EQ(got.exit_code, 0) << got.err;
  ASSERT_EQ(animeme({"decode", dir / "got.mp4", "-o", dir / "got.fap"}).exit_code, 0);
  const auto source = fap::read_text(test::slurp(dir / "talk.fap"));
  const auto received = fap::read_text(test::slurp(dir / "got.fap"));
  ASSERT_TRUE(source && received);
  ASSERT_GT(received->frames.size(), 20u);
  EXPECT_TRUE(container(dir / "got.mp4").audio.has_value());
  const auto value = [&](const fap::Sequence& clip, std::size_t i) {
    return clip.frames[i % clip.frames.size()].value;
  };
  std::size_t at = 0, same = 0;
  for (; at < source->frames.size() && same < received->frames.size(); ++at) {
    for (same = 0; same < received->frames.size(); ++same) {
      if (value(*received, same) != value(*source, at + same)) break;
    }
  }
  EXPECT_EQ(same, received->frames.size());
}

std::string udp(const std::string& port) { return "udp://127.0.0.1:" + port; }

INSTANTIATE_TEST_SUITE_P(
    All, Transports,
    testing::Values(Way{"udp", udp, udp},
                    Way{"srt",
                        [](const std::string& port) {
                          return "srt://127.0.0.1:" + port + "?mode=listener";
                        },
                        [](const std::string& port) { return "srt://127.0.0.1:" + port; }},
                    Way{"web", [](const std::string& port) { return "http://127.0.0.1:" + port; },
                        [](const std::string& port) { return "ws://127.0.0.1:" + port; }}),
    [](const auto& way) { return way.param.name; });

// The number in front of "planes usable" in the last line that was told; 0: there is none.
std::size_t planes_told(const std::string& text) {
  const std::size_t end = text.rfind(" planes usable");
  if (end == std::string::npos) return 0;
  return std::stoul(text.substr(text.rfind(' ', end - 1) + 1));
}

// Killed in the middle, every kind of file has all but the last second.
TEST_F(Streams, AReceiverThatIsKilledLeavesWhatCame) {
  const std::string port = std::to_string(test::free_ports());
  Running send({"stream", dir / "talk.mp4", "--loop", "--to", "http://127.0.0.1:" + port},
               dir / "s.out", dir / "s.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("sending") != std::string::npos; }));
  const std::vector<std::string> names = {"a.mp4", "a.mkv", "a.ts", "a.fba", "a.fap"};
  std::vector<std::unique_ptr<Running>> receivers;
  for (const std::string& name : names) {
    test::spill(dir / name, "old");
    receivers.push_back(std::make_unique<Running>(
        std::vector<std::string>{"receive", "ws://127.0.0.1:" + port, "-o", dir / name, "--stats"},
        dir / (name + ".out"), dir / (name + ".err")));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    ASSERT_TRUE(wait_for([&] { return planes_told(test::slurp(dir / (names[i] + ".err"))) > 60; }));
    receivers[i]->signal(SIGKILL);
    EXPECT_EQ(receivers[i]->wait(), -1) << names[i];
    const std::size_t came = planes_told(test::slurp(dir / (names[i] + ".err")));
    const auto decoded = animeme({"decode", dir / names[i], "-o", dir / "decoded.fap"});
    ASSERT_EQ(decoded.exit_code, 0) << names[i] << ": " << decoded.err;
    const auto frames = fap::read_text(test::slurp(dir / "decoded.fap"));
    ASSERT_TRUE(frames) << names[i];
    EXPECT_GE(frames->frames.size() + 25, came) << names[i];
    const bool sound = names[i] == "a.mp4" || names[i] == "a.mkv" || names[i] == "a.ts";
    if (!sound) continue;
    EXPECT_GT(media::read_audio(dir / names[i])->duration(), 1.2) << names[i];
  }
}

TEST(Stream, WhatIsWrongIsSaidInASentence) {
  const TempDir dir;
  test::spill(dir / "clip.fap", fap::write_text(test::random_clip(1, 30)));
  const auto scheme = animeme({"stream", dir / "clip.fap", "--to", "gopher://127.0.0.1:70"});
  EXPECT_EQ(scheme.exit_code, 2);
  EXPECT_THAT(scheme.err, HasSubstr("http://host:port"));
  const auto missing = animeme({"stream", dir / "none.mp4", "--to", "rtp://127.0.0.1:5004"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.mp4"));
  const auto nothing = animeme({"stream", "--to", "rtp://127.0.0.1:5004"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("nothing to stream"));
  const auto both = animeme({"stream", dir / "clip.fap", "--text", "x", "--to", "rtp://127.0.0.1"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_EQ(animeme({"stream", dir / "clip.fap"}).exit_code, 2);
  EXPECT_EQ(animeme({"stream", "--say", "-", "--fast", "--to", "rtp://127.0.0.1:5004"}).exit_code,
            2);
}

TEST(Stream, AServerForEverybodyIsWarnedOfOnce) {
  const TempDir dir;
  test::spill(dir / "clip.fap", fap::write_text(test::random_clip(1, 10)));
  const auto served = [&](const std::string& host, std::vector<std::string> more = {}) {
    std::vector<std::string> all = {"stream", dir / "clip.fap", "--fast", "--to",
                                    "http://" + host + ":" + std::to_string(test::free_ports())};
    all.insert(all.end(), more.begin(), more.end());
    return animeme(all);
  };
  const auto open = served("0.0.0.0");
  if (open.exit_code == 3) GTEST_SKIP() << open.err;  // built without a web server
  EXPECT_EQ(open.exit_code, 0) << open.err;
  const std::size_t warning = open.err.find("open to every machine");
  ASSERT_NE(warning, std::string::npos) << open.err;
  EXPECT_THAT(open.err, HasSubstr("127.0.0.1:PORT"));
  EXPECT_EQ(open.err.find("open to every machine", warning + 1), std::string::npos);
  const auto closed = served("127.0.0.1", {"--max-clients", "3", "--max-per-address", "0",
                                           "--allow-origin", "https://a.example", "--allow-origin",
                                           "https://b.example", "--host-name", "talk.example"});
  EXPECT_EQ(closed.exit_code, 0) << closed.err;
  EXPECT_THAT(closed.err, Not(HasSubstr("open to every machine")));
  EXPECT_EQ(served("127.0.0.1", {"--max-clients", "0"}).exit_code, 2);
  const auto bad = served("127.0.0.1", {"--allow-origin", "a.example"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("https://example.org"));
}

TEST(Receive, NothingHasNoFigures) {
  const TempDir dir;
  const std::string url = "rtp://127.0.0.1:" + std::to_string(test::free_ports());
  const auto silent = animeme({"receive", url, "-o", dir / "x.mp4", "--wait", "0.3", "--json"});
  EXPECT_EQ(silent.exit_code, 3);
  EXPECT_THAT(silent.err, testing::StartsWith("waiting up to 0.3 s (--wait)"));
  EXPECT_THAT(silent.err, HasSubstr("nothing came"));
  EXPECT_THAT(silent.err, Not(HasSubstr("usable")));
  EXPECT_THAT(silent.err, Not(HasSubstr("jitter")));
  const auto report = nlohmann::json::parse(silent.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << silent.out;
  EXPECT_THAT(report["error"]["message"].get<std::string>(), HasSubstr("nothing came"));
  EXPECT_EQ(report.size(), 1u) << "figures of nothing: " << silent.out;
}

TEST(Receive, WhatIsWrongIsSaidInASentence) {
  const TempDir dir;
  EXPECT_EQ(animeme({"receive", "rtp://127.0.0.1:5004", "-o", dir / "x.wav"}).exit_code, 2);
  EXPECT_EQ(animeme({"receive", "gopher://127.0.0.1:70", "-o", dir / "x.mp4"}).exit_code, 2);
  const auto missing = animeme({"receive", dir / "none.sdp", "-o", dir / "x.mp4", "--wait", "0.3"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.sdp"));
  const auto folder = animeme({"receive", "rtp://127.0.0.1:5004", "-o", dir / "no/x.mp4"});
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_THAT(folder.err, HasSubstr("folder"));
  const std::string url = "rtp://127.0.0.1:" + std::to_string(test::free_ports());
  const auto silent = animeme({"receive", url, "-o", dir / "x.mp4", "--wait", "0.3"});
  EXPECT_EQ(silent.exit_code, 3);
  EXPECT_THAT(silent.err, HasSubstr("nothing came"));
  EXPECT_THAT(dir.files(), testing::IsEmpty());
  // A port that another receiver has.
  const test::UdpSocket other(std::stoi(url.substr(url.rfind(':') + 1)));
  const auto taken = animeme({"receive", url, "-o", dir / "x.mp4", "--wait", "0.3"});
  EXPECT_EQ(taken.exit_code, 3);
  EXPECT_THAT(taken.err, HasSubstr("in use"));
}

}  // namespace stream_transports_test
}  // namespace animeme

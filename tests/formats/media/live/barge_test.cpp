// Interrupting the program: by lines and by a control socket, seen and heard by a receiver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "codec/decode/decoder.h"
#include "tests/formats/media/live/stream_support.h"
#include "tools/formats/media/audio.h"

namespace animeme {
namespace barge_test {

using test::animeme;
using test::container;
using test::Running;
using test::Streams;
using test::wait_for;
using testing::HasSubstr;
using Json = nlohmann::json;

std::vector<Json> events_of(const std::string& text) {
  std::vector<Json> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    all.push_back(Json::parse(line, nullptr, false));
    EXPECT_FALSE(all.back().is_discarded()) << line;
  }
  return all;
}

// A program that holds a control socket.
class Caller {
 public:
  explicit Caller(const std::string& path)
      : handle_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    open = ::connect(handle_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Caller() { ::close(handle_); }
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;
  void say(const std::string& line) {
    const std::string text = line + "\n";
    EXPECT_EQ(::send(handle_, text.data(), text.size(), MSG_NOSIGNAL), ssize_t(text.size()));
  }
  // What has been told so far.
  const std::string& heard() {
    char buffer[65536];
    for (ssize_t got; (got = ::recv(handle_, buffer, sizeof buffer, MSG_DONTWAIT)) > 0;) {
      heard_.append(buffer, std::size_t(got));
    }
    return heard_;
  }
  bool hears(const std::string& part) {
    return wait_for([&] { return heard().find(part) != std::string::npos; });
  }
  bool open = false;

 private:
  int handle_;
  std::string heard_;
};

// Instant of the first event of a kind (and line), -1: there is none.
double time_of(const std::vector<Json>& events, const std::string& kind,
               const std::string& id = {}) {
  for (const Json& event : events) {
    if (event["event"] == kind && (id.empty() || event.value("id", "") == id)) return event["time"];
  }
  return -1;
}

TEST_F(Streams, AStopIsSeenAndHeardByAReceiver) {
  int pipe[2];
  ASSERT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
  const auto type = [&](const std::string& line) {
    ASSERT_EQ(::write(pipe[1], (line + "\n").data(), line.size() + 1), ssize_t(line.size() + 1));
  };
  Running send(sender({"--say", "-", "--events", dir / "events", "--json"}), dir / "s.out",
               dir / "s.err", pipe[0]);
  ::close(pipe[0]);
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running receive({"receive", dir / "talk.sdp", "-o", dir / "got.mp4"}, dir / "1.out",
                  dir / "1.err");
  // Marks are told when they are reached: the head runs, and the receiver has had its time to come.
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  type("Wow, how loud you shout all over the house, my dear old friend, without an end!");
  type("This is never said.");
  type("{\"do\": \"jump\"}");
  const auto told = [&](const std::string& part) {
    return wait_for([&] { return test::slurp(dir / "events").find(part) != std::string::npos; });
  };
  ASSERT_TRUE(told("\"word\":\"shout\""));
  type("{\"do\": \"stop\"}");
  ASSERT_TRUE(told("\"event\":\"stopped\""));
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  type("{\"do\": \"say\", \"text\": \"Yes, please.\", \"id\": \"ja\", \"when\": \"now\"}");
  ASSERT_TRUE(told("\"event\":\"done\""));
  ::close(pipe[1]);
  EXPECT_EQ(send.wait(), 0) << test::slurp(dir / "s.err");
  EXPECT_EQ(receive.wait(), 0) << test::slurp(dir / "1.err");
  EXPECT_THAT(
      test::slurp(dir / "s.err"),
      testing::AllOf(HasSubstr("line 3, \"{\"do\": \"jump\"}\""), HasSubstr("say, stop, drop")));

  const auto events = events_of(test::slurp(dir / "events"));
  std::map<int, std::string> ends;
  double last = 0;
  for (const Json& event : events) {
    EXPECT_GE(event["time"].get<double>(), last) << event;
    last = event["time"];
    if (!event.contains("line")) continue;
    const std::string kind = event["event"];
    if (kind == "done" || kind == "cancelled") ends[event["line"]] += kind;
  }
  EXPECT_THAT(ends, testing::ElementsAre(testing::Pair(1, "cancelled"),
                                         testing::Pair(2, "cancelled"), testing::Pair(5, "done")));

  // By what was received: times of the file begin somewhere, so the line that follows is where they
  // are compared. The sound falls silent and the mouth shuts soon after the instant of the stop.
  const double stopped = time_of(events, "stopped"), yes = time_of(events, "word", "ja");
  const auto sound = media::read_audio(dir / "got.mp4", {.sample_rate = 16000});
  ASSERT_TRUE(sound);
  const auto loud = [&](double from, double to) {
    for (auto i = std::size_t(std::max(0.0, from) * 16000); i < std::size_t(to * 16000); ++i) {
      if (i < sound->samples.size() && std::abs(sound->samples[i]) > 0.02F) return true;
    }
    return false;
  };
  // The first sound behind a silence of half a second from the end backwards is that of "Yes".
  double begin = sound->duration();
  while (begin > 0 && !loud(begin - 0.01, begin)) begin -= 0.01;
  while (begin > 0.5 && loud(begin - 0.5, begin)) begin -= 0.01;
  const double offset = begin - yes;  // of the file against the presentation
  double silent = begin - 0.4;
  while (silent > 0 && !loud(silent - 0.005, silent)) silent -= 0.005;
  EXPECT_GT(silent - offset - stopped, 0.0);
  EXPECT_LT(silent - offset - stopped, 0.15);
  const fba::AccessUnits units = container(dir / "got.mp4").face;
  const auto decoded = fba::decode(fba::join_access_units(units));
  ASSERT_TRUE(decoded);
  const fap::Sequence face = fba::face_sequence(*decoded);
  const auto opening = [&](double time) {
    std::size_t i = 0;  // the face may begin later than the sound
    while (i + 1 < face.frames.size() &&
           double(units.units[i + 1].time) / units.timescale <= time + offset) {
      ++i;
    }
    return -(face.frames[i].value[4] + face.frames[i].value[5]);
  };
  int before = 0;
  for (double time = stopped - 0.5; time < stopped; time += 0.04)
    before = std::max(before, opening(time));
  EXPECT_GT(before, 60);
  for (double time = stopped + 0.2; time < yes - 0.15; time += 0.04) {
    EXPECT_LT(std::abs(opening(time) - opening(yes - 0.2)), 8) << time - stopped;
  }
  const Json summary = Json::parse(test::slurp(dir / "s.out"), nullptr, false);
  EXPECT_EQ(summary["lines"], 2);
  EXPECT_EQ(
      summary["text_to_face"]["lines"].get<int>() + summary["waited_to_face"]["lines"].get<int>(),
      2);
}

TEST_F(Streams, AControlSocketHasLinesCommandsAndEvents) {
  const std::string path = dir / "head.sock";
  Running send({"stream", "--control", path, "--to", "udp://127.0.0.1:9", "--events", "-"},
               dir / "s.out", dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return Caller(path).open; }));
  struct stat mode {};
  ASSERT_EQ(::stat(path.c_str(), &mode), 0);
  EXPECT_EQ(mode.st_mode & 0777U, 0600U);
  Caller one(path), two(path);
  ASSERT_TRUE(one.open && two.open);
  one.say("{\"do\":\"say\",\"id\":\"größe\",\"text\":\"Good morning, how are you?\"}");
  one.say("A line that waits.");
  one.say("{\"do\":\"nothing\"}");
  ASSERT_TRUE(one.hears("\"word\":\"morning,\""));
  ASSERT_TRUE(two.hears("\"word\":\"morning,\""));
  two.say("{\"do\":\"stop\"}");
  ASSERT_TRUE(one.hears("\"event\":\"cancelled\""));
  EXPECT_THAT(one.heard(), HasSubstr("\"event\":\"error\""));
  EXPECT_THAT(two.heard(), testing::Not(HasSubstr("\"event\":\"error\"")));
  EXPECT_TRUE(one.hears("\"id\":\"größe\",\"said\":\"Good morning,\""));
  // Another program that wants the same place is refused, and takes nothing away.
  const auto second = animeme({"stream", "--control", path, "--to", "udp://127.0.0.1:9"});
  EXPECT_NE(second.exit_code, 0);
  EXPECT_THAT(second.err, HasSubstr("another program listens there"));
  two.say("{\"do\":\"mark\",\"id\":\"here\"}");
  ASSERT_TRUE(one.hears("\"mark\":\"here\""));
  two.say("{\"do\":\"end\"}");
  EXPECT_EQ(send.wait(), 0) << test::slurp(dir / "s.err");
  EXPECT_FALSE(std::filesystem::exists(path));
  const auto events = events_of(test::slurp(dir / "s.out"));
  EXPECT_GT(events.size(), 8u);
}

TEST_F(Streams, AStaleControlSocketIsReplacedAndAnotherFileIsNot) {
  const std::string path = dir / "head.sock";
  {
    Running send({"stream", "--control", path, "--to", "udp://127.0.0.1:9"}, dir / "s.out",
                 dir / "s.err");
    ASSERT_TRUE(wait_for([&] { return Caller(path).open; }));
    send.signal(SIGKILL);
    (void)send.wait();
  }
  EXPECT_TRUE(std::filesystem::exists(path));
  Running again({"stream", "--control", path, "--to", "udp://127.0.0.1:9", "--duration", "1"},
                dir / "s.out", dir / "s.err");
  EXPECT_EQ(again.wait(), 0) << test::slurp(dir / "s.err");
  std::ofstream(dir / "file") << "mine";
  const auto refused = animeme({"stream", "--control", dir / "file", "--to", "udp://127.0.0.1:9"});
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_THAT(refused.err, HasSubstr("another kind"));
  EXPECT_EQ(test::slurp(dir / "file"), "mine");
}

TEST_F(Streams, EventsGoWhereNothingElseGoes) {
  const auto both = animeme(
      {"stream", "--say", "-", "--events", "-", "--json", "--to", "udp://127.0.0.1:9"}, "x\n");
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.err, HasSubstr("standard output"));
  const auto clip =
      animeme({"stream", dir / "talk.mp4", "--events", "-", "--to", "udp://127.0.0.1:9"});
  EXPECT_EQ(clip.exit_code, 2);
}

TEST_F(Streams, CtrlCEndsEveryLine) {
  int pipe[2];
  ASSERT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
  Running send({"stream", "--say", "-", "--events", "-", "--to", "udp://127.0.0.1:9"},
               dir / "s.out", dir / "s.err", pipe[0]);
  ::close(pipe[0]);
  const std::string lines = "Good morning, my friend.\nOne.\nTwo.\n{\"do\":\"mark\"}\nThree.\n";
  ASSERT_GT(::write(pipe[1], lines.data(), lines.size()), 0);
  ASSERT_TRUE(wait_for([&] {
    return test::slurp(dir / "s.out").find("\"event\":\"started\"") != std::string::npos;
  }));
  send.signal(SIGINT);
  EXPECT_EQ(send.wait(), 130) << test::slurp(dir / "s.err");
  ::close(pipe[1]);
  std::map<std::string, int> counts;
  for (const Json& event : events_of(test::slurp(dir / "s.out"))) {
    if (event.contains("line")) ++counts[event["event"]];
  }
  EXPECT_EQ(counts["queued"], 4);
  EXPECT_EQ(counts["done"] + counts["cancelled"], 4);
}

}  // namespace barge_test
}  // namespace animeme

// The program over sockets of this machine, to readers of others and to itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "fap/tables.h"
#include "fap/text.h"
#include "tests/formats/media/live/stream_support.h"
#include "tests/live/engines/engines_support.h"
#include "tests/support/folders.h"

namespace animeme {
namespace engine_programs_test {

using test::animeme;
using test::Json;
using test::run_command;
using test::Running;
using test::slurp;
using test::wait_for;
using testing::HasSubstr;

/// A talking face of about two seconds, and what export makes of it.
class EnginePrograms : public testing::Test {
 protected:
  void SetUp() override {
    const auto made = animeme({"speak", "--text", "Hello my old friend, how are you?",
                               "--idle-motion", "--intra-seconds", "0.4", "-o", talk});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    ASSERT_EQ(animeme({"export", talk, "-o", dir / "talk.json"}).exit_code, 0);
    exported = Json::parse(slurp(dir / "talk.json"));
  }
  // The weights of a frame, by ARKit's name.
  double weight(std::size_t frame, const std::string& name) const {
    const auto& names = exported["names"];
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    return exported["frames"][frame][std::size_t(at)];
  }

  test::TempDir dir;
  std::string talk = dir / "talk.mp4";
  Json exported;
};

/// A program of others that says what it hears, till it is ended.
class Listener {
 public:
  Listener(const std::string& command, const std::string& out) : out_(out), pid_(::fork()) {
    if (pid_ != 0) return;
    ::setpgid(0, 0);
    ::execl("/bin/sh", "sh", "-c", ("exec " + command + " >" + out + " 2>&1").c_str(), nullptr);
    ::_exit(127);
  }
  ~Listener() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  std::string heard() const { return slurp(out_); }

 private:
  std::string out_;
  pid_t pid_;
};

std::vector<Json> lines_of(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  return lines;
}

TEST_F(EnginePrograms, SeveralEnginesAtATimeGetTheFaceThatExportWrites) {
  if (!test::has_program("python3")) GTEST_SKIP() << "python3 is not installed";
  const std::string script = std::string(test::kSourceFolder) + "/tests/live/engines/reader.py";
  std::vector<std::unique_ptr<Listener>> readers;
  std::vector<std::string> to = {"stream", talk};
  for (const std::string protocol : {"livelink", "vmc", "osc"}) {
    const std::string out = dir / protocol;
    readers.push_back(std::make_unique<Listener>(
        "python3 -u " + script + " " + protocol + " --port 0 --seconds 100", out));
    ASSERT_TRUE(wait_for([&] { return slurp(out).find("\n") != std::string::npos; }));
    const int port = Json::parse(slurp(out).substr(0, slurp(out).find('\n')))["port"];
    to.insert(to.end(), {"--to", protocol + "://127.0.0.1:" + std::to_string(port)});
  }
  to[3] += "?rate=60";
  const auto sent = animeme(to);
  ASSERT_EQ(sent.exit_code, 0) << sent.err;
  ASSERT_TRUE(
      wait_for([&] { return readers[1]->heard().find("\"end\"") != std::string::npos; }, 10));

  const std::size_t planes = exported["frames"].size();
  auto link = lines_of(readers[0]->heard());
  ASSERT_NEAR(double(link.size() - 1), double(planes) / 25 * 60, 2);
  for (std::size_t i = 1; i < link.size(); ++i) {
    EXPECT_NEAR(double(link[i]["time"]), double(i - 1) / 60, 1e-5);
    if ((i - 1) % 12 != 0) continue;  // every fifth plane
    EXPECT_NEAR(double(link[i]["values"]["JawOpen"]), weight((i - 1) / 12 * 5, "jawOpen"), 2e-6);
    EXPECT_NEAR(double(link[i]["values"]["HeadYaw"]), weight((i - 1) / 12 * 5, "headYaw"), 2e-6);
  }
  auto vmc = lines_of(readers[1]->heard());
  ASSERT_EQ(vmc.size() - 2, planes);
  double last = 0;
  for (std::size_t i = 1; i + 1 < vmc.size(); ++i) {
    EXPECT_NEAR(double(vmc[i]["values"]["JawOpen"]), weight(i - 1, "jawOpen"), 2e-6);
    EXPECT_GE(double(vmc[i]["at"]), last);
    last = vmc[i]["at"];
  }
  // Spread over the time that they take: none of it in a heap at the end.
  EXPECT_GT(last - double(vmc[1]["at"]), 0.7 * double(planes) / 25);
  EXPECT_GT(lines_of(readers[2]->heard()).size(), planes / 2);
}

TEST_F(EnginePrograms, LibloReadsEveryMessage) {
  if (!test::has_program("oscdump")) GTEST_SKIP() << "oscdump (liblo-tools) is not installed";
  for (const std::string scheme : {"vmc", "osc"}) {
    const std::string port = std::to_string(test::free_udp_port());
    const Listener dump("stdbuf -oL oscdump -L " + port, dir / "dump");
    std::string heard;
    ASSERT_TRUE(wait_for([&] {  // sent again until it listens
      EXPECT_EQ(animeme({"stream", talk, "--to", scheme + "://127.0.0.1:" + port, "--fast",
                         "--duration", "0.4"})
                    .exit_code,
                0);
      heard = dump.heard();
      return heard.find(scheme == "vmc" ? "/VMC/Ext/OK i 0" : "LeftRightPitchYaw ffff") !=
             std::string::npos;
    }));
    if (scheme == "vmc") {
      EXPECT_THAT(heard, HasSubstr("/VMC/Ext/OK iii 1 3 0"));
      EXPECT_THAT(heard, HasSubstr("/VMC/Ext/Blend/Val sf \"JawOpen\" "));
      EXPECT_THAT(heard, HasSubstr("/VMC/Ext/Bone/Pos sfffffff \"Head\" 0.000000 "));
      EXPECT_THAT(heard, HasSubstr("/VMC/Ext/Blend/Apply"));
    } else {
      EXPECT_THAT(heard, HasSubstr("/avatar/parameters/v2/JawOpen f "));
    }
  }
}

TEST_F(EnginePrograms, OscOfNpmReadsEveryMessage) {
  const std::string folder = std::string(test::kSourceFolder) + "/tests/readers/js";
  if (!test::has_program("node") || !std::filesystem::exists(folder + "/node_modules/osc-min")) {
    GTEST_SKIP() << "npm's osc-min is not installed (tools/setup.sh full)";
  }
  const auto face = test::moving_face(1);
  const auto fit = test::fit_of(face);
  std::string hex;
  for (const test::Sent& each : test::sent_to("vmc://192.0.2.1", face)) {
    for (const std::uint8_t byte : each.bytes) {
      hex += "0123456789abcdef"[byte >> 4];
      hex += "0123456789abcdef"[byte & 15];
    }
    hex += '\n';
  }
  const auto read = run_command({"node", folder + "/osc_report.js"}, hex);
  ASSERT_EQ(read.exit_code, 0) << read.err;
  std::size_t frame = 0;
  for (const Json& message : lines_of(read.out)) {
    if (message["address"] == "/VMC/Ext/Blend/Apply") ++frame;
    if (message["address"] != "/VMC/Ext/Blend/Val" || message["args"][0] != "JawOpen") continue;
    ASSERT_LT(frame, fit.size());
    EXPECT_NEAR(double(message["args"][1]), fit[frame][17], 2e-6);
  }
  EXPECT_EQ(frame, 25u);
}

TEST_F(EnginePrograms, WhatIsStreamedIsReceived) {
  const auto source = animeme({"decode", talk, "--coded", "-o", dir / "talk.fap"});
  for (const std::string scheme : {"livelink", "vmc", "osc"}) {
    const std::string address = scheme + "://127.0.0.1:" + std::to_string(test::free_udp_port());
    // Without times of the sender the rate is what a busy machine lets it be.
    const std::string here = address + (scheme == "osc" ? "?rate=25" : "");
    // A phone has no goodbye, so that so much of it is asked for.
    Running text({"receive", here, "-o", "-", "--duration", "1.5"}, dir / "got.fap", dir / "1.err");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    Running send({"stream", talk, "--to", address, "--loop"}, dir / "s.out", dir / "s.err");
    EXPECT_EQ(text.wait(), 0) << slurp(dir / "1.err");
    Running film({"receive", here, "-o", dir / "got.mp4", "--duration", "1", "--json"},
                 dir / "2.out", dir / "2.err");
    EXPECT_EQ(film.wait(), 0) << slurp(dir / "2.err");
    Running stream({"receive", here, "-o", dir / "got.fba", "--duration", "1"}, dir / "3.out",
                   dir / "3.err");
    EXPECT_EQ(stream.wait(), 0) << slurp(dir / "3.err");
    send.signal(SIGINT);
    EXPECT_EQ(send.wait(), 130);
    const auto got = fap::read_text(slurp(dir / "got.fap"));
    ASSERT_TRUE(got);
    EXPECT_EQ(got->rate, (fap::Rate{25, 1})) << scheme;
    EXPECT_GE(got->frames.size(), 35u);
    EXPECT_EQ(test::container(dir / "got.mp4").face.units.front().duration * 25,
              test::container(dir / "got.mp4").face.timescale);
    EXPECT_EQ(animeme({"info", dir / "got.fba"}).exit_code, 0);
  }
}

// A phone that streams and one that records are the same: what import makes of the table that Live
// Link Face writes is what is received.
TEST_F(EnginePrograms, WhatIsReceivedIsWhatImportMakesOfTheRecording) {
  ASSERT_EQ(animeme({"export", talk, "-o", dir / "take.csv"}).exit_code, 0);
  const auto imported = animeme({"import", dir / "take.csv", "-o", dir / "take.fap"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  const std::string address = "livelink://127.0.0.1:" + std::to_string(test::free_udp_port());
  Running receive({"receive", address, "-o", dir / "got.fap", "--duration", "2"}, dir / "1.out",
                  dir / "1.err");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  Running phone({"stream", talk, "--to", address}, dir / "s.out", dir / "s.err");
  ASSERT_EQ(receive.wait(), 0) << slurp(dir / "1.err");
  EXPECT_EQ(phone.wait(), 0);
  const auto want = fap::read_text(slurp(dir / "take.fap"));
  const auto got = fap::read_text(slurp(dir / "got.fap"));
  ASSERT_TRUE(want && got);
  ASSERT_GE(got->frames.size(), 45u);
  // Where it began to listen.
  const auto differs = [&](std::size_t at, std::size_t i) {
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const int off =
          got->frames[i].value[std::size_t(fap)] - want->frames[at + i].value[std::size_t(fap)];
      if (std::abs(off) > fap::info(fap).quant_step / 2 + 1) return true;
    }
    return false;
  };
  std::size_t at = 0;
  while (at < 10 && (differs(at, 5) || differs(at, 25))) ++at;
  ASSERT_LT(at, 10u);
  for (std::size_t i = 0; i < got->frames.size(); ++i) {
    EXPECT_FALSE(differs(at, i)) << i;
    EXPECT_EQ(got->frames[i].mask, want->frames[at + i].mask) << i;
  }
}

// From a phone to another engine and to a file, live; and the file, once more.
TEST_F(EnginePrograms, WhatIsReceivedCanBeSentOn) {
  const auto port = [] { return std::to_string(test::free_udp_port()); };
  const std::string in = "livelink://127.0.0.1:" + port();
  const std::string out = "vmc://127.0.0.1:" + port();
  Running engine({"receive", out, "-o", dir / "engine.fba", "--wait", "30"}, dir / "0.out",
                 dir / "0.err");
  Running relay(
      {"receive", in, "-o", dir / "phone.fba", "--to", out + "?rate=50", "--duration", "1.5"},
      dir / "1.out", dir / "1.err");
  Running alone({"receive", in + "0", "--to", out, "--wait", "0.1"}, dir / "2.out", dir / "2.err");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  Running phone({"stream", talk, "--to", in, "--loop"}, dir / "s.out", dir / "s.err");
  ASSERT_EQ(relay.wait(), 0) << slurp(dir / "1.err");
  EXPECT_EQ(engine.wait(), 0) << slurp(dir / "0.err");  // VMC tells the end
  phone.signal(SIGINT);
  phone.wait();
  EXPECT_NE(alone.wait(), 0);
  const auto planes = [&](const std::string& file) {
    const auto info = animeme({"info", file, "--json"});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    return info.out;
  };
  EXPECT_THAT(planes(dir / "phone.fba"), HasSubstr("\"rate\": \"25\""));
  EXPECT_THAT(planes(dir / "engine.fba"), HasSubstr("\"rate\": \"50\""));
  const auto on = animeme(
      {"stream", dir / "phone.fba", "--to", "vmc://127.0.0.1:9?rate=60", "--fast", "--json"});
  ASSERT_EQ(on.exit_code, 0) << on.err;
  EXPECT_GT(int(Json::parse(on.out)["addresses"][0]["packets"]), 80);
  EXPECT_EQ(animeme({"receive", in}).exit_code, 2);
}

TEST_F(EnginePrograms, SpokenLinesGoToEnginesAsWell) {
  const std::string address = "vmc://127.0.0.1:" + std::to_string(test::free_udp_port());
  Running receive({"receive", address, "-o", dir / "got.fap", "--wait", "30"}, dir / "1.out",
                  dir / "1.err");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto sent = animeme({"stream", "--say", "-", "--to", address}, "Good morning.\n");
  EXPECT_EQ(sent.exit_code, 0) << sent.err;
  EXPECT_EQ(receive.wait(), 0) << slurp(dir / "1.err");  // VMC has a goodbye
  const auto got = fap::read_text(slurp(dir / "got.fap"));
  ASSERT_TRUE(got);
  int widest = 0;
  for (const fap::Frame& frame : got->frames) widest = std::max(widest, frame.value[3]);
  EXPECT_GT(widest, 100);
}

TEST_F(EnginePrograms, WrongAddressesAreUsage) {
  const auto wrong = animeme({"stream", talk, "--to", "livelink://h:1?name=x"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("subject=NAME"));
  EXPECT_EQ(animeme({"receive", "vmc://:1?names=arkit", "-o", dir / "x.fap"}).exit_code, 2);
  const auto none =
      animeme({"receive", "livelink://127.0.0.1:" + std::to_string(test::free_udp_port()), "-o",
               dir / "x.fap", "--wait", "0.3"});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_THAT(none.err, HasSubstr("nothing came"));
}

}  // namespace engine_programs_test
}  // namespace animeme

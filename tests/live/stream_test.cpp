// Streaming through the program: one sends, the other receives, over the loopback interface.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <thread>

#include "codec/access_unit.h"
#include "codec/decoder.h"
#include "codec/encode.h"
#include "fap/text.h"
#include "tests/support/program.h"
#include "tests/support/random_clip.h"
#include "tools/media/audio.h"
#include "tools/media/container.h"

namespace animeme {
namespace {

using test::animeme;
using test::TempDir;
using testing::HasSubstr;

// Two neighbouring pairs of UDP ports that nobody uses now.
std::string free_port() {
  for (int port = 20000 + (::getpid() * 16) % 20000; port < 60000; port += 8) {
    bool free = true;
    for (int i = 0; i < 4; ++i) {
      const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(std::uint16_t(port + i));
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      free = free && ::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
      ::close(fd);
    }
    if (free) return std::to_string(port);
  }
  return "5004";
}

// The program running beside the test; ended with it.
class Running {
 public:
  Running(std::vector<std::string> arguments, const std::string& out, const std::string& err,
          int input = -1) {
    arguments.insert(arguments.begin(), std::string(ANIMEME_BINARY_DIR) + "/bin/animeme");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    if (input >= 0) ::dup2(input, STDIN_FILENO);
    ::dup2(::open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (!code_) ::kill(pid_, SIGKILL);
    (void)wait();
  }
  void signal(int number) const { ::kill(pid_, number); }
  int wait() {
    if (code_) return *code_;
    int status = 0;
    ::waitpid(pid_, &status, 0);
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return *code_;
  }

 private:
  pid_t pid_;
  std::optional<int> code_;
};

template <class Condition>
bool wait_for(Condition condition, int seconds = 60) {
  for (int i = 0; i < seconds * 50; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

// A talking face of about two seconds with its sound.
class Streams : public testing::Test {
 protected:
  void SetUp() override {
    const auto made = animeme({"speak", "--text", "Hello my old friend, how are you?",
                               "--intra-seconds", "0.4", "-o", dir / "talk.mp4"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    url = "rtp://127.0.0.1:" + free_port();
  }
  // Writes the session description as the sender will: a first run without a receiver.
  std::vector<std::string> sender(std::vector<std::string> more) const {
    std::vector<std::string> all = {"stream", "--to", url, "--sdp", dir / "talk.sdp"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  bool described() const { return std::filesystem::exists(dir / "talk.sdp"); }

  TempDir dir;
  std::string url;
};

media::Container container(const std::string& path) {
  auto read = media::read_container(path);
  EXPECT_TRUE(read) << read.error().describe();
  return read ? std::move(*read) : media::Container{};
}

TEST_F(Streams, WhatIsReceivedIsTheSourceByteForByte) {
  // Repeated, so that the receivers, who begin a little later, see all of the second round.
  Running send(sender({dir / "talk.mp4", "--loop", "--stats", "--json"}), dir / "s.out",
               dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running mp4({"receive", dir / "talk.sdp", "-o", dir / "got.mp4", "--json"}, dir / "1.out",
              dir / "1.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("\n6 s") != std::string::npos; }));
  send.signal(SIGINT);
  EXPECT_EQ(send.wait(), 130) << test::slurp(dir / "s.err");
  EXPECT_EQ(mp4.wait(), 0) << test::slurp(dir / "1.err");

  const media::Container source = container(dir / "talk.mp4"), got = container(dir / "got.mp4");
  ASSERT_GT(got.face.units.size(), source.face.units.size());
  EXPECT_EQ(got.face.timescale, source.face.timescale);
  EXPECT_EQ(got.face.config, source.face.config);
  // Where the first plane that was received lies in the source, and from there on plane by plane.
  const auto same = [&](std::size_t at, std::size_t i) {
    const auto& want = source.face.units[(at + i) % source.face.units.size()].bytes;
    const auto& have = got.face.units[i].bytes;
    const std::size_t tail = std::min(want.size(), have.size()) - 5;
    return std::equal(want.end() - std::ptrdiff_t(tail), want.end(),
                      have.end() - std::ptrdiff_t(tail));
  };
  std::size_t at = 0;
  while (at < source.face.units.size() && !(same(at, 0) && same(at, 1) && same(at, 2))) ++at;
  ASSERT_LT(at, source.face.units.size());
  for (std::size_t i = 0; i < got.face.units.size(); ++i) ASSERT_TRUE(same(at, i)) << i;
  // The sound is all there and was not coded again.
  const auto sound = media::read_encoded_audio(dir / "talk.mp4");
  const auto heard = media::read_encoded_audio(dir / "got.mp4");
  ASSERT_TRUE(sound && heard);
  EXPECT_EQ(sound->format.config, heard->format.config);
  std::size_t known = 0;
  for (const media::AudioPacket& packet : heard->packets) {
    known += std::any_of(sound->packets.begin(), sound->packets.end(),
                         [&](const media::AudioPacket& p) { return p.bytes == packet.bytes; });
  }
  EXPECT_EQ(known, heard->packets.size());
  EXPECT_THAT(test::slurp(dir / "1.out"), HasSubstr("\"interval_share_least\": 1.0"));
  EXPECT_THAT(test::slurp(dir / "s.out"), HasSubstr("\"late_99_ms\""));
}

TEST_F(Streams, TextAndStreamHaveTheFapsOfTheSource) {
  ASSERT_EQ(animeme({"demux", dir / "talk.mp4", "--face", dir / "talk.fba"}).exit_code, 0);
  ASSERT_EQ(animeme({"decode", dir / "talk.fba", "-o", dir / "talk.fap"}).exit_code, 0);
  Running send(sender({dir / "talk.fba", "--loop", "--stats"}), dir / "s.out", dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running text({"receive", dir / "talk.sdp", "-o", "-", "--duration", "5"}, dir / "got.fap",
               dir / "1.err");
  EXPECT_EQ(text.wait(), 0) << test::slurp(dir / "1.err");
  Running stream({"receive", dir / "talk.sdp", "-o", dir / "got.fba", "--duration", "3"},
                 dir / "2.out", dir / "2.err");
  EXPECT_EQ(stream.wait(), 0) << test::slurp(dir / "2.err");
  send.signal(SIGTERM);
  EXPECT_EQ(send.wait(), 130);

  const auto source = fap::read_text(test::slurp(dir / "talk.fap"));
  const auto printed = fap::read_text(test::slurp(dir / "got.fap"));
  ASSERT_TRUE(source && printed);
  ASSERT_GT(printed->frames.size(), 100u);
  std::size_t at = 0;
  while (at < source->frames.size() &&
         !(source->frames[at].value == printed->frames[0].value &&
           source->frames[at + 1].value == printed->frames[1].value)) {
    ++at;
  }
  for (std::size_t i = 0; i < printed->frames.size(); ++i) {
    const fap::Frame& want = source->frames[(at + i) % source->frames.size()];
    ASSERT_EQ(printed->frames[i].value, want.value) << i;
    ASSERT_EQ(printed->frames[i].mask, want.mask) << i;
  }
  const std::string bytes = test::slurp(dir / "got.fba");
  const auto decoded =
      fba::decode({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_GT(decoded->planes.size(), 70u);
}

TEST_F(Streams, LinesFromStandardInputAreSpokenAsTheyCome) {
  int pipe[2];
  ASSERT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
  Running send(sender({"--say", "-", "--life", "--stats", "--json"}), dir / "s.out", dir / "s.err",
               pipe[0]);
  ::close(pipe[0]);
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running receive({"receive", dir / "talk.sdp", "-o", dir / "got.mp4"}, dir / "1.out",
                  dir / "1.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("\n1 s") != std::string::npos; }));
  ASSERT_GT(::write(pipe[1], "Good morning.\n", 14), 0);
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "s.err").find("\n3 s") != std::string::npos; }));
  ASSERT_GT(::write(pipe[1], "Bye.", 4), 0);  // the end of the input ends the line
  ::close(pipe[1]);
  EXPECT_EQ(send.wait(), 0) << test::slurp(dir / "s.err");
  EXPECT_EQ(receive.wait(), 0) << test::slurp(dir / "1.err");
  EXPECT_THAT(test::slurp(dir / "s.out"), HasSubstr("\"lines\": 2"));
  const auto sound = media::read_audio(dir / "got.mp4", {.sample_rate = 16000});
  ASSERT_TRUE(sound);
  // Silence, a line, silence, a line: two stretches with sound.
  int stretches = 0, quiet = 16000;
  for (const float sample : sound->samples) {
    const bool loud = std::abs(sample) > 0.05F;
    stretches += loud && quiet > 8000;
    quiet = loud ? 0 : quiet + 1;
  }
  EXPECT_EQ(stretches, 2);
  EXPECT_GT(container(dir / "got.mp4").face.units.size(), 60u);
}

TEST_F(Streams, CtrlCLeavesAReadableFile) {
  Running send(sender({dir / "talk.mp4", "--loop"}), dir / "s.out", dir / "s.err");
  ASSERT_TRUE(wait_for([&] { return described(); }));
  Running receive({"receive", dir / "talk.sdp", "-o", dir / "got.mp4", "--stats"}, dir / "1.out",
                  dir / "1.err");
  ASSERT_TRUE(
      wait_for([&] { return test::slurp(dir / "1.err").find("1 s: ") != std::string::npos; }));
  receive.signal(SIGINT);
  EXPECT_EQ(receive.wait(), 130) << test::slurp(dir / "1.err");
  EXPECT_GT(container(dir / "got.mp4").face.units.size(), 10u);
  EXPECT_THAT(test::slurp(dir / "1.err"), HasSubstr("intra intervals"));
}

TEST_F(Streams, DurationEndsBothAndFastDoesNotWait) {
  const auto fast = animeme(
      sender({dir / "talk.mp4", "--fast", "--loop", "--duration", "20", "--json", "--no-sound"}));
  EXPECT_EQ(fast.exit_code, 0) << fast.err;
  EXPECT_THAT(fast.out, HasSubstr("\"sound\": {\n    \"units\": 0"));
}

TEST(Stream, WhatIsWrongIsSaidInASentence) {
  const TempDir dir;
  test::spill(dir / "clip.fap", fap::write_text(test::random_clip(1, 30)));
  const auto scheme = animeme({"stream", dir / "clip.fap", "--to", "gopher://127.0.0.1:70"});
  EXPECT_EQ(scheme.exit_code, 2);
  EXPECT_THAT(scheme.err, HasSubstr("rtp://host:port"));
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

TEST(Receive, WhatIsWrongIsSaidInASentence) {
  const TempDir dir;
  EXPECT_EQ(animeme({"receive", "rtp://127.0.0.1:5004", "-o", dir / "x.wav"}).exit_code, 2);
  EXPECT_EQ(animeme({"receive", "gopher://127.0.0.1:70", "-o", dir / "x.mp4"}).exit_code, 2);
  const auto missing = animeme({"receive", dir / "none.sdp", "-o", dir / "x.mp4"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.sdp"));
  const std::string url = "rtp://127.0.0.1:" + free_port();
  const auto silent = animeme({"receive", url, "-o", dir / "x.mp4", "--wait", "0.3"});
  EXPECT_EQ(silent.exit_code, 3);
  EXPECT_THAT(silent.err, HasSubstr("nothing came"));
  EXPECT_THAT(dir.files(), testing::IsEmpty());
  // A port that another receiver has.
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(std::stoi(url.substr(url.rfind(':') + 1))));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const auto taken = animeme({"receive", url, "-o", dir / "x.mp4", "--wait", "0.3"});
  ::close(fd);
  EXPECT_EQ(taken.exit_code, 3);
  EXPECT_THAT(taken.err, HasSubstr("in use"));
}

}  // namespace
}  // namespace animeme

// The program as the client of a server that lies, and one that comes and goes.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tests/formats/media/live/stream_support.h"
#include "tests/support/live_reference.h"
#include "tools/live/web/web.h"

namespace animeme::test {
namespace web_hostile_test {

using media::LiveTrack;
using media::LiveUnit;

// Two hundred messages, an hour from each to the next, each said to last for a day.
TEST(WebHostile, TimesThatMessagesClaimCostNothing) {
  for (const std::string name : {"got.fap", "got.mp4", "got.ts"}) {
    Presentation show = live_presentation(200, 2);
    add_sound(show, aac_format());
    auto sink = web::make_web_sink("http://127.0.0.1:0/");
    ASSERT_TRUE(sink);
    ASSERT_TRUE((*sink)->start(show.info));
    const TempDir dir;
    Running receive({"receive", (*sink)->address(), "-o", dir / name, "--fill", "--timeout", "1",
                     "--wait", "3"},
                    dir / "out", dir / "err");
    const auto heard = [&] { return (*sink)->stats().receivers > 0; };
    ASSERT_TRUE(wait_for(heard)) << slurp(dir / "err");
    std::int64_t number[2] = {0, 0};
    for (LiveUnit unit : show.units) {
      const bool face = unit.track == LiveTrack::face;
      const std::int64_t rate = face ? show.info.timescale : show.info.audio->sample_rate;
      unit.time = 3600 * rate * number[std::size_t(unit.track)]++;
      unit.duration = std::int64_t(86400) * 25000;
      ASSERT_TRUE((*sink)->send(unit));
    }
    ASSERT_TRUE((*sink)->finish());
    receive.wait();
    EXPECT_LT(receive.peak_mb(), kMostMegabytes) << name;
    EXPECT_LT(size_of(dir / name), 1000000u) << name << slurp(dir / "err");
  }
}

// A socket that listens on this machine.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    if (::bind(socket_, any, size) == 0 && ::listen(socket_, 4) == 0) {
      ::getsockname(socket_, any, &size);
      port = ntohs(address.sin_port);
    }
  }
  ~Listener() { ::close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  // A connection, if one comes in time.
  bool is_called(int milliseconds) const {
    pollfd waiting{socket_, POLLIN, 0};
    return ::poll(&waiting, 1, milliseconds) > 0;
  }
  int accept() const { return ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC); }

  int port = 0;

 private:
  int socket_;
};

// A server sends its clients nowhere else: the machine behind it may be reachable from here alone.
TEST(WebHostile, RedirectsAreNotFollowed) {
  const Listener server, other;
  ASSERT_NE(server.port, 0);
  ASSERT_NE(other.port, 0);
  for (const char* path : {"/face", "/other"}) {
    const TempDir dir;
    Running receive({"receive", "ws://127.0.0.1:" + std::to_string(server.port) + "/", "-o",
                     dir / "got.fap", "--wait", "2", "--timeout", "1"},
                    dir / "out", dir / "err");
    ASSERT_TRUE(server.is_called(10000)) << slurp(dir / "err");
    const int client = server.accept();
    char request[4096];
    ASSERT_GT(::recv(client, request, sizeof request, 0), 0);
    const std::string answer =
        "HTTP/1.1 302 Found\r\nLocation: http://127.0.0.1:" + std::to_string(other.port) + path +
        "\r\nContent-Length: 0\r\n\r\n";
    ASSERT_EQ(::send(client, answer.data(), answer.size(), MSG_NOSIGNAL), ssize_t(answer.size()));
    EXPECT_FALSE(other.is_called(1000)) << path;
    ::close(client);
    while (server.is_called(0)) ::close(server.accept());
    EXPECT_NE(receive.wait(), 0);
  }
}

// It is there first, sees the server break off and come back at the same port.
TEST(WebHostile, AServerThatComesBackIsHeardAgain) {
  const Presentation show = live_presentation(50, 10);
  std::string address;
  {
    auto first = web::make_web_sink("http://127.0.0.1:0/");
    ASSERT_TRUE((*first)->start(show.info));
    address = (*first)->address();
  }
  const TempDir dir;
  Running receive({"receive", address, "-o", dir / "got.mp4", "--json", "--wait", "30"},
                  dir / "out", dir / "err");
  ASSERT_TRUE(wait_for([&] { return slurp(dir / "err").find("waiting") != std::string::npos; }));
  for (const bool last : {false, true}) {
    auto sink = web::make_web_sink(address);
    ASSERT_TRUE(wait_for([&] { return bool((*sink)->start(show.info)); }));
    ASSERT_TRUE(wait_for([&] { return (*sink)->stats().receivers > 0; })) << slurp(dir / "err");
    for (const LiveUnit& unit : show.units) ASSERT_TRUE((*sink)->send(unit));
    ASSERT_TRUE(wait_for([&] { return (*sink)->stats().packets >= 51; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    if (!last) continue;  // it goes without a goodbye
    ASSERT_TRUE((*sink)->finish());
  }
  EXPECT_EQ(receive.wait(), 0) << slurp(dir / "err");
  const auto json = nlohmann::json::parse(slurp(dir / "out"));
  EXPECT_EQ(json["sessions"], 2);
  EXPECT_EQ(json["planes_usable"], 100) << slurp(dir / "err");
  EXPECT_EQ(container(dir / "got.mp4").face.units.size(), 100u);
}

}  // namespace web_hostile_test
}  // namespace animeme::test

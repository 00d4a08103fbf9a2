// A bad network between two ends of UDP on this machine: it loses and delays datagrams, each on its
// own. They overtake each other or, as where they wait in a queue, do not.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <random>
#include <thread>
#include <utility>
#include <vector>

namespace animeme::test {

class Relay {
 public:
  /// To 127.0.0.1:`port` and back. `loss`: share of the datagrams; `jitter`: seconds of delay at
  /// most. `overtake`: one that is delayed less than the one before it comes before it.
  Relay(int port, double loss, double jitter, bool overtake)
      : loss_(loss), jitter_(jitter), overtake_(overtake) {
    server_.sin_family = AF_INET;
    server_.sin_port = htons(std::uint16_t(port));
    server_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    front_ = open();
    back_ = open();
    thread_ = std::thread([this] { run(); });
  }
  ~Relay() {
    over_ = true;
    thread_.join();
    close(front_);
    close(back_);
  }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  int port() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(front_, reinterpret_cast<sockaddr*>(&own), &size);
    return ntohs(own.sin_port);
  }
  int passed() const { return passed_; }
  int lost() const { return lost_; }
  /// From now on nothing passes.
  void cut() { loss_ = 1; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Datagram {
    bool to_server = false;
    std::vector<std::uint8_t> bytes;
  };

  static int open() {
    const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    sockaddr_in any{};
    any.sin_family = AF_INET;
    any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)bind(handle, reinterpret_cast<sockaddr*>(&any), sizeof any);
    return handle;
  }

  void run() {
    while (!over_) {
      pollfd ready[2] = {{front_, POLLIN, 0}, {back_, POLLIN, 0}};
      poll(ready, 2, 1);
      take(front_, true);
      take(back_, false);
      for (auto next = waiting_.begin(); next != waiting_.end() && next->first <= Clock::now();
           next = waiting_.erase(next)) {
        const Datagram& what = next->second;
        const sockaddr_in& where = what.to_server ? server_ : browser_;
        sendto(what.to_server ? back_ : front_, what.bytes.data(), what.bytes.size(), 0,
               reinterpret_cast<const sockaddr*>(&where), sizeof where);
        ++passed_;
      }
    }
  }

  void take(int from, bool to_server) {
    std::array<std::uint8_t, 65536> block{};
    sockaddr_in sender{};
    socklen_t size = sizeof sender;
    for (;;) {
      const ssize_t count = recvfrom(from, block.data(), block.size(), 0,
                                     reinterpret_cast<sockaddr*>(&sender), &size);
      if (count < 0) return;
      if (to_server) browser_ = sender;
      if (std::uniform_real_distribution<double>(0, 1)(random_) < loss_) {
        ++lost_;
        continue;
      }
      const double delay = std::uniform_real_distribution<double>(0, jitter_)(random_);
      Clock::time_point when = Clock::now() + std::chrono::microseconds(std::int64_t(delay * 1e6));
      Clock::time_point& last = to_server ? last_there_ : last_back_;
      if (!overtake_) when = std::max(when, last);
      last = when;
      waiting_.emplace(when, Datagram{to_server, {block.begin(), block.begin() + count}});
    }
  }

  std::atomic<double> loss_;
  const double jitter_;
  const bool overtake_;
  Clock::time_point last_there_, last_back_;
  sockaddr_in server_{}, browser_{};
  int front_ = -1, back_ = -1;
  /// ANIMEME_SEED: for a network that is as bad in another way.
  static unsigned seed() {
    const char* given = std::getenv("ANIMEME_SEED");
    return given != nullptr ? unsigned(std::atoi(given)) : 1;
  }
  std::mt19937 random_{seed()};
  std::multimap<Clock::time_point, Datagram> waiting_;
  std::atomic<int> passed_ = 0, lost_ = 0;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

}  // namespace animeme::test

// Datagrams at their instants. What is due goes out at once; what is not waits for a thread, since
// sinks are looked after twenty times a second only, and faces go out up to 120 times.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme::engines {

class PacedSender {
 public:
  using Datagrams = std::vector<std::vector<std::uint8_t>>;

  PacedSender(media::UdpSocket socket, const media::UdpAddress& to)
      : socket_(std::move(socket)), to_(to) {}
  ~PacedSender();
  PacedSender(const PacedSender&) = delete;
  PacedSender& operator=(const PacedSender&) = delete;

  /// Seconds of a steady clock, that of the instants.
  static double now();
  /// Instants ascend. Errors: io, also of what went out before.
  Result<void> send(double instant, Datagrams datagrams);
  /// Waits until everything has gone out.
  Result<void> finish();

 private:
  struct Waiting {
    double instant;
    Datagrams datagrams;
  };
  void run();
  void put(const Datagrams& datagrams);  // with the lock held

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::optional<Error> error_;
  bool stop_ = false;
  media::UdpSocket socket_;
  media::UdpAddress to_;
  std::thread thread_;
};

}  // namespace animeme::engines

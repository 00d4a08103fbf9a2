// The WebSocket connections of a source: messages of `/face` and, if there is a sound, of `/audio`,
// whole and in order.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/live/web/detail/address.h"
#include "tools/live/web/detail/service.h"

namespace animeme::web {

struct Incoming {
  bool sound = false;
  std::vector<std::uint8_t> bytes;
};

class Client {
 public:
  using Clock = std::chrono::steady_clock;

  Client(WebAddress address, std::size_t queue_bytes)
      : address_(std::move(address)), queue_bytes_(queue_bytes) {}
  ~Client() { service_.stop(); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Waits until `/face` and, if the server has one, its sound are open, 5 seconds at most: what is
  /// sent from then on arrives. Errors: io.
  Result<void> connect();
  /// nullopt: nothing came in time. Errors: end_of_stream (the server said goodbye), io (the
  /// connection broke).
  Result<std::optional<Incoming>> next(Clock::time_point until);

 private:
  struct Connection {
    bool sound = false;
    bool wanted = false;  // it has been asked for
    bool open = false, over = false, goodbye = false;
    lws* wsi = nullptr;
    std::vector<std::uint8_t> message;  // that has begun
  };

  static int callback(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t size);
  int handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size);
  bool ask(Connection& connection);
  void established(Connection& connection, lws* wsi);
  int receive(Connection& connection);
  void close(Connection& connection, const std::string& why);
  void resume();
  bool over() const;
  bool ready() const;

  const WebAddress address_;
  const std::size_t queue_bytes_;
  Service service_;

  std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  Connection connections_[2];  // face, sound
  std::deque<Incoming> queue_;
  std::size_t queued_ = 0;  // bytes
  bool paused_ = false;
  std::string problem_;
};

}  // namespace animeme::web

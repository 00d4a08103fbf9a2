// FFmpeg's udp and srt protocols, each served by a thread of its own, so that nobody waits for the
// network. Datagrams are read from a socket of ours, as FFmpeg does not tell who has sent them.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/detail/ffmpeg/net_address.h"
#include "tools/formats/media/rtp/udp_socket.h"

struct AVIOContext;

namespace animeme::media {

/// What reader and writer share: the thread and its end.
class NetThread {
 public:
  NetThread(const NetThread&) = delete;
  NetThread& operator=(const NetThread&) = delete;

 protected:
  explicit NetThread(NetAddress address, std::size_t queue_bytes)
      : address_(std::move(address)), queue_bytes_(queue_bytes) {}
  ~NetThread() = default;

  /// Opens in this thread. Errors: io.
  Result<void> open(int flags, int datagram_bytes);
  void close();
  void stop();
  /// Errors: io (no more threads). What the thread throws, for want of memory, rethrow() throws.
  Result<void> start_thread(std::function<void()> body);
  void rethrow();  ///< under the mutex
  static int is_stopping(void* self);

  const NetAddress address_;
  const std::size_t queue_bytes_;
  AVIOContext* io_ = nullptr;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
  std::mutex mutex_;
  std::exception_ptr failure_of_thread_;
  std::condition_variable changed_;
  struct Piece {
    std::vector<std::uint8_t> bytes;
    UdpAddress from;
  };
  std::deque<Piece> queue_;
  std::size_t queued_ = 0;  // bytes
};

class NetReader : NetThread {
 public:
  NetReader(NetAddress address, std::size_t queue_bytes)
      : NetThread(std::move(address), queue_bytes) {}
  ~NetReader();
  /// An SRT listener is opened in the background. Errors: io.
  Result<void> start();

  struct Datagram {
    std::vector<std::uint8_t> bytes;
    UdpAddress from;   ///< nobody where it is not known
    bool end = false;  ///< the connection is over, and nothing is left
    Error error;       ///< with `end`: message not empty if it never came about
  };
  /// nullopt: nothing came in time.
  std::optional<Datagram> next(std::chrono::steady_clock::time_point until);

 private:
  void run();
  void read_all();
  void read_socket();
  bool is_plain() const;
  Result<void> bind();
  void queue(std::span<const std::uint8_t> bytes, const UdpAddress& from);

  std::optional<UdpSocket> socket_;
  bool ended_ = false;
  Error failure_;
};

class NetWriter : NetThread {
 public:
  NetWriter(NetAddress address, std::size_t queue_bytes, int datagram_bytes)
      : NetThread(std::move(address), queue_bytes), datagram_bytes_(datagram_bytes) {}
  ~NetWriter();
  Result<void> start();
  /// Queues one datagram. False: nobody is there, or it is too slow.
  bool write(std::span<const std::uint8_t> bytes);
  /// Sends what is queued, waits until the receiver must have it, and closes.
  void finish();
  bool connected() const { return connected_; }
  /// Ended by the other side (SRT caller): nothing can be sent any more.
  bool broken() const { return broken_; }

 private:
  void run();
  bool write_all();

  const int datagram_bytes_;
  std::atomic<bool> connected_ = false, broken_ = false;
  bool last_ = false;  // finish() was called
};

}  // namespace animeme::media

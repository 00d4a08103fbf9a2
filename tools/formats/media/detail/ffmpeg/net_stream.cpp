#include "tools/formats/media/detail/ffmpeg/net_stream.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"

namespace animeme::media {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr int kLargestDatagram = 65536;
constexpr std::int64_t kSocketBuffer = std::int64_t(1) << 20;
constexpr milliseconds kRetry{200};
constexpr std::size_t kItem = 256;            // what a datagram costs beside its bytes
constexpr std::int64_t kSrtLatency = 120000;  // microseconds, unless the address says otherwise

/// Is this an address of this machine that a socket can be bound to?
bool is_own_address(const std::string& host) {
  const Result<UdpAddress> address = UdpAddress::resolve(host, 0);
  return address && !address->is_multicast() && UdpSocket::bind(address->host(), 0);
}

}  // namespace

int NetThread::is_stopping(void* self) {
  return static_cast<NetThread*>(self)->stopping_.load() ? 1 : 0;
}

Result<void> NetThread::open(int flags, int datagram_bytes) {
  const bool reading = (flags & AVIO_FLAG_WRITE) == 0, udp = address_.scheme == "udp";
  av::LogCapture log;
  av::Options options;
  options.set("pkt_size", std::int64_t(datagram_bytes));
  if (udp && reading) {
    options.set("fifo_size", std::int64_t(0));  // the thread is ours
    options.set("buffer_size", kSocketBuffer);
  }
  if (!udp && address_.listener) options.set("listen_timeout", std::int64_t(-1));
  // A local address is bound; with an address of another machine any sender is accepted.
  if (udp && reading && address_.option("localaddr").empty() && is_own_address(address_.host)) {
    options.set("localaddr", address_.host);
  }
  const std::string host = address_.host.empty() ? "0.0.0.0" : address_.host;
  const std::string url =
      address_.scheme + "://" + host + ":" + std::to_string(address_.port) + address_.query;
  AVIOInterruptCB interrupt{&NetThread::is_stopping, this};
  const int status = avio_open2(&io_, url.c_str(), flags, &interrupt, options.get());
  if (status >= 0) return {};
  io_ = nullptr;
  std::string why = log.lines().empty() ? av::error_text(status) : log.lines().back();
  if (const std::size_t at = why.find(url); at != std::string::npos) {
    why.replace(at, url.size(), address_.text());  // no passphrase in messages
  }
  if (udp && reading) why += "; is the port in use, or is the host not an address of this machine?";
  if (!udp && !address_.listener) why += "; is a program listening there (mode=listener)?";
  if (address_.listener) why += "; is the port in use?";
  return make_error(Code::io, address_.text() + " cannot be opened: " + why);
}

void NetThread::close() {
  av::LogCapture quiet;
  if (io_ != nullptr) avio_closep(&io_);
}

void NetThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  close();
}

Result<void> NetThread::start_thread(std::function<void()> body) {
  try {
    thread_ = std::thread([this, body = std::move(body)] {
      try {
        body();
      } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_of_thread_ = std::current_exception();
        changed_.notify_all();
      }
    });
  } catch (const std::system_error&) {
    return make_error(Code::io, "no thread can be started for the connection");
  }
  return {};
}

void NetThread::rethrow() {
  if (failure_of_thread_) std::rethrow_exception(std::exchange(failure_of_thread_, nullptr));
}

NetReader::~NetReader() { stop(); }

// These options only FFmpeg knows what to do with.
bool NetReader::is_plain() const {
  for (const char* name : {"sources", "block", "localport", "connect", "reuse", "timeout"}) {
    if (!address_.option(name).empty()) return false;
  }
  return address_.scheme == "udp";
}

/// As FFmpeg binds: to a group, to an address of ours alone, or to all.
Result<void> NetReader::bind() {
  const std::string local = address_.option("localaddr");
  const Result<UdpAddress> host =
      UdpAddress::resolve(address_.host.empty() ? "0.0.0.0" : address_.host, address_.port);
  if (!host) return host.error();
  std::string at = host->host();
  Multicast multicast;
  if (host->is_multicast()) {
    multicast.interface = local;
  } else if (!local.empty()) {
    at = local;
  } else if (!is_own_address(at)) {
    at = host->is_ipv6() ? "::" : "0.0.0.0";
  }
  Result<UdpSocket> socket = UdpSocket::bind(at, address_.port, multicast);
  if (!socket) {
    return make_error(Code::io,
                      address_.text() + " cannot be opened: " + socket.error().message +
                          "; is the port in use, or is the host not an address of this machine?");
  }
  socket_.emplace(std::move(*socket));
  return {};
}

Result<void> NetReader::start() {
  if (is_plain()) {
    Result<void> bound = bind();
    if (!bound) return bound;
  } else if (!address_.listener) {
    Result<void> opened = open(AVIO_FLAG_READ, address_.scheme == "udp" ? kLargestDatagram : 1456);
    if (!opened) return opened;
  }
  return start_thread([this] { run(); });
}

void NetReader::run() {
  av::LogCapture quiet;
  Error failure;
  if (socket_) {
    read_socket();
  } else if (io_ == nullptr) {
    Result<void> opened = open(AVIO_FLAG_READ, 1456);
    if (!opened) failure = opened.error();
  }
  if (io_ != nullptr) read_all();
  const std::lock_guard lock(mutex_);
  failure_ = std::move(failure);
  ended_ = true;
  changed_.notify_all();
}

void NetReader::read_socket() {
  const UdpSocket* const sockets[] = {&*socket_};
  while (!stopping_) {
    UdpAddress from;
    const auto got = socket_->receive(&from);
    if (got && *got) {
      queue(**got, from);
    } else if (!got || !wait_for_any(sockets, 0.05)) {
      std::this_thread::sleep_for(milliseconds(10));  // an error is one of a single datagram
    }
  }
}

void NetReader::queue(std::span<const std::uint8_t> bytes, const UdpAddress& from) {
  const std::lock_guard lock(mutex_);
  if (queued_ + bytes.size() + kItem > queue_bytes_) return;  // the counters will show it
  queue_.push_back({{bytes.begin(), bytes.end()}, from});
  queued_ += bytes.size() + kItem;
  changed_.notify_all();
}

void NetReader::read_all() {
  std::vector<std::uint8_t> block(kLargestDatagram);
  while (!stopping_) {
    const int count = avio_read_partial(io_, block.data(), int(block.size()));
    if (count == AVERROR(EAGAIN) || count == 0) continue;
    if (count < 0) {
      // A UDP port has no end: an error is one of a single datagram.
      if (address_.scheme != "udp" || count == AVERROR_EXIT) return;
      io_->eof_reached = io_->error = 0;
      std::this_thread::sleep_for(milliseconds(10));
      continue;
    }
    queue(std::span(block).first(std::size_t(count)), {});
  }
}

std::optional<NetReader::Datagram> NetReader::next(std::chrono::steady_clock::time_point until) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, until,
                      [this] { return !queue_.empty() || ended_ || failure_of_thread_; });
  rethrow();
  if (queue_.empty()) {
    if (!ended_) return {};
    return Datagram{.end = true, .error = failure_};
  }
  Datagram datagram{.bytes = std::move(queue_.front().bytes), .from = queue_.front().from};
  queue_.pop_front();
  queued_ -= datagram.bytes.size() + kItem;
  return datagram;
}

NetWriter::~NetWriter() { stop(); }

Result<void> NetWriter::start() {
  if (!address_.listener) {
    Result<void> opened = open(AVIO_FLAG_WRITE, datagram_bytes_);
    if (!opened) return opened;
    connected_ = true;
  }
  return start_thread([this] { run(); });
}

void NetWriter::run() {
  av::LogCapture quiet;
  while (!stopping_) {
    if (io_ == nullptr) {
      if (!open(AVIO_FLAG_WRITE, datagram_bytes_)) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kRetry, [this] { return stopping_.load() || last_; });
        if (last_) return;
        continue;
      }
      connected_ = true;
    }
    if (write_all()) return;
    connected_ = false;
    if (!address_.listener) {
      broken_ = true;
      return;
    }
    close();
    const std::lock_guard lock(mutex_);
    if (last_) return;  // after finish() no thread would end a second wait
    queue_.clear();
    queued_ = 0;
    changed_.notify_all();
  }
}

/// True: all is sent, after finish(). False: the connection is gone.
bool NetWriter::write_all() {
  const bool udp = address_.scheme == "udp";
  for (;;) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopping_ || last_ || !queue_.empty(); });
    if (stopping_ || queue_.empty()) return true;
    std::vector<std::uint8_t> datagram = std::move(queue_.front().bytes);
    queue_.pop_front();
    queued_ -= datagram.size();
    lock.unlock();
    avio_write(io_, datagram.data(), int(datagram.size()));
    avio_flush(io_);
    if (io_->error >= 0) continue;
    if (!udp) return false;
    io_->error = 0;  // no receiver on this UDP port: not an error
  }
}

bool NetWriter::write(std::span<const std::uint8_t> bytes) {
  if (!connected_) return false;
  const std::lock_guard lock(mutex_);
  rethrow();
  if (queued_ + bytes.size() > queue_bytes_) return false;
  queue_.push_back({{bytes.begin(), bytes.end()}, {}});
  queued_ += bytes.size();
  changed_.notify_all();
  return true;
}

void NetWriter::finish() {
  {
    const std::lock_guard lock(mutex_);
    last_ = true;
    if (!connected_) stopping_ = true;  // a listener without a receiver
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  if (connected_ && address_.scheme == "srt") {
    // SRT gives out its packets late on purpose, and drops the rest when the sender hangs up.
    std::int64_t latency = kSrtLatency;
    for (const char* name : {"latency", "rcvlatency", "peerlatency", "tsbpddelay"}) {
      latency = std::max<std::int64_t>(latency, std::atoll(address_.option(name).c_str()));
    }
    std::this_thread::sleep_for(microseconds(std::min<std::int64_t>(latency, 8000000)) +
                                milliseconds(150));
  }
  connected_ = false;
  close();
}

}  // namespace animeme::media

// What a sender has sent, as its own web server tells it: the values of each plane, heard by a
// WebSocket client of the test's own, which knows nothing of the receivers.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace animeme::test {

inline constexpr int kFaps = 68;
/// Values of FAP 3 to 68 by number, those that are not there 0.
using Values = std::array<int, kFaps + 1>;

/// One run of a sender.
struct SentPlanes {
  double first = -1;  ///< seconds of the first plane; later than 1.0: some were missed
  std::vector<Values> planes;
};

class Truth {
 public:
  explicit Truth(int port) : port_(port) {}
  ~Truth() { drop(); }
  Truth(const Truth&) = delete;
  Truth& operator=(const Truth&) = delete;

  /// A sender is started: what comes from now on is a run of its own.
  void begin() {
    drop();
    runs_.emplace_back();
  }
  /// Connects if it is not, and takes what is there. To be called often.
  void look() {
    if (handle_ < 0 && !connect_now()) return;
    std::array<char, 65536> block{};
    for (;;) {
      const ssize_t count = recv(handle_, block.data(), block.size(), MSG_DONTWAIT);
      if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
      if (count <= 0) return drop();
      text_.append(block.data(), std::size_t(count));
      take();
    }
  }
  const std::vector<SentPlanes>& runs() const { return runs_; }

 private:
  void drop() {
    if (handle_ >= 0) close(handle_);
    handle_ = -1;
    text_.clear();
    open_ = false;
  }
  bool connect_now() {
    if (runs_.empty()) return false;
    handle_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(handle_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      drop();
      return false;
    }
    const std::string request =
        "GET /faps HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
    (void)send(handle_, request.data(), request.size(), MSG_NOSIGNAL);
    return true;
  }
  /// Frames of a server: not masked, one a message. Source: RFC 6455, section 5.2.
  void take() {
    if (!open_) {
      const std::size_t end = text_.find("\r\n\r\n");
      if (end == std::string::npos) return;
      text_.erase(0, end + 4);
      open_ = true;
    }
    const auto byte = [&](std::size_t at) { return std::size_t(std::uint8_t(text_[at])); };
    for (;;) {
      if (text_.size() < 2) return;
      std::size_t size = byte(1) & 127, head = 2;
      if (size == 126) {
        if (text_.size() < 4) return;
        size = byte(2) << 8 | byte(3);
        head = 4;
      }
      if (text_.size() < head + size) return;
      if ((byte(0) & 15) == 1) note(text_.substr(head, size));
      text_.erase(0, head + size);
    }
  }
  void note(const std::string& message) {
    const auto json = nlohmann::json::parse(message, nullptr, false);
    if (json.is_discarded() || !json.contains("values")) return;
    SentPlanes& run = runs_.back();
    if (run.first < 0) run.first = json["time"].get<double>() - 1;  // time 0 is 1 there
    Values values{};
    for (const auto& [name, value] : json["values"].items()) {
      const int fap = std::stoi(name);
      if (fap > 2 && fap <= kFaps) values[std::size_t(fap)] = value.get<int>();
    }
    run.planes.push_back(values);
  }

  const int port_;
  int handle_ = -1;
  bool open_ = false;
  std::string text_;
  std::vector<SentPlanes> runs_;
};

}  // namespace animeme::test

// Ports for tests on this machine.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

namespace animeme::test {

/// A UDP socket on 127.0.0.1.
class UdpSocket {
 public:
  /// Port 0: any free one.
  explicit UdpSocket(int port = 0) : handle_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = local(port);
    const int size = 1 << 20;
    setsockopt(handle_, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
    if (bind(handle_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no UDP port");
    }
  }
  ~UdpSocket() { close(handle_); }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int port() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(handle_, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }
  /// One datagram; empty: none within `milliseconds`.
  std::vector<std::uint8_t> take(int milliseconds) {
    timeval patience{milliseconds / 1000, milliseconds % 1000 * 1000 + 1};
    setsockopt(handle_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    std::vector<std::uint8_t> bytes(65536);
    const ssize_t count = recv(handle_, bytes.data(), bytes.size(), 0);
    bytes.resize(count < 0 ? 0 : std::size_t(count));
    return bytes;
  }
  void send(const std::vector<std::uint8_t>& bytes, int port) {
    const sockaddr_in to = local(port);
    sendto(handle_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }

 private:
  static sockaddr_in local(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

  int handle_;
};

/// A UDP port that was free just now.
inline int free_udp_port() { return UdpSocket().port(); }

}  // namespace animeme::test

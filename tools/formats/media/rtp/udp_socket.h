/// @file
/// Datagrams over IPv4 and IPv6, to one host or a multicast group.
///
///     auto in = UdpSocket::bind("127.0.0.1", 5004);
///     auto got = in->receive(buffer);
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"

struct sockaddr_storage;

namespace animeme::media {

/// A host and a port, resolved.
class UdpAddress {
 public:
  /// `host`: a name or a number; a name that has both gets its IPv4 address. Errors: io (no such
  /// host), invalid_argument (port outside 0..65535).
  static Result<UdpAddress> resolve(const std::string& host, int port);

  std::string host() const;                       ///< as numbers, without brackets
  int port() const;                               ///< 1..65535, 0 for any
  bool is_multicast() const;                      ///< a group, not a host
  bool is_loopback() const;                       ///< this machine
  bool is_ipv6() const;                           ///< true: IPv6, false: IPv4
  bool same_host(const UdpAddress& other) const;  ///< whatever the port
  /// Same host and port. A default-constructed address equals only itself.
  bool is(const UdpAddress& other) const;
  /// is()
  friend bool operator==(const UdpAddress& a, const UdpAddress& b) { return a.is(b); }
  UdpAddress with_port(int port) const;  ///< the same host

 private:
  friend class UdpSocket;
  alignas(8) std::uint8_t bytes_[128] = {};  // sockaddr_storage
  std::uint32_t size_ = 0;
};

/// Multicast settings, ignored for unicast.
struct Multicast {
  int ttl = 1;            ///< hops of what is sent
  std::string interface;  ///< IPv4: a local address, IPv6: name; empty: system default
};

/// Owner of one socket. Movable, not copyable.
class UdpSocket {
 public:
  /// For receiving at a local address, or from a group (which is joined). Host empty: all
  /// addresses, IPv4. Port 0: any. Errors: io (address in use, not local ...).
  static Result<UdpSocket> bind(const std::string& host, int port, const Multicast& multicast = {});
  /// For sending to `to` and receiving answers; if `to` is this machine, only from this machine.
  /// Errors: io.
  static Result<UdpSocket> open_for(const UdpAddress& to, const Multicast& multicast = {});
  UdpSocket(UdpSocket&& other) noexcept;  ///< movable
  UdpSocket& operator=(UdpSocket&& other) noexcept;
  ~UdpSocket();

  /// Sends immediately. A missing receiver, a full buffer or a temporarily unavailable network are
  /// not errors: datagrams get lost. Errors: io (anything else, such as a message that is too
  /// long).
  Result<void> send(std::span<const std::uint8_t> datagram, const UdpAddress& to);
  /// Returns an available datagram without waiting; nullopt: none. `from` may be null. Errors: io.
  Result<std::optional<std::vector<std::uint8_t>>> receive(UdpAddress* from = nullptr);
  /// The bound port.
  int port() const;
  int handle() const { return handle_; }  ///< file descriptor, for poll()

 private:
  explicit UdpSocket(int handle) : handle_(handle) {}
  int handle_ = -1;
};

/// Waits until one of the sockets has a datagram, at most `seconds` (>= 0). false: timeout.
/// Errors: io.
Result<bool> wait_for_any(std::span<const UdpSocket* const> sockets, double seconds);

/// host and port of "scheme://host:port"; IPv6 hosts in brackets. `standard_port` if there is none.
/// Errors: invalid_argument.
struct HostPort {
  std::string host;  ///< without brackets
  int port = 0;      ///< 1..65535
};
Result<HostPort> read_host_port(const std::string& url, int standard_port);  ///< see HostPort

}  // namespace animeme::media

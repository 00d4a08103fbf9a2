#include "tools/formats/media/rtp/udp_socket.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace animeme::media {
namespace {

constexpr int kBufferBytes = 1 << 20;
constexpr std::size_t kMaxDatagram = 1 << 16;

Error failed(const std::string& what) {
  return make_error(Code::io, what + ": " + std::strerror(errno));
}

sockaddr* raw(std::uint8_t* bytes) { return reinterpret_cast<sockaddr*>(bytes); }
const sockaddr* raw(const std::uint8_t* bytes) { return reinterpret_cast<const sockaddr*>(bytes); }

// Copies the bytes, since a cast would break the aliasing rules.
template <class T>
T as(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

template <class T>
bool set(int handle, int level, int option, const T& value) {
  return ::setsockopt(handle, level, option, &value, sizeof value) == 0;
}

Result<in_addr> interface_address(const Multicast& multicast) {
  in_addr address{};
  address.s_addr = htonl(INADDR_ANY);
  if (!multicast.interface.empty() &&
      ::inet_pton(AF_INET, multicast.interface.c_str(), &address) != 1) {
    return make_error(Code::invalid_argument,
                      "the interface of IPv4 multicast is given by its "
                      "address, as 192.0.2.1, not '" +
                          multicast.interface + "'");
  }
  return address;
}

Result<unsigned> interface_index(const Multicast& multicast) {
  if (multicast.interface.empty()) return 0u;
  const unsigned index = ::if_nametoindex(multicast.interface.c_str());
  if (index == 0) {
    return make_error(Code::invalid_argument,
                      "there is no network interface '" + multicast.interface + "'");
  }
  return index;
}

Result<void> join_group(int handle, const UdpAddress& group, const std::uint8_t* bytes,
                        const Multicast& multicast) {
  bool joined = false;
  if (group.is_ipv6()) {
    const Result<unsigned> index = interface_index(multicast);
    if (!index) return index.error();
    const ipv6_mreq request{as<sockaddr_in6>(bytes).sin6_addr, *index};
    joined = set(handle, IPPROTO_IPV6, IPV6_JOIN_GROUP, request);
  } else {
    const Result<in_addr> address = interface_address(multicast);
    if (!address) return address.error();
    const ip_mreq request{as<sockaddr_in>(bytes).sin_addr, *address};
    joined = set(handle, IPPROTO_IP, IP_ADD_MEMBERSHIP, request);
  }
  if (!joined) return failed("the multicast group " + group.host() + " cannot be joined");
  return {};
}

Result<void> prepare_sending(int handle, const UdpAddress& to, const Multicast& multicast) {
  if (!to.is_multicast()) return {};
  bool good = false;
  if (to.is_ipv6()) {
    const Result<unsigned> index = interface_index(multicast);
    if (!index) return index.error();
    good = set(handle, IPPROTO_IPV6, IPV6_MULTICAST_HOPS, multicast.ttl) &&
           (*index == 0 || set(handle, IPPROTO_IPV6, IPV6_MULTICAST_IF, *index));
  } else {
    const Result<in_addr> address = interface_address(multicast);
    if (!address) return address.error();
    good = set(handle, IPPROTO_IP, IP_MULTICAST_TTL, multicast.ttl) &&
           (multicast.interface.empty() || set(handle, IPPROTO_IP, IP_MULTICAST_IF, *address));
  }
  if (!good) return failed("multicast cannot be set up");
  return {};
}

Result<int> make_socket(bool ipv6) {
  const int handle =
      ::socket(ipv6 ? AF_INET6 : AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_UDP);
  if (handle < 0) return failed("no socket can be opened");
  // What the system grants is enough; a small buffer only loses more.
  set(handle, SOL_SOCKET, SO_RCVBUF, kBufferBytes);
  set(handle, SOL_SOCKET, SO_SNDBUF, kBufferBytes);
  return handle;
}

// Datagrams are not promised to arrive; these say that one did not.
bool is_loss(int error) {
  return error == EAGAIN || error == EWOULDBLOCK || error == ECONNREFUSED || error == ENOBUFS ||
         error == ENETUNREACH || error == EHOSTUNREACH || error == ENETDOWN || error == EINTR;
}

}  // namespace

Result<UdpAddress> UdpAddress::resolve(const std::string& host, int port) {
  if (port < 0 || port > 65535) {
    return make_error(Code::invalid_argument, "a port is a number from 0 to 65535");
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (error != 0) {
    return make_error(Code::io, "there is no host '" + host + "': " + ::gai_strerror(error));
  }
  const addrinfo* best = found;
  for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
    if (each->ai_family == AF_INET) {
      best = each;
      break;
    }
  }
  UdpAddress address;
  address.size_ = std::uint32_t(std::min<std::size_t>(best->ai_addrlen, sizeof address.bytes_));
  std::memcpy(address.bytes_, best->ai_addr, address.size_);
  ::freeaddrinfo(found);
  return address.with_port(port);
}

std::string UdpAddress::host() const {
  char text[NI_MAXHOST] = {};
  ::getnameinfo(raw(bytes_), size_, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
  return text;
}

bool UdpAddress::is_ipv6() const { return as<sockaddr>(bytes_).sa_family == AF_INET6; }

int UdpAddress::port() const {
  return ntohs(is_ipv6() ? as<sockaddr_in6>(bytes_).sin6_port : as<sockaddr_in>(bytes_).sin_port);
}

UdpAddress UdpAddress::with_port(int port) const {
  static_assert(sizeof bytes_ >= sizeof(sockaddr_storage));
  UdpAddress changed = *this;
  const std::uint16_t wire = htons(std::uint16_t(port));
  const std::size_t at =
      is_ipv6() ? offsetof(sockaddr_in6, sin6_port) : offsetof(sockaddr_in, sin_port);
  std::memcpy(changed.bytes_ + at, &wire, sizeof wire);
  return changed;
}

bool UdpAddress::is_multicast() const {
  if (is_ipv6()) return as<sockaddr_in6>(bytes_).sin6_addr.s6_addr[0] == 0xFF;
  return IN_MULTICAST(ntohl(as<sockaddr_in>(bytes_).sin_addr.s_addr));
}

bool UdpAddress::is_loopback() const {
  if (is_ipv6()) {
    const in6_addr address = as<sockaddr_in6>(bytes_).sin6_addr;
    return IN6_IS_ADDR_LOOPBACK(&address);
  }
  return ntohl(as<sockaddr_in>(bytes_).sin_addr.s_addr) >> 24 == 127;
}

bool UdpAddress::same_host(const UdpAddress& other) const {
  if (size_ == 0 || other.size_ == 0) return size_ == other.size_;
  if (is_ipv6() != other.is_ipv6()) return false;
  if (!is_ipv6()) {
    return as<sockaddr_in>(bytes_).sin_addr.s_addr == as<sockaddr_in>(other.bytes_).sin_addr.s_addr;
  }
  const in6_addr a = as<sockaddr_in6>(bytes_).sin6_addr;
  const in6_addr b = as<sockaddr_in6>(other.bytes_).sin6_addr;
  return std::memcmp(&a, &b, sizeof a) == 0;
}

bool UdpAddress::is(const UdpAddress& other) const {
  return same_host(other) && (size_ == 0 || port() == other.port());
}

Result<UdpSocket> UdpSocket::bind(const std::string& host, int port, const Multicast& multicast) {
  const Result<UdpAddress> address = UdpAddress::resolve(host.empty() ? "0.0.0.0" : host, port);
  if (!address) return address.error();
  const Result<int> handle = make_socket(address->is_ipv6());
  if (!handle) return handle.error();
  UdpSocket socket(*handle);
  // Several programs on one machine may listen to a group.
  if (address->is_multicast()) set(*handle, SOL_SOCKET, SO_REUSEADDR, 1);
  if (::bind(*handle, raw(address->bytes_), address->size_) != 0) {
    return failed("port " + std::to_string(port) + " of " + address->host() + " cannot be bound");
  }
  if (address->is_multicast()) {
    if (auto ok = join_group(*handle, *address, address->bytes_, multicast); !ok) return ok.error();
  }
  return socket;
}

Result<UdpSocket> UdpSocket::open_for(const UdpAddress& to, const Multicast& multicast) {
  const Result<int> handle = make_socket(to.is_ipv6());
  if (!handle) return handle.error();
  UdpSocket socket(*handle);
  if (auto ok = prepare_sending(*handle, to, multicast); !ok) return ok.error();
  if (to.is_loopback()) {  // other processes must not answer
    const UdpAddress from = to.with_port(0);
    if (::bind(*handle, raw(from.bytes_), from.size_) != 0) return failed("no port is free");
  }
  return socket;
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  std::swap(handle_, other.handle_);
  return *this;
}

UdpSocket::~UdpSocket() {
  if (handle_ >= 0) ::close(handle_);
}

Result<void> UdpSocket::send(std::span<const std::uint8_t> datagram, const UdpAddress& to) {
  // A pending error of an earlier datagram is returned first; so try twice.
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto sent =
        ::sendto(handle_, datagram.data(), datagram.size(), MSG_NOSIGNAL, raw(to.bytes_), to.size_);
    if (sent >= 0) return {};
    if (errno != ECONNREFUSED && errno != EINTR) break;
  }
  if (is_loss(errno)) return {};
  return failed("sending to " + to.host() + " port " + std::to_string(to.port()) + " failed");
}

Result<std::optional<std::vector<std::uint8_t>>> UdpSocket::receive(UdpAddress* from) {
  thread_local std::vector<std::uint8_t> buffer(kMaxDatagram);
  UdpAddress sender;
  socklen_t size = sizeof sender.bytes_;
  for (;;) {
    const auto got =
        ::recvfrom(handle_, buffer.data(), buffer.size(), 0, raw(sender.bytes_), &size);
    if (got >= 0) {
      sender.size_ = size;
      if (from != nullptr) *from = sender;
      return std::optional(std::vector<std::uint8_t>(buffer.begin(), buffer.begin() + got));
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) {
      return std::optional<std::vector<std::uint8_t>>();
    }
    if (!is_loss(errno)) return failed("receiving failed");
  }
}

int UdpSocket::port() const {
  UdpAddress address;
  socklen_t size = sizeof address.bytes_;
  if (::getsockname(handle_, raw(address.bytes_), &size) != 0) return 0;
  return address.port();
}

Result<bool> wait_for_any(std::span<const UdpSocket* const> sockets, double seconds) {
  std::vector<pollfd> waits;
  for (const UdpSocket* socket : sockets) waits.push_back({socket->handle(), POLLIN, 0});
  constexpr double kLongestWait = 3600;
  const int milliseconds = int(std::ceil(std::clamp(seconds, 0.0, kLongestWait) * 1000));
  const int ready = ::poll(waits.data(), nfds_t(waits.size()), milliseconds);
  if (ready < 0 && errno != EINTR) return failed("waiting for packets failed");
  return ready > 0;
}

}  // namespace animeme::media

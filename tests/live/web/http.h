// A TCP connection to a server on this machine, for requests good and bad.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace animeme::test {

class Connection {
 public:
  /// `from`: address of this machine to come from ("127.0.0.2"); nullptr: any.
  explicit Connection(int port, int receive_buffer = 0, const char* from = nullptr)
      : handle_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_buffer > 0) {
      setsockopt(handle_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    sockaddr_in address{};
    address.sin_family = AF_INET;
    if (from != nullptr && inet_pton(AF_INET, from, &address.sin_addr) == 1) {
      (void)bind(handle_, reinterpret_cast<sockaddr*>(&address), sizeof address);
    }
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    open_ = connect(handle_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Connection() { close(handle_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_open() const { return open_; }
  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return;
      bytes.remove_prefix(std::size_t(count));
    }
  }
  /// Reads until `enough(text)`, the end, or nothing came for `seconds`. The end sets closed().
  template <class Enough>
  std::string read(const Enough& enough, double seconds = 5) {
    std::string text;
    std::array<char, 65536> block{};
    while (!enough(text)) {
      pollfd ready{handle_, POLLIN, 0};
      if (poll(&ready, 1, int(seconds * 1000)) <= 0) break;
      const ssize_t count = recv(handle_, block.data(), block.size(), 0);
      if (count <= 0) {
        closed_ = true;
        break;
      }
      text.append(block.data(), std::size_t(count));
    }
    return text;
  }
  /// Reads to the end.
  std::string read_all(double seconds = 5) {
    return read([](const std::string&) { return false; }, seconds);
  }
  bool closed() const { return closed_; }

 private:
  int handle_;
  bool open_ = false, closed_ = false;
};

/// Another server: answers whatever is asked for with one page.
class OnePage {
 public:
  explicit OnePage(std::string html)
      : html_(std::move(html)), handle_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const bool open = bind(handle_, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                      listen(handle_, 8) == 0 &&
                      getsockname(handle_, reinterpret_cast<sockaddr*>(&address), &size) == 0;
    if (open) port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~OnePage() {
    shutdown(handle_, SHUT_RDWR);
    thread_.join();
    close(handle_);
  }
  OnePage(const OnePage&) = delete;
  OnePage& operator=(const OnePage&) = delete;

  /// "http://127.0.0.1:PORT"
  std::string origin() const { return "http://127.0.0.1:" + std::to_string(port_); }
  void set(std::string html) { html_ = std::move(html); }  ///< before it is asked for

 private:
  void serve() {
    for (int client = 0; (client = accept(handle_, nullptr, nullptr)) >= 0; close(client)) {
      std::array<char, 4096> request{};
      if (recv(client, request.data(), request.size(), 0) <= 0) continue;
      const std::string answer =
          "HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\nConnection: close\r\n"
          "Content-Length: " +
          std::to_string(html_.size()) + "\r\n\r\n" + html_;
      (void)!::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
      shutdown(client, SHUT_WR);
    }
  }

  std::string html_;
  int handle_;
  int port_ = 0;
  std::thread thread_;
};

inline int port_of(const std::string& address) {
  return std::stoi(address.substr(address.rfind(':') + 1));
}

inline std::string get(int port, const std::string& path, const std::string& headers = "") {
  Connection connection(port);
  connection.send("GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                  "\r\nConnection: close\r\n" + headers + "\r\n");
  return connection.read_all();
}

/// The answer to any request, whole: `request` is what stands in front of the empty line.
inline std::string ask(int port, const std::string& request, const char* from = nullptr) {
  Connection connection(port, 0, from);
  connection.send(request + "Connection: close\r\n\r\n");
  return connection.read_all();
}

/// The request that opens a WebSocket.
inline std::string upgrade(int port, const std::string& path, const std::string& headers = "") {
  return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
         headers + "\r\n";
}

inline int status_of(const std::string& response) {
  return response.compare(0, 5, "HTTP/") == 0 ? std::stoi(response.substr(9, 3)) : 0;
}

/// Value of a header, in the spelling of the server; empty: absent.
inline std::string header_of(const std::string& response, const std::string& name) {
  const std::size_t at = response.find("\r\n" + name + ": "), begin = at + name.size() + 4;
  if (at == std::string::npos || at > response.find("\r\n\r\n")) return {};
  return response.substr(begin, response.find("\r\n", begin) - begin);
}

/// Status of a WebSocket that is asked for with these headers and closed again.
inline int status_of_socket(int port, const std::string& path, const std::string& headers = "") {
  Connection socket(port);
  socket.send(upgrade(port, path, headers));
  const std::string text = socket.read([](const std::string& got) { return got.size() > 12; }, 5);
  return text.compare(0, 5, "HTTP/") == 0 ? std::stoi(text.substr(9, 3)) : 0;
}

inline std::string body_of(const std::string& response) {
  const std::size_t end = response.find("\r\n\r\n");
  return end == std::string::npos ? std::string() : response.substr(end + 4);
}

}  // namespace animeme::test

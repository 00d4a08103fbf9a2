// A stand-in for a server of WHIP: takes one offer at a time and answers what it is told to.
// Source: RFC 9725, section 4.2.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace animeme::test {

class WhipServer {
 public:
  explicit WhipServer(std::string token) : token_(std::move(token)) {
    handle_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)bind(handle_, reinterpret_cast<sockaddr*>(&own), sizeof own);
    listen(handle_, 8);
    thread_ = std::thread([this] { run(); });
  }
  ~WhipServer() {
    over_ = true;
    changed_.notify_all();
    thread_.join();
    close(handle_);
  }
  WhipServer(const WhipServer&) = delete;
  WhipServer& operator=(const WhipServer&) = delete;

  int port() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(handle_, reinterpret_cast<sockaddr*>(&own), &size);
    return ntohs(own.sin_port);
  }
  /// What was posted, empty: nothing in time.
  std::string offer() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(20), [this] { return !offer_.empty(); });
    return offer_;
  }
  void answer(std::string sdp) {
    const std::lock_guard lock(mutex_);
    answer_ = std::move(sdp);
    changed_.notify_all();
  }
  /// The path of the DELETE.
  std::string deleted() {
    const std::lock_guard lock(mutex_);
    return deleted_;
  }

 private:
  void run() {
    while (!over_) {
      pollfd ready{handle_, POLLIN, 0};
      if (poll(&ready, 1, 20) <= 0) continue;
      const int client = accept4(handle_, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0) continue;
      const std::string reply = reply_to(read_request(client));
      (void)send(client, reply.data(), reply.size(), MSG_NOSIGNAL);
      close(client);
    }
  }

  static std::string read_request(int client) {
    std::string text;
    std::array<char, 65536> block{};
    for (;;) {
      const std::size_t end = text.find("\r\n\r\n"), length = text.find("Content-Length: ");
      if (end != text.npos) {
        const std::size_t size = length < end ? std::stoul(text.substr(length + 16)) : 0;
        if (text.size() >= end + 4 + size) return text;
      }
      const ssize_t count = recv(client, block.data(), block.size(), 0);
      if (count <= 0) return text;
      text.append(block.data(), std::size_t(count));
    }
  }

  std::string reply_to(const std::string& request) {
    if (request.find("\r\nAuthorization: Bearer " + token_ + "\r\n") == request.npos) {
      return "HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    }
    std::unique_lock lock(mutex_);
    if (request.starts_with("DELETE ")) {
      deleted_ = request.substr(7, request.find(' ', 7) - 7);
      return "HTTP/1.1 200 OK\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    }
    if (!request.starts_with("POST ") ||
        request.find("\r\nContent-Type: application/sdp\r\n") == request.npos) {
      return "HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    }
    const std::string path = request.substr(5, request.find(' ', 5) - 5);
    offer_ = request.substr(request.find("\r\n\r\n") + 4);
    changed_.notify_all();
    changed_.wait_for(lock, std::chrono::seconds(20), [this] { return !answer_.empty() || over_; });
    return "HTTP/1.1 201 Created\r\nContent-Type: application/sdp\r\nLocation: " + path +
           "/1\r\nContent-Length: " + std::to_string(answer_.size()) +
           "\r\nConnection: close\r\n\r\n" + answer_;
  }

  const std::string token_;
  int handle_ = -1;
  std::atomic<bool> over_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string offer_, answer_, deleted_;
  std::thread thread_;
};

}  // namespace animeme::test

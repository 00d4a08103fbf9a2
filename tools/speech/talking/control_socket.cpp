#include "tools/speech/talking/control_socket.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "tools/formats/common/json.h"
#include "tools/speech/talking/line_cutter_internal.h"
#include "tools/speech/talking/pieces.h"

namespace animeme::speech {

namespace {

constexpr std::size_t kMostClients = 16;
constexpr int kBacklog = 8;

Error not_there(const std::string& path, const std::string& why) {
  return make_error(Code::io, "no control socket can be made: " + why).in_file(path);
}

bool connects(int handle, const sockaddr_un& address) {
  return ::connect(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

// Removes the socket of a process that has ended.
Result<void> make_room(const std::string& path, const sockaddr_un& address) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) != 0) return {};
  if (!S_ISSOCK(there.st_mode)) return not_there(path, "there is a file of another kind");
  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const bool used = probe >= 0 && (connects(probe, address) || errno != ECONNREFUSED);
  if (probe >= 0) ::close(probe);
  if (used) return not_there(path, "another program listens there");
  if (::unlink(path.c_str()) != 0) return not_there(path, std::strerror(errno));
  return {};
}

}  // namespace

struct ControlSocket::Client {
  int handle;
  LineCutter cutter{kMostPiece, false};
  bool broken = false;
};

ControlSocket::ControlSocket(std::string path, int listener)
    : path_(std::move(path)), listener_(listener) {
  struct stat there {};
  if (::lstat(path_.c_str(), &there) == 0) file_ = there.st_ino;
}

ControlSocket::~ControlSocket() {
  for (const Client& client : clients_) ::close(client.handle);
  ::close(listener_);
  struct stat there {};
  if (::lstat(path_.c_str(), &there) == 0 && there.st_ino == file_) ::unlink(path_.c_str());
}

Result<std::unique_ptr<ControlSocket>> ControlSocket::open(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return make_error(Code::invalid_argument, "the path of a control socket has 1 to " +
                                                  std::to_string(sizeof address.sun_path - 1) +
                                                  " bytes; use a shorter one")
        .in_file(path);
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  if (auto ok = make_room(path, address); !ok) return ok.error();
  const int handle = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (handle < 0) return not_there(path, std::strerror(errno));
  // The mode of the handle is that of the file, so that there is no moment for others.
  const bool listens = ::fchmod(handle, 0600) == 0 &&
                       ::bind(handle, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
                       ::chmod(path.c_str(), 0600) == 0 && ::listen(handle, kBacklog) == 0;
  if (!listens) {
    const std::string why = std::strerror(errno);
    ::close(handle);
    return not_there(path, why);
  }
  return std::unique_ptr<ControlSocket>(new ControlSocket(path, handle));
}

void ControlSocket::add_to(std::vector<pollfd>& wanted) {
  wanted.push_back({listener_, POLLIN, 0});
  const std::lock_guard lock(mutex_);
  for (const Client& client : clients_) wanted.push_back({client.handle, POLLIN, 0});
}

void ControlSocket::enter() {
  const int handle = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (handle < 0) return;
  const std::lock_guard lock(mutex_);
  if (clients_.size() >= kMostClients) {
    ::close(handle);
    return;
  }
  clients_.emplace_back(Client{.handle = handle});
}

void ControlSocket::read(const std::vector<pollfd>& ready,
                         const std::function<Result<void>(std::string)>& take) {
  const auto came = [&ready](int handle) {
    for (const pollfd& one : ready) {
      if (one.fd == handle) return one.revents != 0;
    }
    return false;
  };
  // The list changes in this thread alone; tell() reads it and marks who is broken.
  for (auto client = clients_.begin(); client != clients_.end();) {
    const bool over = came(client->handle) && !read_from(*client, take);
    const std::lock_guard lock(mutex_);
    if (over || client->broken) {
      ::close(client->handle);
      client = clients_.erase(client);
    } else {
      ++client;
    }
  }
  if (came(listener_)) enter();
}

bool ControlSocket::read_from(Client& client,
                              const std::function<Result<void>(std::string)>& take) {
  const auto give = [&](std::string line) {
    const Result<void> taken = take(std::move(line));
    if (taken) return;
    const tools::Json json = {{"event", "error"}, {"why", taken.error().describe()}};
    const std::lock_guard lock(mutex_);
    send(client, json.dump());
  };
  std::array<char, 65536> buffer;
  const ssize_t count = ::recv(client.handle, buffer.data(), buffer.size(), 0);
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  for (std::string& line : client.cutter.push({buffer.data(), std::size_t(count)})) {
    give(std::move(line));
  }
  if (count == 0) give(client.cutter.rest());  // a last line without its end counts
  return count > 0;
}

// With the lock.
bool ControlSocket::send(Client& client, const std::string& line) {
  if (client.broken) return false;
  const std::string text = line + "\n";
  const ssize_t sent = ::send(client.handle, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent == ssize_t(text.size())) return true;
  client.broken = true;
  ::shutdown(client.handle, SHUT_RDWR);  // which wakes the reader
  return false;
}

void ControlSocket::tell(const std::string& line) {
  const std::lock_guard lock(mutex_);
  for (Client& client : clients_) send(client, line);
}

}  // namespace animeme::speech

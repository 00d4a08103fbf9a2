#include "tools/app/batch/workers.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

#include "tools/formats/programs/children.h"

namespace animeme::batch {

namespace {

bool send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(std::size_t(count));
  }
  return true;
}

bool receive_all(int socket, char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::recv(socket, bytes, size, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= std::size_t(count);
  }
  return true;
}

bool send_message(int socket, std::string_view message) {
  const std::uint64_t size = message.size();
  return send_all(socket, {reinterpret_cast<const char*>(&size), sizeof size}) &&
         send_all(socket, message);
}

bool receive_message(int socket, std::string& message) {
  std::uint64_t size = 0;
  if (!receive_all(socket, reinterpret_cast<char*>(&size), sizeof size)) return false;
  message.resize(size);
  return receive_all(socket, message.data(), message.size());
}

// Ctrl-C goes to the whole group: what runs is finished all the same. It ends with its parent.
[[noreturn]] void serve(int socket, int parent, std::size_t worker, const Workers::Work& work) {
  sigset_t blocked;
  sigemptyset(&blocked);
  for (const int one : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&blocked, one);
  ::sigprocmask(SIG_BLOCK, &blocked, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (null >= 0) ::dup2(null, STDIN_FILENO);
  std::string message;
  int code = 0;
  try {
    while (code == 0 && receive_message(socket, message)) {
      code = send_message(socket, work(message, worker)) ? 0 : 1;
    }
  } catch (const std::exception&) {
    code = 1;
  }
  ::_exit(code);
}

}  // namespace

Workers::~Workers() {
  for (One& one : all_) stop(one);
}

std::optional<std::size_t> Workers::idle() const {
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!all_[i].busy) return i;
  }
  return std::nullopt;
}

bool Workers::busy() const {
  for (const One& one : all_) {
    if (one.busy) return true;
  }
  return false;
}

Result<void> Workers::start(std::size_t worker) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return make_error(Code::io, std::string("no worker can be started: ") + std::strerror(errno));
  }
  std::cout.flush();
  std::fflush(nullptr);
  const int parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    // Theirs are not ours: one that keeps a socket open would hide the end of its neighbour.
    for (const One& one : all_) {
      if (one.socket >= 0) ::close(one.socket);
    }
    ::close(ends[0]);
    serve(ends[1], parent, worker, work_);
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return make_error(Code::io, std::string("no worker can be started: ") + std::strerror(errno));
  }
  all_[worker] = {child, ends[0], false};
  return {};
}

std::string Workers::stop(One& one) {
  if (one.pid == 0) return {};
  ::close(one.socket);
  int status = 0;
  while (::waitpid(one.pid, &status, 0) < 0 && errno == EINTR) {
  }
  one = {};
  return WIFSIGNALED(status) ? "crashed by " + tools::signal_text(WTERMSIG(status)) : "ended early";
}

Result<void> Workers::give(std::size_t worker, std::string_view message) {
  if (all_[worker].pid == 0) {
    if (auto started = start(worker); !started) return started;
  }
  all_[worker].busy = true;  // one that has gone is told by wait()
  send_message(all_[worker].socket, message);
  return {};
}

std::optional<Workers::Answer> Workers::wait(int milliseconds) {
  std::vector<pollfd> looked;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!all_[i].busy) continue;
    looked.push_back({all_[i].socket, POLLIN, 0});
    which.push_back(i);
  }
  if (looked.empty() || ::poll(looked.data(), looked.size(), milliseconds) <= 0) return {};
  for (std::size_t i = 0; i < looked.size(); ++i) {
    if (looked[i].revents == 0) continue;
    One& one = all_[which[i]];
    Answer answer{which[i], {}, {}};
    one.busy = false;
    if (!receive_message(one.socket, answer.message)) answer.crash = stop(one);
    return answer;
  }
  return {};
}

}  // namespace animeme::batch

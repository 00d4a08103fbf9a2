#include "tools/voice/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace animeme::voice {
namespace {

constexpr std::uint32_t kDone = 0xFFFFFFFF;  // tag of the child's last message
constexpr std::uint32_t kMaxMessage = 1u << 26;

struct Header {
  std::uint32_t tag = 0, size = 0;
};

/// Calls ::read or ::write until all of `data` is through.
template <class Call, class Byte>
bool transfer(Call call, int descriptor, Byte* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = call(descriptor, data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data += count;
    size -= std::size_t(count);
  }
  return true;
}

[[noreturn]] void run_and_exit(int descriptor, unsigned seconds,
                               const std::function<bool(Sender&)>& work) {
  ::signal(SIGALRM, SIG_DFL);
  ::signal(SIGPIPE, SIG_DFL);
  ::alarm(seconds);
  const int null = ::open("/dev/null", O_RDWR);
  if (null >= 0) {  // whatever the library prints is not ours to show
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
  }
  Sender sender(descriptor);
  const bool good = work(sender) && sender.send(kDone, {});
  ::_exit(good ? 0 : 1);
}

enum class Outcome { done, stopped, broken };

Outcome listen(int descriptor, const std::function<bool(std::uint32_t, std::string)>& receive) {
  for (;;) {
    Header header;
    if (!transfer(::read, descriptor, reinterpret_cast<char*>(&header), sizeof header)) break;
    if (header.tag == kDone) return Outcome::done;
    if (header.size > kMaxMessage) break;
    std::string bytes(header.size, '\0');
    if (!transfer(::read, descriptor, bytes.data(), bytes.size())) break;
    if (!receive(header.tag, std::move(bytes))) return Outcome::stopped;
  }
  return Outcome::broken;
}

// How the child ended, for people; it is unknown where the program ignores SIGCHLD.
std::string wait_for(pid_t child) {
  int status = 0;
  pid_t result = -1;
  do {
    result = ::waitpid(child, &status, 0);
  } while (result < 0 && errno == EINTR);
  if (result != child) return "ended early";
  if (!WIFSIGNALED(status)) return "failed";
  return WTERMSIG(status) == SIGALRM ? "took too long" : "crashed";
}

}  // namespace

bool Sender::send(std::uint32_t tag, std::string_view bytes) {
  const Header header{tag, std::uint32_t(bytes.size())};
  return bytes.size() <= kMaxMessage &&
         transfer(::write, descriptor_, reinterpret_cast<const char*>(&header), sizeof header) &&
         transfer(::write, descriptor_, bytes.data(), bytes.size());
}

Result<void> run_child(std::string_view what, unsigned seconds,
                       const std::function<bool(Sender&)>& work,
                       const std::function<bool(std::uint32_t, std::string)>& receive) {
  std::array<int, 2> ends{};
  const auto refuse = [&](std::string_view how) {
    return make_error(Code::io, std::string(what) + " " + std::string(how));
  };
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return refuse(std::string("cannot be started: ") + std::strerror(errno));
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    run_and_exit(ends[1], seconds, work);
  }
  const int fork_error = errno;
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return refuse(std::string("cannot be started: ") + std::strerror(fork_error));
  }
  const Outcome outcome = listen(ends[0], receive);
  ::close(ends[0]);
  if (outcome == Outcome::stopped) ::kill(child, SIGKILL);
  const std::string how = wait_for(child);
  return outcome == Outcome::broken ? Result<void>(refuse(how)) : Result<void>();
}

}  // namespace animeme::voice

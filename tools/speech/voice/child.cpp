#include "tools/speech/voice/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "tools/formats/files/cost.h"

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

// Whatever the library prints is not ours to show.
void be_silent() {
  const int null = ::open("/dev/null", O_RDWR);
  if (null < 0) return;
  ::dup2(null, STDOUT_FILENO);
  ::dup2(null, STDERR_FILENO);
}

[[noreturn]] void run_and_exit(int descriptor, unsigned seconds,
                               const std::function<bool(Sender&)>& work) {
  ::signal(SIGALRM, SIG_DFL);
  ::signal(SIGPIPE, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody is left to hear it
  ::alarm(seconds);
  be_silent();
  // Libraries call exit(), where what the parent has registered would be done a second time.
  std::atexit([] { ::_exit(1); });
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

const char* text_of(int status) {
  if (!WIFSIGNALED(status)) return "failed";
  return WTERMSIG(status) == SIGALRM ? "took too long" : "crashed";
}

// How the child ended, for people; it is unknown where the program ignores SIGCHLD.
std::string wait_for(pid_t child) {
  int status = 0;
  pid_t result = -1;
  do {
    result = ::waitpid(child, &status, 0);
  } while (result < 0 && errno == EINTR);
  return result != child ? "ended early" : text_of(status);
}

// What a kept child says of a copy that has ended.
struct CopyEnd {
  std::int32_t status = 0;
  double cpu_seconds = 0;
};

// A message of the size of a request and one descriptor: the end of a pipe for the answers.
struct RequestHead {
  std::uint64_t size = 0;
  iovec part{&size, sizeof size};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};

  explicit RequestHead(std::uint64_t bytes) : size(bytes) {
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
  }
  RequestHead(const RequestHead&) = delete;  // points into itself
};

// The head, then the bytes.
bool send_request(int socket, std::string_view request, int descriptor) {
  RequestHead sent(request.size());
  cmsghdr* head = CMSG_FIRSTHDR(&sent.message);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_RIGHTS;
  head->cmsg_len = CMSG_LEN(sizeof descriptor);
  std::memcpy(CMSG_DATA(head), &descriptor, sizeof descriptor);
  const auto send = [](int to, const char* data, std::size_t count) {
    return ::send(to, data, count, MSG_NOSIGNAL);
  };
  return ::sendmsg(socket, &sent.message, MSG_NOSIGNAL) == ssize_t(sizeof sent.size) &&
         transfer(send, socket, request.data(), request.size());
}

bool receive_request(int socket, std::string& request, int& descriptor) {
  RequestHead received(0);
  ssize_t got = -1;
  do {
    got = ::recvmsg(socket, &received.message, MSG_CMSG_CLOEXEC | MSG_WAITALL);
  } while (got < 0 && errno == EINTR);
  const bool whole = got == ssize_t(sizeof received.size);
  const cmsghdr* head = whole ? CMSG_FIRSTHDR(&received.message) : nullptr;
  if (head == nullptr || head->cmsg_type != SCM_RIGHTS) return false;
  std::memcpy(&descriptor, CMSG_DATA(head), sizeof descriptor);
  request.resize(received.size);
  return transfer(::read, socket, request.data(), request.size());
}

double seconds_of(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

// In a new child, which keeps nothing of its parent but a socket.
void isolate(int socket) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it holds the pipe that shows whether its parent is alive
  ::close_range(STDERR_FILENO + 1, unsigned(socket) - 1, 0);
  ::close_range(unsigned(socket) + 1, ~0U, 0);
  be_silent();
}

[[noreturn]] void stay(int socket, const std::function<void()>& prepare,
                       const KeptChild::Work& work, unsigned seconds) {
  isolate(socket);
  prepare();
  std::string request;
  int descriptor = -1;
  while (receive_request(socket, request, descriptor)) {
    const pid_t copy = ::fork();
    if (copy == 0) {
      ::close(socket);
      run_and_exit(descriptor, seconds, [&](Sender& sender) { return work(sender, request); });
    }
    ::close(descriptor);
    CopyEnd end{1, 0};
    rusage used{};
    pid_t ended = -1;
    do {
      ended = copy < 0 ? copy : ::wait4(copy, &end.status, 0, &used);
    } while (copy > 0 && ended < 0 && errno == EINTR);
    end.cpu_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    if (!transfer(::write, socket, reinterpret_cast<const char*>(&end), sizeof end)) break;
  }
  ::_exit(0);
}

Error refused(std::string_view what, std::string_view how) {
  return make_error(Code::io, std::string(what) + " " + std::string(how));
}

Error not_started(std::string_view what, int error) {
  return refused(what, std::string("cannot be started: ") + std::strerror(error));
}

struct Forked {
  pid_t pid = -1;
  int socket = -1;  // to the child
};

// A child that runs `in_child` with its end of a socket and never returns from it.
Result<Forked> fork_with_socket(std::string_view what, const std::function<void(int)>& in_child) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return not_started(what, errno);
  }
  const pid_t pid = ::fork();
  if (pid == 0) in_child(ends[1]);
  const int fork_error = errno;
  ::close(ends[1]);
  if (pid > 0) return Forked{pid, ends[0]};
  ::close(ends[0]);
  return not_started(what, fork_error);
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
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return not_started(what, errno);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    run_and_exit(ends[1], seconds, work);
  }
  const int fork_error = errno;
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return not_started(what, fork_error);
  }
  const Outcome outcome = listen(ends[0], receive);
  ::close(ends[0]);
  if (outcome == Outcome::stopped) ::kill(child, SIGKILL);
  const std::string how = wait_for(child);
  return outcome == Outcome::broken ? Result<void>(refused(what, how)) : Result<void>();
}

Result<std::unique_ptr<KeptChild>> KeptChild::start(const std::function<void()>& prepare,
                                                    const Work& work, unsigned seconds) {
  const auto forked =
      fork_with_socket("a child", [&](int socket) { stay(socket, prepare, work, seconds); });
  if (!forked) return forked.error();
  return std::unique_ptr<KeptChild>(new KeptChild(forked->pid, forked->socket));
}

KeptChild::~KeptChild() {
  ::close(socket_);
  if (pid_ > 0) wait_for(pid_);
}

Result<std::unique_ptr<Nursery>> Nursery::start(
    const std::function<void(std::string_view name)>& prepare, const KeptChild::Work& work,
    unsigned seconds) {
  const auto forked = fork_with_socket("a process for voices", [&](int requests) {
    isolate(requests);
    ::signal(SIGCHLD, SIG_IGN);  // exit codes of children are not read
    std::string name;
    for (int socket = -1; receive_request(requests, name, socket); ::close(socket)) {
      if (::fork() != 0) continue;
      ::signal(SIGCHLD, SIG_DFL);
      stay(
          socket, [&] { prepare(name); }, work, seconds);
    }
    ::_exit(0);
  });
  if (!forked) return forked.error();
  return std::unique_ptr<Nursery>(new Nursery(forked->pid, forked->socket));
}

Nursery::~Nursery() {
  ::close(socket_);
  wait_for(pid_);
}

Result<std::unique_ptr<KeptChild>> Nursery::child(std::string_view name) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return not_started("a child", errno);
  }
  const bool sent = send_request(socket_, name, ends[1]);
  ::close(ends[1]);
  std::unique_ptr<KeptChild> child(new KeptChild(-1, ends[0]));
  if (!sent) return refused("a process for voices", "ended early");
  return child;
}

Result<void> KeptChild::run(std::string_view what, std::string_view request,
                            const std::function<bool(std::uint32_t, std::string)>& receive) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return not_started(what, errno);
  const bool sent = send_request(socket_, request, ends[1]);
  ::close(ends[1]);
  const Outcome outcome = sent ? listen(ends[0], receive) : Outcome::broken;
  ::close(ends[0]);  // a copy that still writes ends by SIGPIPE
  CopyEnd end;
  if (!sent || !transfer(::read, socket_, reinterpret_cast<char*>(&end), sizeof end)) {
    return refused(what, "ended early");
  }
  tools::add_cpu_seconds(end.cpu_seconds);
  return outcome == Outcome::broken ? Result<void>(refused(what, text_of(end.status)))
                                    : Result<void>();
}

}  // namespace animeme::voice

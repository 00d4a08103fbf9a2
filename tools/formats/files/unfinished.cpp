#include "tools/formats/files/unfinished.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace animeme::tools {

namespace {

// A handler may read these at any moment, so nothing is allocated and nothing moves.
enum class SlotState : int { free, changing, noted };
struct Slot {
  std::atomic<SlotState> state = SlotState::free;
  pid_t owner = 0;
  std::array<char, 4096> path{};
};
std::array<Slot, 64> slots;
static_assert(std::atomic<SlotState>::is_always_lock_free);

constexpr int kDeepest = 8;  // folders in folders

// opendir() allocates, which a handler may not.
void remove_folder(int parent, const char* path, int depth) {
  const int folder = ::openat(parent, path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return;
  alignas(dirent64) char block[4096];
  for (;;) {
    const ssize_t count = ::getdents64(folder, block, sizeof block);
    if (count <= 0) break;
    for (ssize_t at = 0; at < count;) {
      const auto* entry = reinterpret_cast<const dirent64*>(block + at);
      at += entry->d_reclen;
      const char* name = entry->d_name;
      if (std::strcmp(name, ".") == 0 || std::strcmp(name, "..") == 0) continue;
      if (::unlinkat(folder, name, 0) != 0 && depth > 1) remove_folder(folder, name, depth - 1);
    }
  }
  ::close(folder);
  ::unlinkat(parent, path, AT_REMOVEDIR);
}

void clean_up_and_end(int signal_number) {
  const int kept = errno;
  remove_unfinished();
  errno = kept;
  ::raise(signal_number);  // SA_RESETHAND: now it does what it always does
}

}  // namespace

std::size_t note_unfinished(const std::string& path) {
  if (path.size() >= Slot().path.size()) return 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    SlotState expected = SlotState::free;
    if (!slots[i].state.compare_exchange_strong(expected, SlotState::changing)) continue;
    slots[i].owner = ::getpid();
    std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
    slots[i].state = SlotState::noted;
    return i + 1;
  }
  return 0;
}

void forget_unfinished(std::size_t note) {
  if (note != 0) slots[note - 1].state = SlotState::free;
}

void remove_unfinished() {
  for (Slot& slot : slots) {
    if (slot.state != SlotState::noted || slot.owner != ::getpid()) continue;
    if (::unlink(slot.path.data()) != 0) remove_folder(AT_FDCWD, slot.path.data(), kDeepest);
  }
}

void clean_up_on_signals() {
  std::atexit(remove_unfinished);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXFSZ, SIGXCPU, SIGABRT,
                           SIGSEGV, SIGBUS, SIGFPE, SIGILL}) {
    struct sigaction now = {};
    if (::sigaction(number, nullptr, &now) != 0) continue;
    if ((now.sa_flags & SA_SIGINFO) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction action = {};
    action.sa_handler = clean_up_and_end;
    action.sa_flags = int(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    ::sigaction(number, &action, nullptr);
  }
}

}  // namespace animeme::tools

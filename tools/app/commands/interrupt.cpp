#include "tools/app/commands/interrupt.h"

#include <signal.h>

#include <atomic>
#include <csignal>

#include "tools/formats/files/unfinished.h"

namespace animeme::tools {

namespace {

std::atomic<int> noted = 0;  // the signal
int living = 0;
struct sigaction old_interrupt, old_terminate, old_pipe;

// The second one does what it always does.
void note(int signal_number) {
  if (noted.exchange(signal_number) == 0) return;
  remove_unfinished();
  ::signal(signal_number, SIG_DFL);
  ::raise(signal_number);
}

}  // namespace

Interrupt::Interrupt() {
  if (living++ > 0) return;
  noted = 0;
  struct sigaction action = {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_interrupt);
  sigaction(SIGTERM, &action, &old_terminate);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, &old_pipe);
}

Interrupt::~Interrupt() {
  if (--living > 0) return;
  sigaction(SIGINT, &old_interrupt, nullptr);
  sigaction(SIGTERM, &old_terminate, nullptr);
  sigaction(SIGPIPE, &old_pipe, nullptr);
}

bool Interrupt::requested() { return noted != 0; }

bool Interrupt::terminated() { return noted == SIGTERM; }

}  // namespace animeme::tools

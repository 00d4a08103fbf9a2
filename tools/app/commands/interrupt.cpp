#include "tools/app/commands/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

#include "tools/formats/files/unfinished.h"

namespace animeme::tools {

namespace {

std::atomic<int> noted = 0;  // the signal
std::atomic<unsigned> grace_seconds = 0;
int living = 0;
std::atomic<bool> hung_up = false;
struct sigaction old_hangup;
struct sigaction old_interrupt, old_terminate, old_pipe, old_alarm;

void end_by(int signal_number) {
  remove_unfinished();
  ::signal(signal_number, SIG_DFL);
  ::raise(signal_number);
}

// The second one does what it always does.
void note(int signal_number) {
  if (noted.exchange(signal_number) != 0) return end_by(signal_number);
  if (grace_seconds > 0) ::alarm(grace_seconds);
}

void note_hangup(int) { hung_up = true; }

void end_of_grace(int) { end_by(noted != 0 ? int(noted) : SIGTERM); }

}  // namespace

Interrupt::Interrupt(unsigned grace) {
  if (living++ > 0) return;
  noted = 0;
  grace_seconds = grace;
  struct sigaction action = {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_interrupt);
  sigaction(SIGTERM, &action, &old_terminate);
  action.sa_handler = end_of_grace;
  sigaction(SIGALRM, &action, &old_alarm);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, &old_pipe);
}

Interrupt::~Interrupt() {
  if (--living > 0) return;
  if (grace_seconds > 0) ::alarm(0);
  sigaction(SIGALRM, &old_alarm, nullptr);
  sigaction(SIGINT, &old_interrupt, nullptr);
  sigaction(SIGTERM, &old_terminate, nullptr);
  sigaction(SIGPIPE, &old_pipe, nullptr);
}

Hangup::Hangup() {
  hung_up = false;
  struct sigaction action = {};
  action.sa_handler = note_hangup;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGHUP, &action, &old_hangup);
}

Hangup::~Hangup() { sigaction(SIGHUP, &old_hangup, nullptr); }

bool Hangup::taken() { return hung_up.exchange(false); }

bool Interrupt::requested() { return noted != 0; }

bool Interrupt::terminated() { return noted == SIGTERM; }

}  // namespace animeme::tools

#include "tools/commands/interrupt.h"

#include <csignal>

namespace animeme::tools {

namespace {

volatile std::sig_atomic_t g_requested = 0;

struct sigaction g_before_int, g_before_term;

void on_signal(int) { g_requested = 1; }

}  // namespace

Interrupt::Interrupt() {
  g_requested = 0;
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  // Waiting calls return, and the second signal finds the default action.
  action.sa_flags = int(SA_RESETHAND);
  sigaction(SIGINT, &action, &g_before_int);
  sigaction(SIGTERM, &action, &g_before_term);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &g_before_int, nullptr);
  sigaction(SIGTERM, &g_before_term, nullptr);
}

bool Interrupt::requested() { return g_requested != 0; }

}  // namespace animeme::tools

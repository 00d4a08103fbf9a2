// Ctrl-C as a wish to end well: for commands that run until they are told to stop.
#pragma once

namespace animeme::tools {

/// While it lives, the first SIGINT or SIGTERM sets a flag in place of ending the program, so that
/// a recording can be closed and goodbye be said; the second one ends the program at once. One at a
/// time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// True once a signal came.
  static bool requested();
};

}  // namespace animeme::tools

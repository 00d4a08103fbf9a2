/// @file
/// Ctrl-C while something is being written or sent.
///
///     Interrupt interrupt;
///     while (!Interrupt::requested()) ...
///     if (Interrupt::requested()) return kInterrupted;
#pragma once

namespace animeme::tools {

/// While one lives, the first SIGINT or SIGTERM is only noted, so that the work can be brought to
/// a clean end; the second one ends the program at once, and so does a grace that is over: a wait
/// that nothing else ends, such as for a reader of a full pipe, ends then. SIGPIPE is ignored, so
/// that a reader that goes away is an error of writing. What was set before comes back with the
/// last of them. For the main thread.
class Interrupt {
 public:
  /// `grace`: seconds from the first signal to the end of the program; 0: no limit.
  explicit Interrupt(unsigned grace = 0);
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Has a signal come since the first of them was made? Safe in any thread.
  static bool requested();
  /// Was it SIGTERM, by which service managers end programs? Likewise.
  static bool terminated();
};

/// While one lives, SIGHUP is noted and ends nothing: services read their settings again. For the
/// main thread; one at a time.
class Hangup {
 public:
  Hangup();
  ~Hangup();
  Hangup(const Hangup&) = delete;
  Hangup& operator=(const Hangup&) = delete;

  /// Has one come since the last call?
  static bool taken();
};

/// Grace of programs that run until they are told to end.
inline constexpr unsigned kLiveGrace = 10;

}  // namespace animeme::tools

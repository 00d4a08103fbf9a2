/// @file
/// A function in a forked child process that sends messages to its parent. Internal.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "fap/result.h"

namespace animeme::voice {

/// The child's end: messages are a tag and bytes.
class Sender {
 public:
  /// `descriptor`: of a pipe, stays the caller's.
  explicit Sender(int descriptor) : descriptor_(descriptor) {}
  /// False when the parent no longer listens.
  bool send(std::uint32_t tag, std::string_view bytes);

 private:
  int descriptor_;
};

/// Runs `work` in a forked copy of this process and hands each message to `receive` (in the
/// parent) until the work returns or `receive` returns false. The child ends without running
/// destructors or exit handlers, and after `seconds` at the latest.
///
/// Errors, io: no process can be started; the child crashed, ran too long or returned false.
/// `what` names it in the message. Not an error: receive() stopped it.
Result<void> run_child(std::string_view what, unsigned seconds,
                       const std::function<bool(Sender&)>& work,
                       const std::function<bool(std::uint32_t, std::string)>& receive);

/// A child that has prepared itself and stays: for each request it forks a copy, which works from
/// that same state, so that no request sees what another one left. Not thread safe.
class KeptChild {
 public:
  /// Answers a request through the sender; false: it could not.
  using Work = std::function<bool(Sender&, std::string_view request)>;
  /// `prepare` runs in the child once, `work` in its copies, each for `seconds` at the latest.
  /// Errors: io.
  static Result<std::unique_ptr<KeptChild>> start(const std::function<void()>& prepare,
                                                  const Work& work, unsigned seconds);
  KeptChild(const KeptChild&) = delete;
  ~KeptChild();

  /// As run_child(), for a request; what it costs goes to tools::add_cpu_seconds().
  Result<void> run(std::string_view what, std::string_view request,
                   const std::function<bool(std::uint32_t, std::string)>& receive);

 private:
  friend class Nursery;
  KeptChild(int pid, int socket) : pid_(pid), socket_(socket) {}
  int pid_;  // -1: a child of a nursery
  int socket_;
};

/// A process that starts such children, each a copy of what this program was when the nursery
/// began: small, however large the program is by then. It and they end with the thread that
/// started it. Not thread safe.
class Nursery {
 public:
  /// `prepare` runs in each child once, with the name that it was started by; the rest is as for
  /// KeptChild::start(). Errors: io.
  static Result<std::unique_ptr<Nursery>> start(
      const std::function<void(std::string_view name)>& prepare, const KeptChild::Work& work,
      unsigned seconds);
  Nursery(const Nursery&) = delete;
  ~Nursery();  ///< its children end, too

  /// One more child. Errors: io.
  Result<std::unique_ptr<KeptChild>> child(std::string_view name);

 private:
  Nursery(int pid, int socket) : pid_(pid), socket_(socket) {}
  int pid_, socket_;
};

}  // namespace animeme::voice

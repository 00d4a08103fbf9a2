/// @file
/// A function in a forked child process that sends messages to its parent. Internal.
#pragma once

#include <cstdint>
#include <functional>
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

}  // namespace animeme::voice

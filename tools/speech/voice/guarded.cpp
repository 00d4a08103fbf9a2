#include "tools/speech/voice/guarded.h"

#include <algorithm>
#include <new>

#include "tools/speech/voice/child.h"

namespace animeme::voice {
namespace {

enum GuardTag : std::uint32_t { kGuardedPiece, kGuardedError, kGuardedProgress };

constexpr std::size_t kGuardedBytes = std::size_t(1) << 20;

bool send_error(Sender& sender, const Error& error) {
  Packed packed;
  packed.put(error.code);
  packed.put_text(error.message);
  packed.put_text(error.where.file);
  packed.put(error.where.line);
  packed.put(error.where.column);
  packed.put(error.where.bit);
  return sender.send(kGuardedError, packed.take());
}

Error unpack_error(std::string_view bytes) {
  Unpacked in(bytes);
  Error error;
  error.code = in.get<Code>();
  error.message = in.get_text();
  error.where.file = in.get_text();
  error.where.line = in.get<std::int64_t>();
  error.where.column = in.get<std::int64_t>();
  error.where.bit = in.get<std::int64_t>();
  return error;
}

Error no_memory(std::string_view what) {
  return make_error(Code::io, "there is not enough memory for " + std::string(what) +
                                  "; close other programs, or give a shorter recording");
}

bool send_all(Sender& sender, std::string_view bytes) {
  bool sent = true;
  while (sent && !bytes.empty()) {
    const std::size_t size = std::min(bytes.size(), kGuardedBytes);
    sent = sender.send(kGuardedPiece, bytes.substr(0, size));
    bytes.remove_prefix(size);
  }
  return sent;
}

}  // namespace

Result<std::string> run_guarded(std::string_view what, unsigned seconds,
                                const std::function<Result<std::string>(const Told& tell)>& work,
                                const Told& told) {
  std::string bytes;
  bool failed = false;
  Error error;
  const auto send = [&](Sender& sender) {
    const Told tell = [&sender](double share) {
      Packed packed;
      packed.put(share);
      (void)sender.send(kGuardedProgress, packed.take());
    };
    try {
      const Result<std::string> made = work(tell);
      return made ? send_all(sender, *made) : send_error(sender, made.error());
    } catch (const std::bad_alloc&) {
      return send_error(sender, no_memory(what));
    }
  };
  const auto receive = [&](std::uint32_t tag, std::string piece) {
    if (tag == kGuardedProgress) {
      if (told) told(Unpacked(piece).get<double>());
      return true;
    }
    failed = tag == kGuardedError;
    if (failed) error = unpack_error(piece);
    if (!failed) bytes += piece;
    return !failed;
  };
  const auto run = run_child(what, seconds, send, receive);
  if (failed) return error;
  // Its own words have gone to no log; what ends it is memory.
  if (!run && run.error().message.ends_with("failed")) return no_memory(what);
  if (!run) return run.error();
  return bytes;
}

}  // namespace animeme::voice

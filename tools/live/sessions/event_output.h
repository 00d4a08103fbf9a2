/// @file
/// Writes events of spoken lines to a file, to a control socket, and to receivers whose transport
/// supports events.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/live/sessions/sinks.h"
#include "tools/speech/talking/control_socket.h"
#include "tools/speech/talking/line_events.h"

namespace animeme::live {

/// JSON lines, each flushed immediately.
class EventOutput {
 public:
  /// `path`: a file (overwritten), a pipe, or "-" for standard output; empty: none. The socket,
  /// which may be null, must outlive this. Errors: io (the file cannot be written).
  static Result<EventOutput> open(const std::string& path, speech::ControlSocket* control);

  /// Errors: io (the file, which is not written any more), those of Sinks::tell().
  Result<void> tell(const std::vector<speech::LineEvent>& events, Sinks& sinks);

 private:
  struct Close {
    void operator()(std::FILE* file) const {
      if (file != stdout) std::fclose(file);
    }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  speech::ControlSocket* control_ = nullptr;
};

}  // namespace animeme::live

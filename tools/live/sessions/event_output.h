/// @file
/// Where it is told what becomes of the lines that are spoken: a file, a control socket, and the
/// receivers whose transport has a place for it.
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

/// JSON lines, each of them written out at once.
class EventOutput {
 public:
  /// `path`: a file, which is begun anew, a pipe, or "-" for standard output; empty: none. The
  /// socket, which may be null, must outlive this. Errors: io (the file cannot be written).
  static Result<EventOutput> open(const std::string& path, speech::ControlSocket* control);

  /// Errors: io (the file; from then on nothing goes there), those of Sinks::tell().
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

#include "tools/live/sessions/event_output.h"

#include <cerrno>
#include <cstring>

namespace animeme::live {

Result<EventOutput> EventOutput::open(const std::string& path, speech::ControlSocket* control) {
  EventOutput output;
  output.control_ = control;
  if (path.empty()) return output;
  output.path_ = path;
  output.file_.reset(path == "-" ? stdout : std::fopen(path.c_str(), "we"));
  if (!output.file_) {
    return make_error(Code::io, std::string("cannot be written: ") + std::strerror(errno))
        .in_file(path);
  }
  return output;
}

Result<void> EventOutput::tell(const std::vector<speech::LineEvent>& events, Sinks& sinks) {
  Result<void> all;
  for (const speech::LineEvent& event : events) {
    const std::string line = speech::to_json(event);
    if (control_ != nullptr) control_->tell(line);
    if (auto told = sinks.tell(line); !told) return told;
    if (!file_) continue;
    if (std::fprintf(file_.get(), "%s\n", line.c_str()) >= 0 && std::fflush(file_.get()) == 0)
      continue;
    all = make_error(Code::io,
                     std::string("events cannot be written any more: ") + std::strerror(errno))
              .in_file(path_);
    file_.reset();
  }
  return all;
}

}  // namespace animeme::live

#include "tools/commands/status_line.h"

#include <unistd.h>

#include <iostream>

#include "tools/commands/common.h"

namespace animeme::tools {

StatusLine::StatusLine() : terminal_(::isatty(STDERR_FILENO) != 0) {}

StatusLine::~StatusLine() { clear(); }

void StatusLine::show(const std::string& text) {
  if (!terminal_) return say(text);
  std::cerr << "\r\x1b[K" << text << std::flush;
  shown_ = true;
}

void StatusLine::clear() {
  if (shown_) std::cerr << "\r\x1b[K" << std::flush;
  shown_ = false;
}

}  // namespace animeme::tools

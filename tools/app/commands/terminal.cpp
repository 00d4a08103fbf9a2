#include "tools/app/commands/terminal.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "tools/app/commands/command.h"

namespace animeme::tools {

namespace {

bool quiet_setting = false, verbose_setting = false;

}  // namespace

void set_quiet(bool quiet) { quiet_setting = quiet; }

void set_verbose(bool verbose) { verbose_setting = verbose; }

void warn(const std::string& text) {
  if (!quiet_setting) std::cerr << "animeme: warning: " + text + "\n";
}

void say(const std::string& text) {
  if (!quiet_setting) std::cerr << text + "\n";
}

void say_more(const std::string& text) {
  if (verbose_setting) say(text);
}

Log terminal_log() { return {say, warn}; }

int usage_error(const std::string& text) {
  std::cerr << "animeme: " << text << "\nRun with --help for more information.\n";
  return kUsage;
}

ProgressLine::ProgressLine(std::string what) : what_(std::move(what)) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
  if (shown_) std::cerr << "\r\x1b[K" << std::flush;
  shown_ = false;
}

void ProgressLine::update(double done, const std::string& detail) {
  if (quiet_setting || ::isatty(STDERR_FILENO) == 0) return;
  const int percent = int(100 * std::clamp(done, 0.0, 1.0));
  if (percent == last_percent_ && detail.empty()) return;
  last_percent_ = percent;
  shown_ = true;
  const int filled = percent / 4;
  std::cerr << "\r\x1b[K" << what_ << " [" << std::string(std::size_t(filled), '#')
            << std::string(std::size_t(25 - filled), '.') << "] " << percent << " % " << detail
            << std::flush;
}

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

/// @file
/// What commands say on standard error: talk, warnings, and how far they are.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/formats/files/log.h"

namespace animeme::tools {

/// Prints "animeme: warning: text" on standard error, unless --quiet was given.
void warn(const std::string& text);
/// Prints a line of talk on standard error, unless --quiet was given.
void say(const std::string& text);
/// The same for libraries, which have something to say but do not print.
Log terminal_log();
/// The width of the terminal: of the variable COLUMNS, of standard output, else 80.
int terminal_width();
/// How a command line is reported: the command that usage errors name, and whether errors are
/// also printed as JSON on standard output (--json).
void set_reporting(const std::string& command, bool json);
/// Prints an error on standard error, and as {"error": ...} on standard output if --json was given.
/// Returns the exit code.
int report_error(const Error& error);
/// Set by main() from --quiet.
void set_quiet(bool quiet);
/// Prints a line of talk if --verbose was given, and not --quiet.
void say_more(const std::string& text);
/// Set by main() from --verbose.
void set_verbose(bool verbose);

/// A line on standard error that shows how far long work is; silent if that is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);  ///< `what` stands in front of the bar
  ~ProgressLine();
  /// `done` 0..1; `detail` is shown behind the bar.
  void update(double done, const std::string& detail = {});
  /// Takes the line away, so that something else can be printed.
  void clear();

 private:
  std::string what_;
  bool shown_ = false;
  int last_percent_ = -1;
};

/// One line on standard error that is renewed on a terminal and added to elsewhere.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine();
  /// Replaces the line on a terminal, else prints a further one.
  void show(const std::string& text);
  /// Takes it away from a terminal, so that something else can be printed.
  void clear();

 private:
  bool terminal_;
  bool shown_ = false;
};

}  // namespace animeme::tools

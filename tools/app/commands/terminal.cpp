#include "tools/app/commands/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <utility>

#include "tools/app/commands/command.h"
#include "tools/app/commands/report.h"
#include "tools/formats/common/code_name.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {

namespace {

bool quiet_setting = false, verbose_setting = false, json_setting = false;
std::string current_command;
Json outputs = Json::array(), warnings = Json::array();  // of the command that runs

// One object, so that a script reads one thing whatever happens.
void print_json(const char* code, const std::string& message, const Position& where) {
  if (!json_setting) return;
  Json position = Json::object();
  if (where.line > 0) position["line"] = where.line;
  if (where.column > 0) position["column"] = where.column;
  if (where.bit >= 0) position["bit"] = where.bit;
  Json error = {{"code", code}, {"message", message}};
  if (!where.file.empty()) error["file"] = where.file;
  if (!position.empty()) error["position"] = position;
  std::cout << pretty(Json{{"error", error}}) << "\n";
}

}  // namespace

void set_quiet(bool quiet) { quiet_setting = quiet; }

void set_reporting(const std::string& command, bool json) {
  current_command = command;
  json_setting = json;
  outputs = warnings = Json::array();
}

void set_verbose(bool verbose) { verbose_setting = verbose; }

void warn(const std::string& text) {
  if (json_setting) warnings.push_back(text);
  if (!quiet_setting) std::cerr << "animeme: warning: " + text + "\n";
}

void say(const std::string& text) {
  if (!quiet_setting) std::cerr << text + "\n";
}

void say_more(const std::string& text) {
  if (verbose_setting) say(text);
}

void report_output(const std::string& path, const std::string& text, Json facts) {
  say(name_of_output(path) + ": " + text);
  if (!json_setting) return;
  Json one = {{"output", path}};
  one.update(facts);
  outputs.push_back(one);
}

std::string problem_with_report() {
  return json_setting
             ? "with --json the data cannot go to standard output, too; name a file with -o"
             : "";
}

void report_printed() { json_setting = false; }

std::string report_text() { return pretty(Json{{"outputs", outputs}, {"warnings", warnings}}); }

Log terminal_log() { return {say, warn}; }

// Errors of the user's input and errors of ours have different exit codes.
int report_error(const Error& error) {
  // In one piece, as other processes may write to the same place.
  std::cerr << "animeme: error: " + error.describe() + "\n";
  print_json(code_name(error.code), error.message, error.where);
  return error.code == Code::internal ? kInternal : kBadInput;
}

int usage_error(const std::string& text) {
  print_json("usage", text, {});
  std::cerr << "animeme: " << text << "\nRun 'animeme "
            << (current_command.empty() ? "" : current_command + " ") << "--help'.\n";
  return kUsage;
}

int terminal_width() {
  const char* const columns = std::getenv("COLUMNS");
  const int wanted = columns == nullptr ? 0 : std::atoi(columns);
  winsize size{};
  if (wanted <= 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    return size.ws_col;
  }
  return wanted > 0 ? wanted : 80;
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

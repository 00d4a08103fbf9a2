// What the commands of the program share: files, exit codes, errors, progress.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::tools {

/// Exit codes of the program.
enum ExitCode : int {
  kOk = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kInternal = 4,
};

/// A command puts its options into `app` and returns what is to run when it was chosen: the exit
/// code, or an error that main() prints (exit code 3).
using Action = std::function<Result<int>()>;

/// One command: its name, one line of help, and the function that sets it up. `examples` ends
/// its --help.
struct Command {
  const char* name;
  const char* summary;
  const char* examples;
  Action (*add)(CLI::App& app);
};

extern const Command kAlign, kCheck, kCompare, kDecode, kDemux, kEncode, kEvaluate, kInfo, kMux,
    kPlot, kSpeak, kTrain;

/// Prints a usage error on standard error; returns kUsage for the command to return.
int usage_error(const std::string& text);

/// All bytes of a file, or of standard input for "-". Errors: not_found, io.
Result<std::vector<std::uint8_t>> read_file(const std::string& path);
Result<std::string> read_text_file(const std::string& path);

/// Writes a file whole or not at all (temporary file beside it, then rename); "-" is standard
/// output. Errors: io.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);
Result<void> write_file(const std::string& path, std::string_view text);

/// Extension in lower case with its dot, ".mp4"; "-" gives "".
std::string extension_of(const std::string& path);

/// "standard output" for "-", else the path; for messages.
std::string name_of_output(const std::string& path);

/// Prints "animeme: warning: text" on standard error, unless --quiet was given.
void warn(const std::string& text);
/// Prints a line of talk on standard error, unless --quiet was given.
void say(const std::string& text);
/// Set by main() from --quiet.
void set_quiet(bool quiet);

/// A line on standard error that shows how far long work is; silent if that is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
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

/// What a file holds, told by its content.
enum class FileKind : std::uint8_t { fap_text, fba_stream, model, script, curves, media, unknown };
FileKind kind_of(std::span<const std::uint8_t> bytes);

/// Any input with a face as a clip: .fap text, raw .fba, a container, or a table of curves
/// (time_s, fap3_open_jaw ... as in a corpus). For text, warnings about quirks are printed.
struct FaceInput {
  fap::Sequence clip;
  std::vector<std::uint8_t> stream;  ///< the raw FBA stream; empty for text
};
Result<FaceInput> read_face(const std::string& path);
/// The same from bytes that were read already; `path` is for names and messages.
Result<FaceInput> parse_face(std::vector<std::uint8_t> bytes, const std::string& path);

}  // namespace animeme::tools

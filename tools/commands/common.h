/// @file
/// What the commands of the program share: files, exit codes, errors, progress.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
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
  kInterrupted = 130,  ///< Ctrl-C; what was written is complete as far as it goes
};

/// A command puts its options into `app` and returns what is to run when it was chosen: the exit
/// code, or an error that main() prints (exit code 3).
using Action = std::function<Result<int>()>;

/// One command: its name, one line of help, and the function that sets it up. `examples` ends
/// its --help.
struct Command {
  const char* name;              ///< as typed
  const char* summary;           ///< one line of --help
  const char* examples;          ///< of use, lines with two blanks in front
  Action (*add)(CLI::App& app);  ///< sets options up; what it returns is run
};

/// @{
/// The commands of the program, one file each.
extern const Command kAlign, kCheck, kCompare, kDecode, kDemux, kEncode, kEvaluate, kExport,
    kFollow, kHead, kImport, kInfo, kMux, kPlot, kReceive, kRender, kSpeak, kStats, kStream, kTrain,
    kView;
/// @}

/// Prints a usage error on standard error; returns kUsage for the command to return.
int usage_error(const std::string& text);

/// All bytes of a file, or of standard input for "-". Errors: not_found, io.
Result<std::vector<std::uint8_t>> read_file(const std::string& path);
Result<std::string> read_text_file(const std::string& path);  ///< likewise, as text

/// Writes a file whole or not at all (temporary file beside it, then rename); "-" is standard
/// output. Errors: io.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);
Result<void> write_file(const std::string& path, std::string_view text);  ///< likewise, of a text

/// A file to be written; the text is borrowed.
struct OutputText {
  std::string path;       ///< where to
  std::string_view text;  ///< borrowed
};
/// Writes several files: all of them whole, or none. Errors: io.
Result<void> write_files(std::span<const OutputText> files);

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

/// What a file holds, told by its content.
enum class FileKind : std::uint8_t {
  fap_text,
  bap_text,
  fba_stream,
  model,
  script,
  curves,
  media,
  unknown
};
FileKind kind_of(std::span<const std::uint8_t> bytes);  ///< told by content
/// Is it media in segments (HLS, DASH)? Such a file is to be read by its path, never by its bytes:
/// what it names lies beside it.
bool is_playlist(std::span<const std::uint8_t> bytes);

/// Any input with motion: .fap or .bap text, raw .fba, a container, or a table of curves
/// (time_s, fap3_open_jaw ... as in a corpus; ARKit shapes, see arkit_csv.h). For text, warnings
/// about quirks are printed.
struct MotionInput {
  FileKind kind = FileKind::unknown;  ///< how it was read
  fap::Sequence face;                 ///< no frames: there is no face
  fba::BodySequence body;             ///< no frames: there is no body
  std::vector<std::uint8_t> stream;   ///< the raw FBA stream; empty for text
  fba::DecodedStream decoded;         ///< of the stream; no planes for text
  double start = 0;                   ///< of frame 0, seconds on the clock of a container's sound
};
/// Frame numbers of FAP text start at 0 unless they are to be kept.
enum class FrameNumbers : std::uint8_t { from_zero, keep };
/// "-" is standard input; errors name the path.
Result<MotionInput> read_motion(const std::string& path,
                                FrameNumbers numbers = FrameNumbers::from_zero);
/// The same from bytes that were read already; `path` is for names and messages.
Result<MotionInput> parse_motion(std::vector<std::uint8_t> bytes, const std::string& path,
                                 FrameNumbers numbers = FrameNumbers::from_zero);

/// Any input with a face as a clip.
struct FaceInput {
  fap::Sequence clip;                ///< ascending frame numbers
  std::vector<std::uint8_t> stream;  ///< the raw FBA stream; empty for text
  double start = 0;                  ///< as MotionInput::start
};
/// As read_motion(). A stream or text with a body but no face is not_found.
Result<FaceInput> read_face(const std::string& path);
/// Likewise, from bytes that were read already.
Result<FaceInput> parse_face(std::vector<std::uint8_t> bytes, const std::string& path);
/// The face of an input that was read already, and the check for there being one.
Result<FaceInput> face_of(MotionInput input, const std::string& path);
/// not_found if it has no face.
Result<void> require_face(const MotionInput& input, const std::string& path);

}  // namespace animeme::tools

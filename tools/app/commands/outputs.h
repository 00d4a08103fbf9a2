/// @file
/// Options that name files to be written: which endings fit, and that nothing that is read is
/// written over.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace animeme::tools {

/// Whether an output may be a stream.
enum class OutputKind : unsigned char {
  file,            ///< a file whose ending says what is written, no "-"
  file_or_dash,    ///< likewise, or "-"
  stream,          ///< "-", devices, pipes and names without an ending will do, too
  folder,          ///< a folder, which is made if there is none
  file_or_folder,  ///< a stream, or a folder
};

/// Notes that an option names a file to be written. `endings`: which fit, in lower case, as
/// ".fap"; none: the command looks itself. Help calls its value OUT, or OUT/ if it is a folder.
CLI::Option* add_output(CLI::Option* option, std::vector<std::string> endings,
                        OutputKind kind = OutputKind::stream);

/// The endings of a raw FBA stream: ours, and what other programs call elementary streams.
inline std::vector<std::string> stream_endings() {
  return {".fba", ".bit", ".bits", ".bin", ".es"};
}

/// Forgets all that add_output() noted, before the commands are set up again.
void forget_outputs();

/// What is wrong with the outputs that were given, as a sentence; empty: nothing. Wrong is an
/// ending that does not fit, a file that another option of the command reads or writes (by whatever
/// name or link), and a folder of HLS or DASH segments that would replace one in which an input
/// lies.
std::string problem_with_outputs(const CLI::App& command);

/// Whether all outputs that were given can be written: their folders are there, writable and not
/// full, their names are not those of folders. Asked before the work is begun; nothing stays
/// behind. Errors: io, with the output.
Result<void> outputs_can_be_written(const CLI::App& command);

/// For files that a command writes beside its output: a sentence if an option of the command that
/// problem_with_outputs() was called for reads this file; else empty.
std::string problem_with_another_output(const std::string& path);

}  // namespace animeme::tools

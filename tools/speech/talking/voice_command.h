/// @file
/// A voice that is a program of others: text in, sound and perhaps times out.
///
///     VoiceCommand voice{.command = "piper --model en.onnx --output_file {wav}"};
///     auto speech = run_voice_command("Hello world", voice);
///
/// The program gets the text on standard input, and wherever its command names it.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/timed_sound.h"

namespace animeme::speech {

/// How the program is run and its answer read.
struct VoiceCommand {
  /// As tools::parse_command(): no shell. {text} is what to say, {text_file} a file with it, {wav}
  /// the file to write the sound to (any format that FFmpeg reads; without it: standard output),
  /// {script} the file to write times to (without it: standard output, if the sound is not there),
  /// {lang} the language.
  std::string command;
  ScriptInput input;     ///< how times are read; the language of the text
  double seconds = 300;  ///< longer runs are ended
};

/// Speaks. Without times the sound is aligned with the text. Speech::voice is the program's name.
/// Errors: those of tools::parse_command(), tools::run_program(), media::read_audio() and
/// time_sound(); invalid_argument (the text is empty), not_found (no sound), io (progress.stop()).
Result<TimedSpeech> run_voice_command(const std::string& text, const VoiceCommand& voice,
                                      const tools::Log& log = {},
                                      const tools::Progress& progress = {});

/// The same for lines as they come. Errors: those of tools::parse_command().
Result<LineMaker> command_lines(const VoiceCommand& voice);

}  // namespace animeme::speech

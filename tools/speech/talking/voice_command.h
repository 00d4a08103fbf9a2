/// @file
/// An external TTS command: text in, sound and optionally timings out.
///
///     VoiceCommand voice{.command = "piper --model en.onnx --output_file {wav}"};
///     auto speech = run_voice_command("Hello world", voice);
///
/// The program gets the text on standard input, and in the arguments where its command refers to
/// it.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/timed_sound.h"

namespace animeme::speech {

/// How to run the program and read its output.
struct VoiceCommand {
  /// As tools::parse_command(): no shell. {text} is what to say, {text_file} a file with it, {wav}
  /// the file to write the sound to (any format that FFmpeg reads; without it: standard output),
  /// {script} the file to write timings to (without it: standard output, unless the sound is
  /// there), {lang} the language.
  std::string command;
  ScriptInput input;     ///< options for reading timings; the language of the text
  double seconds = 300;  ///< time limit
};

/// Speaks a text. Without timings the sound is aligned with the text. Speech::voice is the
/// program's name.
/// Errors: those of tools::parse_command(), tools::run_program(), media::read_audio() and
/// time_sound(); invalid_argument (the text is empty), not_found (no sound), io (progress.stop()).
Result<TimedSpeech> run_voice_command(const std::string& text, const VoiceCommand& voice,
                                      const tools::Log& log = {},
                                      const tools::Progress& progress = {});

/// The same for lines. Errors: those of tools::parse_command().
Result<LineMaker> command_lines(const VoiceCommand& voice);

}  // namespace animeme::speech

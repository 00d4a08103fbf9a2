/// @file
/// What is said and when: from text (a synthetic voice), from an aligned script, or from a
/// recorded voice and its text.
#pragma once

#include <optional>
#include <string>

#include "dam/script/script.h"
#include "tools/commands/common.h"
#include "tools/media/pcm.h"

namespace animeme::tools {

/// The options of speech, as the user gave them.
struct SpokenOptions {
  std::string text;             ///< --text
  bool has_text = false;        ///< --text was given, be it empty
  std::string text_file;        ///< --text-file
  std::string script;           ///< --script
  std::string audio;            ///< --audio
  std::string transcript;       ///< --transcript
  bool has_transcript = false;  ///< --transcript was given, be it empty
  std::string language = "en";  ///< --lang
  int words_per_minute = 175;   ///< --speed
  int pitch = 50;               ///< --pitch, 0..100
};

/// What is said, and its sound.
struct Spoken {
  dam::Script script;               ///< phones and words
  std::optional<media::Pcm> audio;  ///< nothing: no sound was given or made
  std::string voice;                ///< of synthetic speech
};

/// Adds --text, --text-file, --script, --audio, --transcript, --lang, --speed, --pitch.
void add_spoken_options(CLI::App& app, SpokenOptions& options);

/// A sentence about what is missing on the command line, empty if nothing is.
std::string missing_options(const SpokenOptions& options);

/// Speaks, reads or aligns, after missing_options() was empty.
Result<Spoken> get_spoken(const SpokenOptions& options);

/// The timed phones of a recording and its text in `language`.
Result<dam::Script> align_file(const std::string& audio, const std::string& transcript,
                               const std::string& language);

}  // namespace animeme::tools

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

struct SpokenOptions {
  std::string text;
  bool has_text = false;
  std::string text_file;
  std::string script;
  std::string audio;
  std::string transcript;
  bool has_transcript = false;
  std::string language = "en";
  int words_per_minute = 175;
  int pitch = 50;
};

struct Spoken {
  dam::Script script;
  std::optional<media::Pcm> audio;
  std::string voice;  ///< of synthetic speech
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

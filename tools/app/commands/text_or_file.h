/// @file
/// Arguments that may be a text or the name of a file.
#pragma once

#include <string>

#include "fap/result.h"

namespace animeme::tools {

/// What a file is, by its extension.
enum class SpokenFile : unsigned char {
  text,       ///< .txt, .ssml
  recording,  ///< .wav, .mp3, .mp4 ...
  script,     ///< .TextGrid, .srt, .json ...
  other,      ///< any other extension, or none
};
/// By the extension, in any case; the file need not exist.
SpokenFile spoken_file(const std::string& path);

/// Whether a text without blanks has an extension of spoken_file(), or one of the program's own
/// (.fba, .dam ...).
bool has_file_extension(const std::string& text);

/// not_found if `text` looks like a file: one word with a known extension or a path separator.
/// Call it for a text that is not the name of a file. The message suggests a similar name in the
/// same folder, and to give a text after `option`.
Result<void> no_missing_file(const std::string& text, const std::string& option);

/// For Option::check(): a transcript that is the name of a file. The words themselves are wanted.
std::string problem_with_transcript(const std::string& text);

}  // namespace animeme::tools

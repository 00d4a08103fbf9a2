/// @file
/// Timing scripts of all formats including JSON: phone and word timings from aligners, recognisers
/// and speech services.
///
///     auto timings = animeme::scripts::read_labels(text);
///     if (timings && !animeme::dam::has_words(*timings)) script =
///     animeme::dam::make_script(*timings);
///
/// JSON formats are distinguished by their members: Montreal aligner, Gentle, PocketSphinx 5,
/// whisper.cpp, Vosk, Deepgram, Amazon, Google, Azure, Speechmatics, Rev, aeneas, WhisperX and
/// other lists of words with times, Rhubarb Lip Sync, Papagayo, events of Azure Speech, speech
/// marks of Amazon Polly (a JSON a line), characters of ElevenLabs, words and phones of Inworld,
/// tokens of Kokoro, visemes of HeadTTS. Members may be in any case, with or without "_", since
/// libraries for different languages vary. Times, units and silence of each:
/// dam/script/phoneme_scripts.md, section 1.
#pragma once

#include <span>
#include <string_view>

#include "dam/script/timings.h"
#include "fap/result.h"

/// Scripts of other programs.
namespace animeme::scripts {

/// The formats of dam::text_script_formats() and those of JSON, each name once.
std::span<const dam::ScriptFormat> script_formats();

/// Reads the labels of a script of any format. Labels of visemes become representative phones
/// (dam/script/viseme_phones.h). Errors: those of dam::read_timings(); for JSON, with line and
/// column, syntax (not JSON, an unknown format, a member that is not text or not a time), not_found
/// (an unknown viseme, no such tier), truncated (nothing in it).
Result<dam::Timings> read_labels(std::string_view text, const dam::ScriptOptions& options = {});

}  // namespace animeme::scripts

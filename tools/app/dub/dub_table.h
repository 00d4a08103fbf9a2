/// @file
/// The table of a dub: a row is a language, or a person in a language. Rows become rows of a batch,
/// and tracks of the file with all of them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/app/batch/manifest.h"

namespace animeme::dub {

/// The columns of the table.
inline constexpr std::array<std::string_view, 19> kDubColumns = {
    "lang",           "speaker",        "script",       "audio",
    "transcript",     "input",          "voice",        "tts",
    "model",          "over",           "fit",          "id",
    "outputs",        "options",        "head",         "encode_options",
    "render_options", "export_options", "align_options"};

/// What the file is called that `speak --report` writes for a row: its id and this.
inline constexpr std::string_view kReportEnding = ".report.json";

/// Settings of a table.
struct TableSettings {
  /// Names of the files of a row without their extensions, with {lang} and {speaker}; empty:
  /// "{lang}", or "{lang}-{speaker}" for rows with a speaker.
  std::string name;
  std::string fit = "0.8-1.3";  ///< of rows that have none
  bool originals = false;       ///< also rows with an `input`, a face that is kept as it is
};

/// Checks a template for names; returns a sentence, or empty if it is valid.
std::string problem_of_name(const std::string& name);

/// How a batch reads the table. A row needs `lang`, a language tag, which voice variants may follow
/// ("de+f3"), and something to say: subtitles with their times (`script`), a recorded voice
/// (`audio`, with subtitles, or with or without `transcript`), or `input`. Subtitles are spoken by
/// a voice, in the range of speed `fit`, and recordings are put into their times. Of a script with
/// several speakers those of the row's `speaker` count. The outputs of a row are `outputs`, with
/// .mp4 if none of them is an .mp4 or .mkv of speech, and kReportEnding. Errors of rows: no
/// language, or one that is no tag; nothing to say; an input beside speech; a transcript beside
/// subtitles.
batch::Dialect dialect_of_dub(const TableSettings& settings);

/// A track of the file with all languages.
struct FilmTrack {
  std::string id;         ///< of the row
  std::string lang;       ///< language tag
  std::string speaker;    ///< empty: none
  std::string face;       ///< file with the face
  std::string audio;      ///< file with the sound; empty: none
  std::string words;      ///< file with the words; empty: those in the file of the face
  bool original = false;  ///< of an `input`, not made by the dub
};

/// The track of a row that was read with `originals`; files of rows are in the folder `out`. An
/// input has its own sound unless the row names another one.
FilmTrack film_track(const batch::Row& row, const std::string& out);

/// Of `mux --track`. Commas and backslashes of names are behind backslashes.
std::string mux_track(const FilmTrack& track);

}  // namespace animeme::dub

/// @file
/// Matches files of several folders that belong to one recording, by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// Input folders.
struct CorpusPlaces {
  std::string captures;     ///< folder of videos and tables, or a single one
  std::string transcripts;  ///< folder, or a table of names and texts, see find_takes()
  std::string audio;        ///< folder of sounds; empty: next to the captures, or in the videos
};

/// One recording. Empty: no such file.
struct Take {
  std::string id;                   ///< the name without folder and extension
  std::string table;                ///< output of a tracker: .csv, .tsv, .json, .jsonl, .ndjson
  std::string video;                ///< any other extension
  std::string sound;                ///< .wav, .flac, .ogg, .opus, .mp3, .m4a, .aac
  std::string script;               ///< timed phones, a format of dam/script/script.h
  std::optional<std::string> text;  ///< what is said
};

/// An input that was excluded from a corpus, with the reason.
struct LeftOut {
  std::string id;     ///< of the recording, or a file
  std::string stage;  ///< "files", "track", "import", "align", "script", "check"
  std::string why;    ///< a sentence
};

/// Recordings by name.
struct Takes {
  std::vector<Take> takes;        ///< with a capture and a transcript
  std::vector<LeftOut> left_out;  ///< without one of them
};

/// Pairs files by their names. A table takes precedence over a video of the same name. In a folder
/// of transcripts NAME.txt and NAME.lab are texts, NAME.TextGrid, .tsv, .csv, .json, .pho and
/// others that dam/script/script.h reads are scripts, which take precedence over texts. A file of
/// transcripts has one line per recording: name and text separated by tabs, "|" or commas; a first
/// line with the columns `id` (or name, file) and `text` (or transcript, sentence) says which is
/// which. Names may have extensions and folders there. Subtitles (.srt, .vtt) are texts; their
/// times are not used. For a single capture, a file may be its script, its subtitles, or only its
/// text (a .txt that does not begin with its name).
///
/// Errors: not_found (a missing path; no captures), io, syntax (a line without name and text; a
/// duplicate name).
Result<Takes> find_takes(const CorpusPlaces& places);

}  // namespace animeme::tools

/// @file
/// Which files of some folders belong to one recording: those of the same name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// Where the parts of recordings are.
struct CorpusPlaces {
  std::string captures;     ///< folder of videos and tables, or one of them
  std::string transcripts;  ///< folder, or a table of names and texts, see find_takes()
  std::string audio;        ///< folder of sounds; empty: beside the captures, or in the videos
};

/// One recording. Empty: there is no such file.
struct Take {
  std::string id;                   ///< the name without folder and ending
  std::string table;                ///< what a tracker wrote: .csv, .tsv, .json, .jsonl, .ndjson
  std::string video;                ///< any other ending
  std::string sound;                ///< .wav, .flac, .ogg, .opus, .mp3, .m4a, .aac
  std::string script;               ///< timed phones, a format of dam/script/script.h
  std::optional<std::string> text;  ///< what is said
};

/// What became no sentence of a corpus, and why.
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

/// Pairs files by their names. A table counts before a video of the same name. In a folder of
/// transcripts NAME.txt and NAME.lab are texts, NAME.TextGrid, .tsv, .csv, .json, .pho and others
/// that dam/script/script.h reads are scripts, which count before texts. A file of transcripts has
/// a line a recording: name and text between tabs, "|" or commas; a first line with the columns
/// `id` (or name, file) and `text` (or transcript, sentence) says which is which. Names may have
/// endings and folders there. Subtitles (.srt, .vtt) are texts; their times are not used. Where
/// there is one capture, a file may be its script, its subtitles, or its text alone (a .txt that
/// does not begin with its name).
///
/// Errors: not_found (a place that is not there; no capture at all), io, syntax (a line without a
/// name and a text; a name twice).
Result<Takes> find_takes(const CorpusPlaces& places);

}  // namespace animeme::tools

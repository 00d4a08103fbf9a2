/// @file
/// What became of each subtitle of a dub, as a page, a table and JSON. It depends only on the table
/// and the outputs, not on time, order or machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/common/json.h"

namespace animeme::dub {

/// P, B and M, and how many of them close the lips in the face that was made.
struct CueClosures {
  std::size_t phones = 0;  ///< P, B and M
  std::size_t closed = 0;  ///< of these
};

/// A subtitle in a language. A recording without subtitles is one cue.
struct CueRow {
  std::size_t language = 0;          ///< in DubReport::languages
  std::size_t number = 0;            ///< of the cue, from 1; 0: the whole recording
  std::string text;                  ///< what is said
  double start = 0;                  ///< wanted, seconds
  std::optional<double> wanted;      ///< length of its time, seconds; nullopt: any
  double said = 0;                   ///< when it is said, seconds
  double made = 0;                   ///< length of what is said, seconds
  double speed = 1;                  ///< share of the usual speed
  double pauses_cut = 0;             ///< seconds taken from pauses in it
  double late = 0;                   ///< seconds by which it ends behind its time
  std::size_t cut = 0;               ///< characters to cut, so that it fits
  std::optional<double> confidence;  ///< of a recorded voice, 0..1
  CueClosures closures;              ///< in it
};

/// A row of the table.
struct LanguageRow {
  std::string id;                     ///< of its files
  std::string lang;                   ///< language tag
  std::string speaker;                ///< empty: none
  std::string state;                  ///< "made", "original" (kept as it is), "failed"
  std::string error;                  ///< of a failed row
  std::vector<std::string> warnings;  ///< about its inputs
  std::vector<std::string> outputs;   ///< files
  double seconds = 0;                 ///< of speech
  std::size_t cues = 0;               ///< subtitles
  std::size_t late = 0;               ///< of these, those that do not fit
  std::size_t cut = 0;                ///< characters to cut in them
  double most_late = 0;               ///< seconds
  double slowest = 1;                 ///< speed of a cue
  double mean_speed = 1;              ///< over time
  double fastest = 1;                 ///< speed of a cue
  std::optional<double> confidence;   ///< of a recorded voice, 0..1
  CueClosures closures;               ///< of all of it
};

/// The file with all languages.
struct FilmFile {
  std::string name;         ///< in the folder of outputs; empty: there is none
  std::uint64_t bytes = 0;  ///< size
  std::string hash;         ///< of what it was made from
};

/// The report.
struct DubReport {
  std::vector<LanguageRow> languages;  ///< in the order of the table
  std::vector<CueRow> cues;            ///< worst first, see sort_cues()
  FilmFile film;                       ///< empty name: not made
};

/// Adds a row that was made, with what `speak --report` told of it. What the JSON lacks is left
/// out.
void add_language(DubReport& report, LanguageRow row, const tools::Json& told);

/// Worst first: those that end late, by their time; those with open P, B or M, by their number;
/// those of low confidence; those whose speed is far from the usual one; else in the order of the
/// table.
void sort_cues(DubReport& report);

/// A page without external resources, for screens from 390 pixels on and for readers of screens.
/// It has the worst `most` cues.
std::string report_page(const DubReport& report, std::size_t most = 5000);
/// A row per cue, by commas (RFC 4180).
std::string report_csv(const DubReport& report);
/// All of it.
tools::Json report_json(const DubReport& report);
/// The languages and the film, without the cues.
tools::Json summary_json(const DubReport& report);

/// The film of a report that was written as JSON; an empty name: none.
FilmFile film_of(const tools::Json& report);

}  // namespace animeme::dub

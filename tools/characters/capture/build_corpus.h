/// @file
/// From recordings of a person and what is said in them to the folder that `animeme train` reads.
///
///     auto report = build_corpus(plan, talk, progress);
///     if (report) write(report_text(*report));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fap/fapu.h"
#include "fap/result.h"
#include "tools/characters/capture/corpus_checks.h"
#include "tools/characters/capture/corpus_files.h"
#include "tools/characters/capture/read_capture.h"
#include "tools/formats/files/log.h"

namespace animeme::tools {

/// What a corpus is made of, and how.
struct CorpusPlan {
  CorpusPlaces places;                ///< where the parts are
  std::string output;                 ///< the folder; made if it is not there
  CaptureSettings capture;            ///< how captures are read and videos tracked
  NeutralSource neutral;              ///< none: one neutral face of all recordings
  std::string language = "en";        ///< of the transcripts
  dam::ScriptOptions script_reading;  ///< of scripts among them
  int folds = 5;                      ///< parts to test on, 2 to 100
  double longest = 15;                ///< seconds: longer recordings are cut at pauses; 0: never
  bool strict = false;                ///< leave out what check doubts, too
  bool track_again = false;           ///< whatever was tracked before
};

/// A sentence of the corpus.
struct SentenceReport {
  std::string id;                      ///< name of its files
  std::string text;                    ///< what is said
  double seconds = 0;                  ///< of its curves
  std::size_t frames = 0;              ///< likewise
  std::size_t filled = 0;              ///< frames that were not measured: no face there
  std::string source;                  ///< "table", "tracked", or "tracked before"
  std::string script;                  ///< "given", or "aligned"
  std::size_t phones = 0;              ///< silence included
  Closures closures;                   ///< of P B M
  std::vector<std::string> doubts;     ///< see doubts_about(); also of the aligner
  std::vector<std::string> warnings;   ///< of the capture: repairs, guesses
  std::optional<fap::Fapu> own_units;  ///< of the neutral face it has alone; points only
  int fold = 0;                        ///< from 1
};

/// What came of it.
struct CorpusReport {
  std::string folder;                     ///< of the corpus
  std::vector<SentenceReport> sentences;  ///< by their id
  std::vector<LeftOut> left_out;          ///< and why
  fap::Rate rate;                         ///< of all curves
  std::vector<std::string> controls;      ///< names of the curves
  std::optional<fap::Fapu> units;         ///< of the neutral face of all; points only
  std::string neutral;                    ///< where it is from: "all recordings together" ...
  std::optional<double> lag;              ///< see lag_of_lips()
  std::vector<std::string> warnings;      ///< of the corpus as a whole
};

/// Makes the corpus:
///
///     utterances.tsv          id, text, split, fold, fold1_split ..., heldout_word_split,
///                             seconds, doubtful
///     phonemes/ID.tsv         the script
///     fap/ID.csv              the curves from the first sample of the sound on, with `measured`
///     audio/ID.wav            16 kHz, where there is sound
///     tracked/ID.csv, ID.key  what the tracker wrote, and for which video
///     neutral.face            the neutral face of points
///     report.txt, report.json report_text(), report_json()
///
/// A video is not tracked again while its name, size and time and the command are the same. Files
/// take their names when they are whole; utterances.tsv comes last, and files of sentences that are
/// no longer there are not removed. Recordings of more than CorpusPlan::longest are cut into
/// sentences ID_001, ID_002 ... (cut.h). One program at a time (FileLock). The same input gives the
/// same files. What fails for a recording leaves it out, and no other.
///
/// Curves have the rate of most recordings; the others are interpolated. A sentence is as long as
/// its sound, or its script; frames without a face hold the one before and are not `measured`; a
/// recording with a face in less than half of its frames is left out. Curves that not all sentences
/// have are left out.
///
/// Errors, of the whole: those of find_takes() and neutral_face(); not_found (no recording is left;
/// the message has the first reason); io (the folder cannot be written to, or another program works
/// on it). `progress` is told the share; true of stop ends it after a recording, with an error
/// (io, "stopped"), and what was tracked is kept.
Result<CorpusReport> build_corpus(const CorpusPlan& plan, const Log& log, const Progress& progress);

}  // namespace animeme::tools

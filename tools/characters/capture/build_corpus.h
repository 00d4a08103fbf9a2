/// @file
/// Builds the training folder for `animeme train` from recordings of a person and their
/// transcripts.
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

/// Inputs and options of a corpus.
struct CorpusPlan {
  CorpusPlaces places;                ///< input folders
  std::string output;                 ///< the folder; created if missing
  CaptureSettings capture;            ///< options for reading captures and tracking videos
  NeutralSource neutral;              ///< default: a common neutral face of all recordings
  std::string language = "en";        ///< of the transcripts
  dam::ScriptOptions script_reading;  ///< of scripts among them
  int folds = 5;                      ///< test folds, 2 to 100
  double longest = 15;                ///< seconds: longer recordings are split at pauses; 0: never
  bool strict = false;                ///< also exclude doubtful sentences
  bool track_again = false;           ///< ignore previous tracking results
};

/// A sentence of the corpus.
struct SentenceReport {
  std::string id;                      ///< name of its files
  std::string text;                    ///< what is said
  double seconds = 0;                  ///< of its curves
  std::size_t frames = 0;              ///< of its curves
  std::size_t filled = 0;              ///< frames that were not measured, without a face
  std::string source;                  ///< "table", "tracked", or "tracked before"
  std::string script;                  ///< "given", or "aligned"
  std::size_t phones = 0;              ///< silence included
  Closures closures;                   ///< of P B M
  std::vector<std::string> doubts;     ///< see doubts_about(); also from the aligner
  std::vector<std::string> warnings;   ///< of the capture: repairs, guesses
  std::optional<fap::Fapu> own_units;  ///< of its own neutral face; points only
  int fold = 0;                        ///< from 1
};

/// Result of building a corpus.
struct CorpusReport {
  std::string folder;                     ///< of the corpus
  std::vector<SentenceReport> sentences;  ///< by their id
  std::vector<LeftOut> left_out;          ///< with reasons
  fap::Rate rate;                         ///< of all curves
  std::vector<std::string> controls;      ///< names of the curves
  std::optional<fap::Fapu> units;         ///< of the neutral face of all; points only
  std::string neutral;                    ///< its source: "all recordings together" ...
  std::optional<double> lag;              ///< see lag_of_lips()
  std::vector<std::string> warnings;      ///< of the corpus as a whole
};

/// Builds the corpus:
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
/// A video is tracked again only if its name, size, time or the command changes. Files are written
/// atomically; utterances.tsv comes last, and files of sentences that no longer exist are not
/// removed. Recordings longer than CorpusPlan::longest are split into sentences ID_001, ID_002 ...
/// (cut.h). Only one program may run at a time (FileLock). The same input gives the same files. A
/// failure excludes only its recording.
///
/// Curves have the rate of most recordings; the others are interpolated. A sentence is as long as
/// its sound, or its script; frames without a face repeat the previous one and are not `measured`;
/// a recording with a face in less than half of its frames is excluded. Curves that some sentences
/// lack are dropped.
///
/// Errors, of the whole: those of find_takes() and neutral_face(); not_found (no recording is left;
/// the message has the first reason); io (the folder is not writable, or in use by another
/// program). `progress` receives the progress; if stop returns true, it ends after a recording with
/// an error (io, "stopped"), and keeps tracking results.
Result<CorpusReport> build_corpus(const CorpusPlan& plan, const Log& log, const Progress& progress);

}  // namespace animeme::tools

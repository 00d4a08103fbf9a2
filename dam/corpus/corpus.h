/// @file
/// Training data: sentences with their phoneme scripts and measured control signals.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// One recorded sentence.
struct Utterance {
  std::string id;    ///< unique in a corpus
  std::string text;  ///< empty: unknown
  Script script;     ///< what is spoken when
  Signal signal;     ///< the recorded motion
  /// All columns of its row in utterances.tsv, unchanged.
  std::vector<std::pair<std::string, std::string>> fields;
};

/// A control that has blanks in the curves of one sentence.
struct BlankNote {
  std::string id;              ///< of the sentence
  std::string control;         ///< the column
  std::size_t rows = 0;        ///< rows with a blank
  std::size_t of = 0;          ///< rows of the sentence
  std::size_t first_line = 0;  ///< first blank in its file, from 1
};

/// Parts of a corpus that are not used.
struct LeftOut {
  std::size_t skipped = 0;        ///< rows of the split without a control file
  std::vector<BlankNote> blanks;  ///< by sentence, in the order of the table
  std::size_t sentences = 0;      ///< sentences without a single complete row
};

/// Sentences with the same controls in the same order, all at the same rate.
struct Corpus {
  std::vector<Utterance> utterances;  ///< in the order of the table
  LeftOut left_out;                   ///< what is not used

  std::size_t frames() const;  ///< of all signals
  /// Seconds of signal.
  double duration() const;
};

/// The rows and columns of a corpus to read.
struct CorpusOptions {
  std::string split_column =
      "split";              ///< column of utterances.tsv that is compared with `split_value`
  std::string split_value;  ///< only rows with this value; empty: all rows
  std::string controls_folder = "fap";  ///< folder with ID.csv or ID.fap
  std::vector<std::string>
      controls;               ///< names to keep, in this order; empty: all of the first file
  bool skip_missing = false;  ///< skip rows without a control file instead of failing
  int shard = 1;              ///< visit_corpus(): number of the part to visit, from 1, by ids
  int shards = 1;             ///< number of parts
  bool any_length = false;    ///< accept lengths of script and signal that differ by over 0.5 s
};

/// Reads a corpus folder:
///   utterances.tsv    tab separated with a header; requires `id`, uses `text` and `split`
///   phonemes/ID.tsv   start_s, end_s, phone, optional word; or ID.TextGrid
///   fap/ID.csv        time_s, one column per control, optional `measured` (0: interpolated frame)
/// The rate follows from time_s, which must be regular and start at 0.
///
/// Blanks (see read_curves()) are noted: a row that lacks one of the wanted controls counts as not
/// measured, a sentence without any other rows is omitted.
///
/// Errors name file, line and remedy: not_found (a file, a column, a control, no row of the split;
/// a control that is blank in all sentences), syntax (fields, numbers), out_of_range (irregular
/// times, lengths that differ by more than 0.5 s, different rates), io.
Result<Corpus> read_corpus(const std::filesystem::path& folder, const CorpusOptions& options = {});

/// The same, one sentence at a time, for corpora larger than memory: `visit` gets each sentence
/// with its number among the rows (of the shard, from 0) and their count; an error it returns ends
/// the reading and is returned. Returns what is not used.
using SentenceVisitor =
    std::function<Result<void>(Utterance sentence, std::size_t row, std::size_t rows)>;
/// See SentenceVisitor.
Result<LeftOut> visit_corpus(const std::filesystem::path& folder, const CorpusOptions& options,
                             const SentenceVisitor& visit);

/// Reads one table of curves as in fap/ID.csv, from memory. Also used by importers.
///
/// A blank is a field that is empty (also in quotes), "nan", "inf", "na", "n/a", "null", "none" or
/// "-" in any case, or begins with '#' (the errors of spreadsheets: "#N/A"). Fields missing at the
/// end of a row are blanks. With `blanks` they are NaN in the signal and noted there, a blank
/// `measured` is 0, and a truncated last row (too few fields and no newline) is ignored; without
/// `blanks` they are errors. Always ignored: rows of empty fields only, columns after the last one
/// that have neither name nor values. Any other text in place of a number is an error, and so is a
/// blank time_s.
Result<Signal> read_curves(std::string_view text, std::vector<BlankNote>* blanks = nullptr);

/// Marks every row that has a value that is not finite as not measured, and interpolates these
/// values linearly between their neighbours (0 in a channel without any).
void leave_out_blanks(Signal& signal);

/// The rows of `corpus` whose field `column` is `value`.
std::vector<Utterance> select(const Corpus& corpus, std::string_view column,
                              std::string_view value);

}  // namespace animeme::dam

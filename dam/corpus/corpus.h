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
  std::string id;    ///< name, unique in a corpus
  std::string text;  ///< empty: unknown
  Script script;     ///< what is spoken when
  Signal signal;     ///< what was measured
  /// All columns of its row in utterances.tsv, as they stand there.
  std::vector<std::pair<std::string, std::string>> fields;
};

/// A control that has blanks in the curves of one sentence.
struct BlankNote {
  std::string id;              ///< of the sentence
  std::string control;         ///< the column
  std::size_t rows = 0;        ///< with a blank in it
  std::size_t of = 0;          ///< rows of the sentence
  std::size_t first_line = 0;  ///< of its file, from 1
};

/// What a corpus has but nothing is learned from.
struct LeftOut {
  std::size_t skipped = 0;        ///< rows of the split, for want of a control file
  std::vector<BlankNote> blanks;  ///< by sentence, in the order of the table
  std::size_t sentences = 0;      ///< that have no row without a blank
};

/// Sentences with the same controls in the same order, all at the same rate.
struct Corpus {
  std::vector<Utterance> utterances;  ///< in the order of the table
  LeftOut left_out;                   ///< and what is not among them

  std::size_t frames() const;  ///< of all signals
  /// Seconds of signal.
  double duration() const;
};

/// Which rows and columns of a corpus are read.
struct CorpusOptions {
  std::string split_column =
      "split";              ///< column of utterances.tsv that `split_value` is looked up in
  std::string split_value;  ///< only rows with this value; empty: all rows
  std::string controls_folder = "fap";  ///< folder with ID.csv or ID.fap
  std::vector<std::string>
      controls;               ///< names to keep, in this order; empty: all of the first file
  bool skip_missing = false;  ///< leave out rows without a control file instead of failing
  int shard = 1;              ///< visit_corpus(): only this part, from 1, by ids
  int shards = 1;             ///< of so many
  bool any_length = false;    ///< accept a script and a signal that differ by more than 0.5 s
};

/// Reads a corpus folder:
///   utterances.tsv    tab separated with a header; `id` is needed, `text` and `split` are known
///   phonemes/ID.tsv   start_s, end_s, phone, optional word; or ID.TextGrid
///   fap/ID.csv        time_s, one column a control, optional `measured` (0: interpolated frame)
/// The rate is taken from time_s, which must be regular and start at 0.
///
/// Blanks (see read_curves()) are left out and noted: a row that lacks one of the wanted controls
/// counts as not measured, a sentence that has no other rows is not there.
///
/// Errors name file, line and remedy: not_found (a file, a column, a control, no row of the split;
/// a control that is blank in all sentences), syntax (fields, numbers), out_of_range (irregular
/// times, lengths that differ by more than 0.5 s, different rates), io.
Result<Corpus> read_corpus(const std::filesystem::path& folder, const CorpusOptions& options = {});

/// The same, one sentence at a time, for corpora larger than memory: `visit` gets each sentence
/// with its number among the rows (of the shard, from 0) and their count; an error it returns ends
/// the reading and is returned. Returns what was left out.
using SentenceVisitor =
    std::function<Result<void>(Utterance sentence, std::size_t row, std::size_t rows)>;
/// `row` of `rows` begins at 0; an error of the visitor ends the visit.
Result<LeftOut> visit_corpus(const std::filesystem::path& folder, const CorpusOptions& options,
                             const SentenceVisitor& visit);

/// One table of curves as in fap/ID.csv, from memory. Also used by importers.
///
/// A blank is a field that is empty, a quoted nothing, "nan", "inf", "na", "n/a", "null", "none" or
/// "-" in any case, or begins with '#' (the errors of spreadsheets: "#N/A"). Fields that a row
/// lacks at its end are blanks. With `blanks` they are NaN in the signal and noted there, a blank
/// `measured` is 0, and a last row that was cut off (too few fields and no line end) is ignored;
/// without it they are errors. Always ignored: rows of empty fields alone, columns behind the last
/// one that have neither name nor values. Any other text where a number belongs is an error, and so
/// is a blank time_s.
Result<Signal> read_curves(std::string_view text, std::vector<BlankNote>* blanks = nullptr);

/// Marks every row that has a value that is no number as not measured, and puts values in its place
/// that lie on a straight line between its neighbours (0 in a channel without any).
void leave_out_blanks(Signal& signal);

/// The rows of `corpus` whose field `column` is `value`.
std::vector<Utterance> select(const Corpus& corpus, std::string_view column,
                              std::string_view value);

}  // namespace animeme::dam

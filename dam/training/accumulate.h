/// @file
/// Training of method dam in parts: for corpora larger than memory, or spread over machines.
///
/// For a given dominance all that training takes from a corpus are sums. They can be taken sentence
/// by sentence, kept in a file, continued, and added to the sums of other sentences taken
/// elsewhere:
///
///     auto sums = TrainingSums::start(options, &base);       // base: a model, for its dominance
///     for (...) sums->add(utterance);                        // one at a time; memory as the sums
///     write(write_training_sums(*sums), "part.stats");
///     ...
///     auto all = merge_training_sums(paths);                 // any order, the same bytes
///     auto model = train_from_sums(std::move(*all), options, &summary);
///
/// What is fixed beforehand (the base) and the same in all parts that are merged:
///   - the dominance of every phone (widths, strength) and its usual duration, which the terms for
///     long and short phones compare with: those of the base model; 80 ms, strength 1 and 80 ms for
///     phones that the base does not know, and for all if there is no base;
///   - pause edge, time margin and duration exponent: those of the base, or of the options;
///   - the prior weight of sentence offsets: of the options.
/// The dominance is not improved here: that would need the curves of all controls at every step.
/// Take the base from `train` on as many sentences as memory holds; the dominance is a few numbers
/// a phone and soon known.
///
/// Sums are whole numbers of small units: 2^-30 in matrices, 2^-48 elsewhere, so controls want
/// units in which they move by 1e-5 or more. What a sentence gives is rounded once, adding is
/// exact: a corpus that is cut in any way, summed in any order, gives the same bytes.
///
/// What is summed, so that parts simply add up:
///   - normal equations of all terms but triphones, in the units of the controls, apart for
///   sentences that are
///     held out (one of eight, by the digest of id and content, so the same wherever it is summed);
///     means and deviations are applied when the sums are solved;
///   - per control: count, sum, sum of squares, least and largest value in the speech; sum in rest;
///   - per phone: count, sum of log durations, longest duration;
///   - counts of the least lip gaps of P B M and of the lower lip's heights in F V in bins of 0.5
///     units from -1024 to 1024 (medians of train() that are not sums; here within 0.25 units);
///   - what tells how long P B M are shut.
///
/// Memory: 16 n^2 bytes, n the unknowns, and twice the file while it is saved; file: 8 n^2 bytes.
/// All 41 phones in every surrounding have n = 5050 (file 204 MB), the sentences of one speaker
/// 2000.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/model.h"
#include "dam/training/train.h"
#include "fap/result.h"

namespace animeme::dam {

struct SumsState;  // internal

/// The sums of the sentences added so far. Movable. Not for use by several threads at once.
class TrainingSums {
 public:
  /// No sentence yet. Of `options`, pause_edge and refined (but the ridge and the width prior)
  /// count. `base` is used here only. Errors: invalid_argument (options; a base of another method
  /// than dam).
  static Result<TrainingSums> start(const TrainOptions& options = {}, const Model* base = nullptr);

  /// Adds a sentence. The first sets controls and rate. False: it is there already, with the same
  /// content, and was not added again. Glitches are taken out as mend_glitches() does for this
  /// sentence alone: that finds less than a look at all of a corpus, but the same in whatever part
  /// it is summed. They are appended to `glitches`. After an error the sums are as before. Errors,
  /// with the id of the sentence: invalid_argument (another content under an id that is there;
  /// other controls or another rate; NaN; values far above 1e6; a broken script).
  Result<bool> add(const Utterance& sentence, std::vector<Glitch>* glitches = nullptr);

  std::size_t sentences() const;              ///< added, held-out ones included
  std::size_t frames() const;                 ///< that count in the fit
  std::vector<std::string> controls() const;  ///< names, in the order of the sums
  fap::Rate rate() const;                     ///< of the signals

  /// Code::invalid_argument, naming what differs, unless both have the same base (`this` comes
  /// first in the sentence); nothing else is compared.
  Result<void> check_same_base(const TrainingSums& other) const;

  /// Adds all of `other`. After an error nothing was added. Errors: invalid_argument (another base,
  /// other controls, another rate; a sentence that both have; some 1e9 frames or more).
  Result<void> merge(const TrainingSums& other);

  TrainingSums(TrainingSums&&) noexcept;  ///< movable
  TrainingSums& operator=(TrainingSums&&) noexcept;
  ~TrainingSums();

  /// For the functions below.
  explicit TrainingSums(std::unique_ptr<SumsState> state);
  const SumsState& state() const { return *state_; }  ///< for this library
  std::unique_ptr<SumsState> release() &&;            ///< for this library; leaves nothing behind

 private:
  std::unique_ptr<SumsState> state_;
};

/// The file of sums: magic "ANIMESUM", version 4.0, little endian, CRC-32 of everything;
/// dam/training/README.md has the layout. The same sums give the same bytes.
std::vector<std::uint8_t> write_training_sums(const TrainingSums& sums);

/// Safe on any input: sizes are checked against the bytes that are there before anything is
/// allocated. Errors: syntax (not such a file, damaged), truncated, unsupported (made by a newer
/// major version; a phone that this version does not know).
Result<TrainingSums> read_training_sums(std::span<const std::uint8_t> bytes);

/// The same from a path; a file whose beginning is none of sums is not read further. Errors also:
/// not_found, io.
Result<TrainingSums> load_training_sums(const std::filesystem::path& path);

/// Adds up files; neither their order nor how a corpus was cut matters to a single bit. Memory: two
/// of them. Errors: those of load_training_sums() and merge(), with the path;
/// invalid_argument (no path).
Result<TrainingSums> merge_training_sums(std::span<const std::filesystem::path> paths);

/// Solves. Of `options`, refined.ridge (0: chosen by the held-out sentences, if there are 16
/// sentences or more; else 1), threads, attribution and provenance count; the method must be dam.
/// For the same sentences, base and ridge the curves are those of train() to rounding. `summary`
/// gets ridge, controls, utterances, frames, occurrences, the phones, and warnings; there is no
/// objective, no lag and no sentence that stands out, as these need the sentences themselves.
/// Uses the sums up; memory: half as much again. Errors: invalid_argument (options, no sentence, no
/// speech, sums that have no solution).
Result<Model> train_from_sums(TrainingSums sums, const TrainOptions& options = {},
                              TrainSummary* summary = nullptr);

}  // namespace animeme::dam

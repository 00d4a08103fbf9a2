/// @file
/// Training of method dam in parts: for corpora larger than memory, or distributed over machines.
///
/// For a given dominance, training only needs sums over the corpus. They can be computed sentence
/// by sentence, saved to a file, continued, and added to the sums of other sentences computed
/// elsewhere:
///
///     auto sums = TrainingSums::start(options, &base);       // base: a model, for its dominance
///     for (...) sums->add(utterance);                        // one at a time
///     write(write_training_sums(*sums), "part.stats");
///     ...
///     auto all = merge_training_sums(paths);                 // any order, the same bytes
///     auto model = train_from_sums(std::move(*all), options, &summary);
///
/// Fixed in advance (by the base) and the same in all parts that are merged:
///   - the dominance of every phone (widths, strength) and its usual duration, to which the
///     duration
///     terms refer: those of the base model; 80 ms, strength 1 and 80 ms for phones that the base
///     does not know, and for all if there is no base;
///   - pause edge, time margin and duration exponent: those of the base, or of the options;
///   - the prior weight of sentence offsets: of the options.
/// The dominance is not improved here: that would need the curves of all controls at every step.
/// Train the base with `train` on as many sentences as memory holds; the dominance is a few numbers
/// per phone and converges with little data.
///
/// Sums are integers of small units: 2^-30 in matrices, 2^-48 elsewhere, so controls should be in
/// units in which they move by 1e-5 or more. The contribution of a sentence is rounded once, adding
/// is exact: a corpus that is split in any way, summed in any order, gives the same bytes.
///
/// Contents of the sums, chosen so that parts can be added:
///   - normal equations of all terms except triphones, in the units of the controls, separately for
///     held-out sentences (one of eight, by the digest of id and content, so the same wherever it
///   is
///     summed); means and deviations are applied when the sums are solved;
///   - per control: count, sum, sum of squares, least and largest value in the speech; sum in rest;
///   - per phone: count, sum of log durations, longest duration;
///   - counts of the least lip gaps of P B M and of the lower lip's heights in F V in bins of 0.5
///     units from -1024 to 1024 (medians in train(), which are not sums; here within 0.25 units);
///   - sums for the time that P B M stay closed.
///
/// Memory: 16 n^2 bytes, n the unknowns, and twice the file while it is saved; file: 8 n^2 bytes.
/// All 41 phones in all contexts have n = 5050 (file 204 MB), the sentences of one speaker 2000.
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

/// The sums of the sentences added so far. Movable. Not thread safe.
class TrainingSums {
 public:
  /// Without any sentence. Of `options`, pause_edge and refined (except the ridge and the width
  /// prior) are used. `base` is only used here. Errors: invalid_argument (options; a base of
  /// another method than dam).
  static Result<TrainingSums> start(const TrainOptions& options = {}, const Model* base = nullptr);

  /// Adds a sentence. The first sets controls and rate. Returns false if it was already added with
  /// the same content; it is not added again. Glitches are removed by remove_glitches() on this
  /// sentence alone: that finds less than on the whole corpus, but the result does not depend on
  /// the part. They are appended to `glitches`. After an error the sums are unchanged. Errors, with
  /// the id of the sentence: invalid_argument (different content under a known id; other controls
  /// or another rate; NaN; values far above 1e6; a broken script).
  Result<bool> add(const Utterance& sentence, std::vector<Glitch>* glitches = nullptr);

  std::size_t sentences() const;              ///< added, including held-out ones
  std::size_t frames() const;                 ///< used in the fit
  std::vector<std::string> controls() const;  ///< names, in the order of the sums
  fap::Rate rate() const;                     ///< of the signals

  /// Code::invalid_argument, naming the difference, unless both have the same base (`this` comes
  /// first in the message); nothing else is compared.
  Result<void> check_same_base(const TrainingSums& other) const;

  /// Adds all of `other`. After an error the sums are unchanged. Errors: invalid_argument (another
  /// base, other controls, another rate; a sentence that both have; some 1e9 frames or more).
  Result<void> merge(const TrainingSums& other);

  TrainingSums(TrainingSums&&) noexcept;  ///< movable
  TrainingSums& operator=(TrainingSums&&) noexcept;
  ~TrainingSums();

  /// For the functions below.
  explicit TrainingSums(std::unique_ptr<SumsState> state);
  const SumsState& state() const { return *state_; }  ///< for this library
  std::unique_ptr<SumsState> release() &&;            ///< for this library; leaves it empty

 private:
  std::unique_ptr<SumsState> state_;
};

/// The file of sums: magic "ANIMESUM", version 4.0, little endian, CRC-32 of everything;
/// dam/training/README.md has the layout. The same sums give the same bytes.
std::vector<std::uint8_t> write_training_sums(const TrainingSums& sums);

/// Safe for untrusted input: sizes are checked against the available bytes before anything is
/// allocated. Errors: syntax (not such a file, damaged), truncated, unsupported (made by a newer
/// major version; an unknown phone).
Result<TrainingSums> read_training_sums(std::span<const std::uint8_t> bytes);

/// The same from a path; a file that does not begin like sums is not read further. Additional
/// errors: not_found, io.
Result<TrainingSums> load_training_sums(const std::filesystem::path& path);

/// Adds files; the result is bit-identical for any order and any split of the corpus. Memory: two
/// of them. Errors: those of load_training_sums() and merge(), with the path; invalid_argument (no
/// path).
Result<TrainingSums> merge_training_sums(std::span<const std::filesystem::path> paths);

/// Solves the sums. Of `options`, refined.ridge (0: chosen on the held-out sentences, if there are
/// 16 sentences or more; else 1), threads, attribution and provenance are used; the method must be
/// dam. For the same sentences, base and ridge the curves are those of train() up to rounding.
/// `summary` gets ridge, controls, utterances, frames, occurrences, the phones, and warnings;
/// objective, lag and outlier sentences are missing, as these need the sentences themselves.
/// Consumes the sums; memory: half as much again. Errors: invalid_argument (options, no sentence,
/// no speech, sums that have no solution).
Result<Model> train_from_sums(TrainingSums sums, const TrainOptions& options = {},
                              TrainSummary* summary = nullptr);

}  // namespace animeme::dam

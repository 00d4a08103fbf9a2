/// @file
/// Plausibility checks of a corpus: lips that close for P B M, and phones with plausible durations.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"

namespace animeme::tools {

/// Inner lip gap (FAP units) below which lips count as closed, as in dam/evaluation.
inline constexpr double kClosedGap = 45;

/// P, B and M of a sentence.
struct Closures {
  std::size_t phones = 0;  ///< in measured frames
  std::size_t closed = 0;  ///< of these, with a gap below kClosedGap within 40 ms of the phone
  std::vector<int> gaps;   ///< smallest gap of each
};
/// None without FAP 4 and 5.
Closures closures_of(const dam::Signal& signal, const dam::Script& script);

/// Problems with the phones of a sentence, as sentences for the user; may be empty.
///
/// - less than half of its P B M are closed (of two or more);
/// - a third of its phones or more is no longer than 35 ms, the least that the aligner can make;
/// - a phone is longer than 0.6 s;
/// - it has more than twice, or less than half, of `usual` phones a second of speech (if > 0).
std::vector<std::string> doubts_about(const dam::Script& script, const Closures& closures,
                                      double usual);

/// Phones a second of speech, without silence; 0: none.
double phone_rate(const dam::Script& script);

/// How much later than the sound the lips close, in seconds: the shift of the phones within 0.2 s
/// that makes the mean gap in the middle of P B M, between other sounds, smallest, by steps of 10
/// ms. nullopt if there are fewer than twenty.
std::optional<double> lag_of_lips(const std::vector<const dam::Signal*>& signals,
                                  const std::vector<const dam::Script*>& scripts);

}  // namespace animeme::tools

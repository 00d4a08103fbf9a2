// What a known speaker's mouth would do for the scripts of a corpus: the yardstick for how they are
// aligned. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "fap/result.h"

namespace animeme::dam {

/// Jaw, gap, width, upper lip, height of the corners.
inline constexpr std::size_t kShapes = 5;
using Shapes = std::array<double, kShapes>;

/// One sentence: what was recorded, and what its script asks for at any time.
struct SentenceTrack {
  std::string id;
  std::vector<double> times;   ///< of the frames that count
  std::vector<double> motion;  ///< frames x controls, in deviations, about the sentence's mean
  std::vector<Shapes> asked;   ///< a hundred a second, from 0

  std::size_t frames() const { return times.size(); }
  std::size_t controls() const { return motion.size() / times.size(); }
  /// What is asked for at a time, held at both ends.
  const Shapes& at(double time) const;
};

/// Tracks in the order of the sentences, of those with half a second of measured speech that the
/// known speaker, the model that is built in, can say. All must have the same controls.
Result<std::vector<SentenceTrack>> make_tracks(std::span<const Utterance* const> sentences,
                                               int threads);

}  // namespace animeme::dam

// Sequences of ARKit's weights, and how they come back: for round_trip_table and its test.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fap/arkit.h"
#include "fap/frame.h"

namespace animeme::bench {

/// Weights in time.
struct WeightSequence {
  std::string name;  ///< "blinks"
  double rate = 30;  ///< frames a second
  std::vector<fap::ArkitFrame> frames;
};

/// Twenty: two takes of a phone (in `shared`/data/livelink_rom; left out where these are not), made
/// speech, blinks, winks, squints and all of it at once, at 25, 30 and 60 a second. `seconds`: at
/// most so long.
std::vector<WeightSequence> weight_sequences(const std::filesystem::path& shared, double seconds);

/// Weights by frame and shape; all rows have the same length.
using Rows = std::vector<std::vector<double>>;

/// What became of weights.
struct Comparison {
  double mean = 0;       ///< absolute difference
  double off = 0;        ///< share of the frames with a weight that is off by more than 0.2
  double opposites = 0;  ///< the most that the lesser of two shapes that undo each other has,
                         ///< beyond what was given
  double jump = 0;  ///< the most that a weight moves in a frame, beyond what the given one does
                    ///< in it or in one beside it
  std::string off_most;       ///< the shape that is off most often
  std::string opposite_most;  ///< the two of `opposites`, with the frame
  std::string jumps_most;     ///< the shape of `jump`, with the frame
};

/// `names`: ARKit's name of each shape, or another one. The rows have the same size.
Comparison compare_weights(const Rows& given, const Rows& found,
                           const std::vector<std::string>& names);

/// The FAPs of weights as a stream that is complete carries them.
fap::Frame complete_face(const fap::ArkitFrame& weights);

}  // namespace animeme::bench

// Time as the trajectory knows it: points every 20 ms, whatever the frame rate, each with the
// states that are spoken around it. Training and synthesis share it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dam/model/model.h"

namespace animeme::dam {

/// Seconds between points. Point i is at i * kGridStep from the start of the clip.
inline constexpr double kGridStep = 0.020;

/// A phone to be placed: seconds, and its index of Model::phones.
struct Piece {
  double start = 0;
  double duration = 0;
  std::int32_t phone = 0;

  double end() const { return start + duration; }
};

/// A state's part in the 20 ms around a point.
struct Cover {
  std::uint32_t state = 0;  ///< phone * states + part of the phone
  double share = 0;         ///< of the 20 ms: 0..1
};

/// Points that hang together: speech without a rest in between.
struct Run {
  std::int64_t first = 0;  ///< number of its first point in time
  std::size_t begin = 0;   ///< its place among all points of the grid
  std::size_t points = 0;
  double start = 0, end = 0;  ///< seconds that the phones cover, within the window
};

struct Grid {
  std::vector<Run> runs;
  std::vector<std::size_t> begin = {0};  ///< covers of point i: begin[i] .. begin[i + 1]
  std::vector<Cover> covers;

  std::size_t points() const { return begin.size() - 1; }
  std::span<const Cover> at(std::size_t point) const {
    return {covers.data() + begin[point], begin[point + 1] - begin[point]};
  }
};

/// Ends (as indices) of the stretches of pieces that touch each other.
std::vector<std::size_t> run_ends(std::span<const Piece> pieces);

/// Seconds that a grid is wanted for.
struct Window {
  double low = 0, high = 0;
};

/// Appends pieces that hang together, each cut into `states` equal parts; only the points of the
/// window, nothing if the pieces lie outside.
void add_run(std::span<const Piece> pieces, std::size_t states, Window window, Grid& grid);

/// The value at a time within a run, from the four points around it (cubic).
struct Reading {
  std::size_t point = 0;  ///< the first of the four
  double weight[4] = {};
};
Reading read_at(const Run& run, double time);

}  // namespace animeme::dam

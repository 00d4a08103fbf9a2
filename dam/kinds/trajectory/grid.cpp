#include "dam/kinds/trajectory/grid.h"

#include <algorithm>
#include <cmath>

#include "dam/script/script.h"

namespace animeme::dam {
namespace {

using Covers = std::vector<std::vector<Cover>>;

/// Adds a state to the points whose 20 ms overlap [start, end).
void cover(const Run& run, double start, double end, std::uint32_t state, Covers& covers) {
  const double low = double(run.first), high = low + double(run.points);
  // Point i has [i, i + 1) here.
  const double a = std::max(start / kGridStep + 0.5, low);
  const double b = std::min(end / kGridStep + 0.5, high);
  for (double i = std::floor(a); i < b; ++i) {
    const double share = std::min(b, i + 1) - std::max(a, i);
    if (share > 0) covers[std::size_t(i - low)].push_back({state, share});
  }
}

}  // namespace

std::vector<std::size_t> run_ends(std::span<const Piece> pieces) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (i + 1 == pieces.size() || pieces[i + 1].start - pieces[i].end() > kTimeTolerance)
      ends.push_back(i + 1);
  return ends;
}

void add_run(std::span<const Piece> pieces, std::size_t states, Window window, Grid& grid) {
  if (pieces.empty()) return;
  Run run;
  run.start = std::max(pieces.front().start, window.low);
  run.end = std::min(pieces.back().end(), window.high);
  if (!(run.start < run.end)) return;
  // Two points more on either side than the speech covers, for read_at().
  run.first = std::int64_t(std::floor(run.start / kGridStep)) - 2;
  run.points = std::size_t(std::int64_t(std::floor(run.end / kGridStep)) + 3 - run.first);
  run.begin = grid.points();
  Covers covers(run.points);
  const auto near = std::partition_point(pieces.begin(), pieces.end(), [&](const Piece& piece) {
    return piece.end() < run.start - 2 * kGridStep;
  });
  for (auto piece = near; piece != pieces.end() && piece->start < run.end + 2 * kGridStep; ++piece)
    for (std::size_t s = 0; s < states; ++s) {
      const double part = piece->duration / double(states);
      cover(run, piece->start + part * double(s), piece->start + part * double(s + 1),
            std::uint32_t(std::size_t(piece->phone) * states + s), covers);
    }
  for (const auto& list : covers) {
    grid.covers.insert(grid.covers.end(), list.begin(), list.end());
    grid.begin.push_back(grid.covers.size());
  }
  grid.runs.push_back(run);
}

Reading read_at(const Run& run, double time) {
  const double x = std::clamp(time, run.start, run.end) / kGridStep;
  const double whole = std::floor(x), u = x - whole;
  return {run.begin + std::size_t(std::int64_t(whole) - 1 - run.first),
          {-u * (u - 1) * (u - 2) / 6, (u + 1) * (u - 1) * (u - 2) / 2, -(u + 1) * u * (u - 2) / 2,
           (u + 1) * u * (u - 1) / 6}};
}

}  // namespace animeme::dam

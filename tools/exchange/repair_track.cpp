// What trackers do wrong and no face does: see landmarks.h. Sizes are shares of the face's own, so
// that pixels and millimetres are the same.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tools/exchange/detail/table.h"
#include "tools/exchange/landmarks.h"

namespace animeme::exchange {

namespace {

constexpr double kLongestGap = 0.2;   // seconds
constexpr double kLongestSlip = 0.1;  // seconds
constexpr double kFar = 0.5;          // of the size of the face: elsewhere
constexpr double kNear = 0.25;        // back again
constexpr double kGrown = 1.25;       // of another size
constexpr double kSlowest = 15;       // frames a second
constexpr double kNotSeen = std::numeric_limits<double>::quiet_NaN();

bool seen(const fap::Point& point) { return point[0] == point[0] && point[1] == point[1]; }

// Where a face is in the picture, and how large.
struct Spot {
  double x = 0, y = 0, size = 0;
};

std::optional<Spot> spot_of(const fap::LandmarkFrame& frame) {
  Spot spot;
  std::size_t count = 0;
  for (const fap::Point& point : frame.at) {
    if (!seen(point)) continue;
    spot.x += point[0];
    spot.y += point[1];
    ++count;
  }
  if (count < frame.at.size() / 2 + 1) return std::nullopt;  // the rest would be another middle
  spot.x /= double(count);
  spot.y /= double(count);
  for (const fap::Point& point : frame.at) {
    if (!seen(point)) continue;
    spot.size +=
        (point[0] - spot.x) * (point[0] - spot.x) + (point[1] - spot.y) * (point[1] - spot.y);
  }
  spot.size = std::sqrt(spot.size / double(count));
  if (!(spot.size > 0) || !std::isfinite(spot.size)) return std::nullopt;
  return spot;
}

bool is_elsewhere(const Spot& a, const Spot& b, double far) {
  const double size = std::min(a.size, b.size);
  const double ratio = std::max(a.size, b.size) / size;
  return std::hypot(a.x - b.x, a.y - b.y) > far * size || ratio > kGrown;
}

// Indices of what jumped away from where `at(i)` was last and came back within `most` numbers.
template <class At, class Away>
std::vector<std::size_t> excursions(const std::vector<fap::LandmarkFrame>& frames, double most,
                                    const At& at, const Away& away) {
  std::vector<std::size_t> out;
  std::optional<std::size_t> good;  // the last frame that is where it was
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!at(i)) continue;
    if (!good || !away(*at(*good), *at(i), kFar)) {
      good = i;
      continue;
    }
    // Elsewhere: is it back soon?
    std::size_t back = i + 1;
    const auto soon = [&](std::size_t j) {
      return j < frames.size() && double(frames[j].number - frames[*good].number) <= most + 1;
    };
    while (soon(back) && (!at(back) || away(*at(*good), *at(back), kNear))) ++back;
    if (soon(back)) {
      for (std::size_t j = i; j < back; ++j) {
        if (at(j)) out.push_back(j);
      }
      i = back;
    }
    good = i;
  }
  return out;
}

std::size_t drop_glitches(fap::LandmarkTrack& track) {
  std::vector<std::optional<Spot>> spots;
  for (const fap::LandmarkFrame& frame : track.frames) spots.push_back(spot_of(frame));
  const auto bad = excursions(
      track.frames, kLongestGap * track.rate.frames_per_second(),
      [&](std::size_t i) -> const std::optional<Spot>& { return spots[i]; }, is_elsewhere);
  std::vector<fap::LandmarkFrame> kept;
  for (std::size_t i = 0; i < track.frames.size(); ++i) {
    if (!std::binary_search(bad.begin(), bad.end(), i)) kept.push_back(std::move(track.frames[i]));
  }
  track.frames = std::move(kept);
  return bad.size();
}

// A point as it lies on the face, whose middle and size are taken off.
std::size_t drop_slips(fap::LandmarkTrack& track) {
  std::vector<std::optional<Spot>> spots;
  for (const fap::LandmarkFrame& frame : track.frames) spots.push_back(spot_of(frame));
  std::size_t count = 0;
  std::vector<std::optional<Spot>> places(track.frames.size());
  const auto away = [](const Spot& a, const Spot& b, double far) {
    return std::hypot(a.x - b.x, a.y - b.y) > far;
  };
  for (std::size_t k = 0; k < track.points.size(); ++k) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i].reset();
      const fap::Point& point = track.frames[i].at[k];
      if (!spots[i] || !seen(point)) continue;
      const Spot& spot = *spots[i];
      places[i] = Spot{(point[0] - spot.x) / spot.size, (point[1] - spot.y) / spot.size, 1};
    }
    const auto bad = excursions(
        track.frames, kLongestSlip * track.rate.frames_per_second(),
        [&](std::size_t i) -> const std::optional<Spot>& { return places[i]; }, away);
    for (const std::size_t i : bad) track.frames[i].at[k] = {kNotSeen, kNotSeen, kNotSeen};
    count += bad.size();
  }
  return count;
}

fap::Point between(const fap::Point& a, const fap::Point& b, double share) {
  fap::Point out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = a[k] + share * (b[k] - a[k]);
  return out;
}

fap::LandmarkFrame between(const fap::LandmarkFrame& a, const fap::LandmarkFrame& b,
                           std::int64_t number) {
  const double share = double(number - a.number) / double(b.number - a.number);
  fap::LandmarkFrame out;
  out.number = number;
  for (std::size_t k = 0; k < a.at.size(); ++k) out.at.push_back(between(a.at[k], b.at[k], share));
  if (a.head && b.head) {
    out.head = {a.head->pitch + share * (b.head->pitch - a.head->pitch),
                a.head->yaw + share * (b.head->yaw - a.head->yaw),
                a.head->roll + share * (b.head->roll - a.head->roll)};
  }
  for (std::size_t eye = 0; eye < 2; ++eye) {
    if (a.gaze[eye] && b.gaze[eye]) out.gaze[eye] = between(*a.gaze[eye], *b.gaze[eye], share);
  }
  return out;
}

void fill_frames(fap::LandmarkTrack& track, Repairs& repairs) {
  const double most = kLongestGap * track.rate.frames_per_second();
  std::vector<fap::LandmarkFrame> out;
  for (fap::LandmarkFrame& frame : track.frames) {
    const std::int64_t missing = out.empty() ? 0 : frame.number - out.back().number - 1;
    if (missing > 0 && double(missing) <= most) {
      const fap::LandmarkFrame before = out.back();
      for (std::int64_t number = before.number + 1; number < frame.number; ++number) {
        out.push_back(between(before, frame, number));
        repairs.made.push_back(number);
      }
      repairs.filled_frames += std::size_t(missing);
    } else if (missing > 0) {
      ++repairs.gaps;
      repairs.longest_gap = std::max(repairs.longest_gap, track.rate.seconds(double(missing)));
    }
    out.push_back(std::move(frame));
  }
  track.frames = std::move(out);
}

void fill_points(fap::LandmarkTrack& track, Repairs& repairs) {
  const double most = kLongestGap * track.rate.frames_per_second();
  for (std::size_t k = 0; k < track.points.size(); ++k) {
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < track.frames.size(); ++i) {
      if (!seen(track.frames[i].at[k])) continue;
      const std::size_t missing = last ? i - *last - 1 : 0;
      const fap::LandmarkFrame& to = track.frames[i];
      if (missing > 0 && double(to.number - track.frames[*last].number - 1) <= most) {
        const fap::LandmarkFrame& from = track.frames[*last];
        for (std::size_t j = *last + 1; j < i; ++j) {
          const double share =
              double(track.frames[j].number - from.number) / double(to.number - from.number);
          track.frames[j].at[k] = between(from.at[k], to.at[k], share);
        }
        repairs.filled_points += missing;
      }
      last = i;
    }
  }
}

}  // namespace

Repairs repair_track(fap::LandmarkTrack& track) {
  Repairs repairs;
  if (!track.rate.valid() || track.rate.frames_per_second() < kSlowest) return repairs;
  repairs.glitches = drop_glitches(track);
  repairs.slips = drop_slips(track);
  fill_points(track, repairs);
  fill_frames(track, repairs);
  return repairs;
}

}  // namespace animeme::exchange

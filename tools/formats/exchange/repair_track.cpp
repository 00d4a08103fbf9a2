// What trackers do wrong and no face does: see landmarks.h. Sizes are shares of the face's own, so
// that pixels and millimetres are the same.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

namespace {

constexpr double kLongestGap = 0.2;             // seconds
constexpr double kLongestSlip = 0.1;            // seconds
constexpr double kFar = 0.5;                    // of the size of the face: elsewhere
constexpr double kNear = 0.25;                  // back again
constexpr double kGrown = 1.25;                 // of another size
constexpr double kSlowest = 15;                 // frames a second
constexpr std::size_t kFewestPointsAround = 6;  // that tell where a face is
constexpr double kNotSeen = std::numeric_limits<double>::quiet_NaN();

bool seen(const fap::Point& point) { return point[0] == point[0] && point[1] == point[1]; }

// How a face has moved from one frame to another: medians of the points that both have, so that
// neither a point that is elsewhere nor one that is hidden is another face.
struct Shift {
  double x = 0, y = 0;
  double size = 0;   // of the face in the first frame: the median distance from the medians
  double ratio = 1;  // of the sizes, >= 1
};

std::vector<double> distances_of(const std::vector<double>& x, const std::vector<double>& y) {
  const double middle_x = median(x);
  const double middle_y = median(y);
  std::vector<double> distances;
  for (std::size_t i = 0; i < x.size(); ++i) {
    distances.push_back(std::hypot(x[i] - middle_x, y[i] - middle_y));
  }
  return distances;
}

double size_of(const std::vector<double>& x, const std::vector<double>& y) {
  return median(distances_of(x, y));
}

// Nothing: too few points to tell.
std::optional<Shift> shift_between(const fap::LandmarkFrame& a, const fap::LandmarkFrame& b) {
  std::vector<double> ax, ay, bx, by, dx, dy;
  for (std::size_t k = 0; k < a.at.size(); ++k) {
    if (!seen(a.at[k]) || !seen(b.at[k])) continue;
    ax.push_back(a.at[k][0]);
    ay.push_back(a.at[k][1]);
    bx.push_back(b.at[k][0]);
    by.push_back(b.at[k][1]);
    dx.push_back(bx.back() - ax.back());
    dy.push_back(by.back() - ay.back());
  }
  if (ax.size() < kFewestPointsAround) return std::nullopt;
  const double before = size_of(ax, ay);
  const double behind = size_of(bx, by);
  if (!(before > 0) || !(behind > 0) || !std::isfinite(before + behind)) return std::nullopt;
  return Shift{median(std::move(dx)), median(std::move(dy)), before,
               std::max(before, behind) / std::min(before, behind)};
}

// The outer corners of the eyes.
struct Eyes {
  std::size_t left, right;
  bool known;

  explicit Eyes(const fap::LandmarkTrack& track)
      : left(find(track, "3.7")),
        right(find(track, "3.12")),
        known(left < track.points.size() && right < track.points.size()) {}
  static std::size_t find(const fap::LandmarkTrack& track, const char* id) {
    return std::size_t(std::find(track.points.begin(), track.points.end(), id) -
                       track.points.begin());
  }
  // NaN: not seen.
  double apart(const fap::LandmarkFrame& frame) const {
    if (!known) return kNotSeen;
    const fap::Point& a = frame.at[left];
    const fap::Point& b = frame.at[right];
    return std::hypot(a[0] - b[0], a[1] - b[1]);
  }
};

// How many times the size of the face its outer corners of the eyes are apart (9 cm), in the middle
// of all frames; of a track without them, twice the distance within which nine of ten points lie.
double reach_of(const fap::LandmarkTrack& track, const Eyes& eyes) {
  std::vector<double> reaches;
  for (const fap::LandmarkFrame& frame : track.frames) {
    std::vector<double> x, y;
    for (const fap::Point& point : frame.at) {
      if (!seen(point)) continue;
      x.push_back(point[0]);
      y.push_back(point[1]);
    }
    if (x.size() < kFewestPointsAround) continue;
    std::vector<double> distances = distances_of(x, y);
    const double size = median(distances);
    double reach = eyes.apart(frame);
    if (!eyes.known) {
      std::sort(distances.begin(), distances.end());
      reach = 2 * distances[distances.size() * 9 / 10];
    }
    if (std::isfinite(reach / size)) reaches.push_back(reach / size);
  }
  return reaches.empty() ? 0 : median(std::move(reaches));
}

// Indices of frames that are away from the last one that was not, and back within `most` numbers.
// `there`: does a frame count? `away`: is a frame far from another one?
template <class There, class Away>
std::vector<std::size_t> excursions(const std::vector<fap::LandmarkFrame>& frames, double most,
                                    const There& there, const Away& away) {
  std::vector<std::size_t> out;
  std::optional<std::size_t> good;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!there(i)) continue;
    if (!good || !away(*good, i, kFar)) {
      good = i;
      continue;
    }
    // Elsewhere: is it back soon?
    std::size_t back = i + 1;
    const auto soon = [&](std::size_t j) {
      return j < frames.size() && double(frames[j].number - frames[*good].number) <= most + 1;
    };
    while (soon(back) && (!there(back) || away(*good, back, kNear))) ++back;
    if (soon(back)) {
      for (std::size_t j = i; j < back; ++j) {
        if (there(j)) out.push_back(j);
      }
      i = back;
    }
    good = i;
  }
  return out;
}

std::size_t drop_glitches(fap::LandmarkTrack& track, const Eyes& eyes, double reach) {
  const auto& frames = track.frames;
  const auto bad = excursions(
      frames, kLongestGap * track.rate.frames_per_second(), [](std::size_t) { return true; },
      [&](std::size_t a, std::size_t b, double far) {
        const auto shift = shift_between(frames[a], frames[b]);
        if (!shift) return false;
        // All of it is larger, the eyes included, which no mouth moves.
        const double grown = eyes.apart(frames[b]) / eyes.apart(frames[a]);
        const bool larger = shift->ratio > kGrown && std::max(grown, 1 / grown) > kGrown;
        return larger || std::hypot(shift->x, shift->y) > far * reach * shift->size;
      });
  std::vector<fap::LandmarkFrame> kept;
  for (std::size_t i = 0; i < track.frames.size(); ++i) {
    if (!std::binary_search(bad.begin(), bad.end(), i)) kept.push_back(std::move(track.frames[i]));
  }
  track.frames = std::move(kept);
  return bad.size();
}

// Points that move other than the face does.
std::size_t drop_slips(fap::LandmarkTrack& track, double reach) {
  const std::vector<fap::LandmarkFrame> frames = track.frames;
  std::vector<std::optional<Shift>> steps;  // from the frame before: what is nearly always wanted
  for (std::size_t i = 0; i < frames.size(); ++i) {
    steps.push_back(i == 0 ? std::nullopt : shift_between(frames[i - 1], frames[i]));
  }
  std::size_t count = 0;
  for (std::size_t k = 0; k < track.points.size(); ++k) {
    const auto bad = excursions(
        frames, kLongestSlip * track.rate.frames_per_second(),
        [&](std::size_t i) { return seen(frames[i].at[k]); },
        [&](std::size_t a, std::size_t b, double far) {
          const auto shift = b == a + 1 ? steps[b] : shift_between(frames[a], frames[b]);
          if (!shift) return false;
          const fap::Point& from = frames[a].at[k];
          const fap::Point& to = frames[b].at[k];
          return std::hypot(to[0] - from[0] - shift->x, to[1] - from[1] - shift->y) >
                 far * reach * shift->size;
        });
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
  const Eyes eyes(track);
  if (const double reach = reach_of(track, eyes); reach > 0) {
    repairs.glitches = drop_glitches(track, eyes, reach);
    repairs.slips = drop_slips(track, reach);
  }
  fill_points(track, repairs);
  fill_frames(track, repairs);
  return repairs;
}

}  // namespace animeme::exchange

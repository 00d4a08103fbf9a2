// Finds the frames of a recording that show the neutral face. landmarks.h describes the rule.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "fap/detail/landmark_face.h"
#include "fap/detail/quantile.h"

namespace animeme::fap::internal {
namespace {

constexpr double kOpenEyes = 0.7;    // of the median opening
constexpr double kEnds = 0.05;       // of the frames: the range of the gap without them
constexpr double kClosedLips = 0.1;  // of that range

struct Pair {
  std::string_view a;
  std::string_view b;
};

// What a frame shows, as shares of the distance of the eyes, so that neither size nor turn of the
// head count.
struct Look {
  std::size_t frame = 0;
  double lids = 0;
  double gap = 0;
  std::array<double, 3> mouth{};  // lips apart, mouth wide, chin down
  double motion = 0;
};

// Mean of the distances that are seen.
std::optional<double> mean_distance(const TrackedFace& face, std::size_t frame,
                                    std::initializer_list<Pair> pairs) {
  double sum = 0;
  int count = 0;
  for (const Pair& pair : pairs) {
    const auto length = face.distance(frame, pair.a, pair.b);
    if (!length) continue;
    sum += *length;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::optional<Look> look(const TrackedFace& face, std::size_t frame) {
  const auto size = mean_distance(face, frame, {{"3.7", "3.12"}, {"3.1", "3.2"}, {"3.11", "3.8"}});
  const auto lids = mean_distance(face, frame, {{"3.1", "3.3"}, {"3.2", "3.4"}});
  const auto gap = face.distance(frame, "2.2", "2.3");
  const auto width = face.distance(frame, "8.3", "8.4");
  if (!size || !(*size > 0) || !lids || !gap || !width) return std::nullopt;
  if (!face.pose(face.at(frame), frame)) return std::nullopt;
  const double chin = face.distance(frame, "9.15", "2.1").value_or(0);
  return Look{frame, *lids / *size, *gap / *size, {*gap / *size, *width / *size, chin / *size}, 0};
}

double step(const Look& a, const Look& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.mouth.size(); ++i) sum += std::abs(a.mouth[i] - b.mouth[i]);
  return sum;
}

}  // namespace

std::vector<std::size_t> find_neutral_frames(const TrackedFace& face) {
  std::vector<Look> looks;
  for (std::size_t frame = 0; frame < face.frames(); ++frame) {
    if (const auto seen = look(face, frame)) looks.push_back(*seen);
  }
  if (looks.empty()) return {};
  Look* before = nullptr;
  for (Look& one : looks) {
    if (before != nullptr) {
      const double moved = step(*before, one);
      before->motion += moved;
      one.motion += moved;
    }
    before = &one;
  }
  // The ends have one neighbour.
  looks.front().motion *= 2;
  looks.back().motion *= 2;
  std::vector<double> lids;
  std::vector<double> gaps;
  for (const Look& one : looks) {
    lids.push_back(one.lids);
    gaps.push_back(one.gap);
  }
  const double open = kOpenEyes * median_of(lids);
  const double low = detail::quantile(gaps, kEnds);
  const double closed = low + kClosedLips * (detail::quantile(gaps, 1 - kEnds) - low);
  std::vector<Look> calm;
  for (const Look& one : looks) {
    if (one.lids >= open && one.gap <= closed) calm.push_back(one);
  }
  std::stable_sort(calm.begin(), calm.end(),
                   [](const Look& a, const Look& b) { return a.motion < b.motion; });
  calm.resize((calm.size() + 1) / 2);
  std::vector<std::size_t> frames;
  for (const Look& one : calm) frames.push_back(one.frame);
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace animeme::fap::internal

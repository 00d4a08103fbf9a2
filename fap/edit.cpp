#include "fap/edit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "fap/detail/symmetry.h"
#include "fap/tables.h"

namespace animeme::fap {
namespace {

constexpr int kMostIntensity = 63;

Mask faps_of(std::initializer_list<std::pair<int, int>> ranges) {
  Mask faps;
  for (const auto& [first, last] : ranges) {
    for (int fap = first; fap <= last; ++fap) faps.set(std::size_t(fap));
  }
  return faps;
}

std::int32_t rounded(double value) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return std::int32_t(std::llround(std::clamp(value, -kMost, kMost)));
}

// 0..1 to 0..1, without a corner at either end.
double eased(double share) {
  return 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(share, 0.0, 1.0));
}

double frames_of(Rate rate, double seconds) {
  return std::max(seconds, 0.0) * rate.frames_per_second();
}
double frames_of(const Sequence& clip, double seconds) { return frames_of(clip.rate, seconds); }

void scale_intensities(Expression& expression, double factor) {
  for (std::int32_t* value : {&expression.intensity1, &expression.intensity2}) {
    *value = std::clamp(rounded(*value * factor), 0, kMostIntensity);
  }
}

// `weight` of one value and the rest of another.
std::int32_t mixed(std::int32_t a, std::int32_t b, double weight) {
  return rounded(a * weight + b * (1 - weight));
}

// Low-level FAPs of two frames, with `weight` of `a`; FAP 1 and 2 are those of the larger one.
void mix(Frame& into, const Frame& a, const Frame& b, const Mask& faps, double weight) {
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (faps[fap]) into.value[fap] = mixed(a.value[fap], b.value[fap], weight);
  }
  const Frame& larger = weight >= 0.5 ? a : b;
  if (faps[1]) into.viseme = larger.viseme;
  if (faps[2]) into.expression = larger.expression;
}

}  // namespace

std::span<const Region> regions() {
  static const std::array<Region, 11> all = {{
      {"lips", faps_of({{1, 1}, {4, 13}, {16, 18}, {51, 60}})},
      {"jaw", faps_of({{3, 3}, {14, 15}})},
      {"brows", faps_of({{31, 38}})},
      {"lids", faps_of({{19, 22}})},
      {"gaze", faps_of({{23, 30}})},
      {"cheeks", faps_of({{39, 42}})},
      {"nose", faps_of({{61, 64}})},
      {"tongue", faps_of({{43, 47}})},
      {"head", faps_of({{48, 50}})},
      {"ears", faps_of({{65, 68}})},
      {"expression", faps_of({{2, 2}})},
  }};
  return all;
}

std::optional<Mask> region_faps(std::string_view name) {
  for (const Region& region : regions()) {
    if (region.name == name) return region.faps;
  }
  return std::nullopt;
}

void scale(Sequence& clip, const Mask& faps, double factor) {
  for (Frame& frame : clip.frames) {
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (faps[fap]) frame.value[fap] = rounded(frame.value[fap] * factor);
    }
    if (faps[2]) scale_intensities(frame.expression, factor);
  }
}

double smooth_reach(Rate rate, double seconds) {
  return std::ceil(3 * (frames_of(rate, seconds) / 2));
}

void smooth(Sequence& clip, const Mask& faps, double seconds) {
  const double deviation = frames_of(clip, seconds) / 2;
  if (deviation <= 0 || clip.frames.empty()) return;
  const auto count = std::ptrdiff_t(clip.frames.size());
  const auto reach = std::ptrdiff_t(std::min(smooth_reach(clip.rate, seconds), double(count)));
  std::vector<double> weight(std::size_t(2 * reach + 1));
  double sum = 0;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
    const double x = double(k) / deviation;
    sum += weight[std::size_t(k + reach)] = std::exp(-0.5 * x * x);
  }
  std::vector<double> before(clip.frames.size());
  for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (!faps[fap]) continue;
    for (std::size_t i = 0; i < before.size(); ++i) before[i] = clip.frames[i].value[fap];
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      double value = 0;
      for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
        const auto at = std::clamp<std::ptrdiff_t>(i + k, 0, count - 1);
        value += weight[std::size_t(k + reach)] * before[std::size_t(at)];
      }
      clip.frames[std::size_t(i)].value[fap] = rounded(value / sum);
    }
  }
}

void mirror(Sequence& clip) {
  for (Frame& frame : clip.frames) {
    const Frame before = frame;
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      const internal::MirrorImage image = internal::mirror_image(fap);
      frame.value[std::size_t(fap)] = image.sign * before.value[std::size_t(image.fap)];
      frame.mask[std::size_t(fap)] = before.mask[std::size_t(image.fap)];
    }
  }
}

void fade(Sequence& clip, double in, double out) {
  fade(clip, in, out, {0, std::int64_t(clip.frames.size())});
}

void fade(Sequence& piece, double in, double out, const PieceOf& place) {
  const double rise = frames_of(piece, in), fall = frames_of(piece, out);
  const auto count = double(place.frames);
  for (std::size_t k = 0; k < piece.frames.size(); ++k) {
    const double i = double(place.first + std::int64_t(k));
    const double from_begin = rise > 0 ? eased(i / rise) : 1;
    const double from_end = fall > 0 ? eased((count - 1 - i) / fall) : 1;
    const double factor = std::min(from_begin, from_end);
    if (factor >= 1) continue;
    Frame& frame = piece.frames[k];
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      frame.value[fap] = rounded(frame.value[fap] * factor);
    }
    scale_intensities(frame.expression, factor);
  }
}

void replace(Sequence& clip, const Sequence& from, const Mask& faps, double cross_fade) {
  replace(clip, from, faps, cross_fade, {0, std::int64_t(clip.frames.size())},
          std::int64_t(from.frames.size()));
}

void replace(Sequence& piece, const Sequence& from, const Mask& faps, double cross_fade,
             const PieceOf& place, std::int64_t taken) {
  if (from.frames.empty()) return;
  const double blend = frames_of(piece, cross_fade);
  const bool ends = taken < place.frames;
  const Mask source = from.frames.front().mask;
  for (std::size_t i = 0; i < piece.frames.size(); ++i) {
    Frame& frame = piece.frames[i];
    frame.mask |= source & faps;
    if (i >= from.frames.size()) continue;
    const double left = double(taken) - double(place.first + std::int64_t(i));
    const double weight = ends && blend > 0 ? eased(left / blend) : 1;
    mix(frame, from.frames[i], Frame(frame), faps, weight);
  }
}

void append(Sequence& clip, const Sequence& next, double cross_fade) {
  if (next.frames.empty()) return;
  if (clip.frames.empty()) {
    clip.frames = next.frames;
    for (std::size_t i = 0; i < clip.frames.size(); ++i) clip.frames[i].number = std::int64_t(i);
    return;
  }
  const Mask all = clip.frames.front().mask | next.frames.front().mask;
  const Frame last = clip.frames.back();
  const double blend = frames_of(clip, cross_fade);
  for (Frame& frame : clip.frames) frame.mask = all;
  for (std::size_t i = 0; i < next.frames.size(); ++i) {
    Frame frame = next.frames[i];
    frame.number = std::int64_t(clip.frames.size());
    frame.mask = all;
    if (double(i) < blend)
      mix(frame, next.frames[i], last, all, eased((double(i) + 1) / (blend + 1)));
    clip.frames.push_back(frame);
  }
}

}  // namespace animeme::fap

#include "dam/signal/closure.h"

#include <algorithm>
#include <cmath>

#include "dam/maths/raised_cosine.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

constexpr double kHalfWidth = 0.050;  // seconds added to half the phone on both sides
constexpr double kUpperShare = 0.3;
constexpr double kLetGo = 0.050;  // seconds from a closure that lasts to where nothing is moved

std::ptrdiff_t channel_of(std::span<const std::string> names, int fap) {
  for (std::size_t c = 0; c < names.size(); ++c)
    if (fap_of_channel(names[c]) == fap) return std::ptrdiff_t(c);
  return -1;
}

std::optional<LipChannels> channels_of(std::span<const std::string> names, int upper, int lower) {
  const auto u = channel_of(names, upper), l = channel_of(names, lower);
  if (u < 0 || l < 0) return std::nullopt;
  return LipChannels{std::size_t(u), std::size_t(l)};
}

/// One place along the lips that has both inner channels, and the outer ones (-1: none).
struct LipPair {
  LipChannels inner;
  std::ptrdiff_t outer_upper, outer_lower;
};

/// The middle first, if it is there.
std::vector<LipPair> lip_pairs(std::span<const std::string> names) {
  constexpr int kFaps[][4] = {{4, 5, 51, 52}, {8, 10, 55, 57}, {9, 11, 56, 58}};
  std::vector<LipPair> pairs;
  for (const auto& faps : kFaps)
    if (const auto inner = channels_of(names, faps[0], faps[1]))
      pairs.push_back({*inner, channel_of(names, faps[2]), channel_of(names, faps[3])});
  return pairs;
}

/// Tells `add` by how much each channel moves when the lips come together by `gap`.
template <class Add>
void close_pair(const LipPair& pair, double gap, const ClosureOptions& options, const Add& add) {
  add(pair.inner.upper, kUpperShare * gap);
  add(pair.inner.lower, (1 - kUpperShare) * gap);
  if (pair.outer_upper >= 0)
    add(std::size_t(pair.outer_upper), options.upper_follow * kUpperShare * gap);
  if (pair.outer_lower >= 0)
    add(std::size_t(pair.outer_lower), options.lower_follow * (1 - kUpperShare) * gap);
}

/// Calls use(frame, share) around the frame in which a phone has its contact.
template <class Use>
void around_contact(const Signal& signal, const Phone& phone, std::size_t frame, const Use& use) {
  const double centre = signal.time(frame);
  const double half_width = phone.duration() / 2 + kHalfWidth;
  const FrameSpan span = frames_near(signal, {centre, centre, {}, {}}, half_width);
  for (std::size_t i = span.first; i < span.last; ++i) {
    const double x = (signal.time(i) - centre) / half_width;
    if (std::abs(x) < 1) use(i, raised_bell(x));
  }
}

std::size_t least_gap_at(const Signal& signal, const FrameSpan& search, const LipChannels& lips) {
  std::size_t least = search.first;
  for (std::size_t i = search.first; i < search.last; ++i)
    if (inner_gap(signal, i, lips) < inner_gap(signal, least, lips)) least = i;
  return least;
}

/// Frames from `from` to where the gap passes kClosedGap going by `step`, `reach` at most. Counted
/// from there, so that a piece of a clip gives the same numbers.
double shut_frames_from(const Signal& signal, std::size_t from, int step, const LipChannels& lips,
                        double reach) {
  const auto at = [&](int away) {
    return inner_gap(signal, std::size_t(std::ptrdiff_t(from) + step * away), lips);
  };
  const auto room = int(step < 0 ? from : signal.frames() - 1 - from);
  int away = 0;
  for (; away < room && away < reach; ++away) {
    const double a = at(away), b = at(away + 1);
    if (b >= kClosedGap) return std::min(reach, away + (kClosedGap - a) / (b - a));
  }
  return std::min(reach, double(away));
}

/// Holds lips that are shut around a phone together for the time that it takes.
void hold_shut(Signal& signal, const Phone& phone, const std::vector<LipPair>& pairs,
               const ClosureOptions& options) {
  const double wanted = options.duration->of(phone.duration());
  const auto now = closed_span(signal, phone, pairs[0].inner, wanted);
  if (!now) return;
  const double rate = signal.rate.frames_per_second(), half = wanted * rate / 2;
  if (now->frames() >= 2 * half) return;
  const double centre = (now->after - now->before) / 2, let_go = kLetGo * rate;  // from the least
  const auto reach = std::ptrdiff_t(std::ceil(std::abs(centre) + half + let_go));
  for (std::ptrdiff_t n = -reach; n <= reach; ++n) {
    const std::ptrdiff_t frame = std::ptrdiff_t(now->least) + n;
    if (frame < 0 || frame >= std::ptrdiff_t(signal.frames())) continue;
    const auto i = std::size_t(frame);
    const double away = std::abs(double(n) - centre);
    // Shut in the middle, just open at the edge.
    const double x = half > 0 ? away / half : 0;
    const double level = options.target + (kClosedGap - options.target) * x * x;
    const double share = 1 - raised_step((away - half) / let_go);
    for (const LipPair& pair : pairs) {
      const double gap = inner_gap(signal, i, pair.inner) - level;
      if (gap > 0)
        close_pair(pair, share * gap, options,
                   [&](std::size_t channel, double value) { signal.at(i, channel) += value; });
    }
  }
}

bool close_phone(Signal& signal, const Phone& phone, const std::vector<LipPair>& pairs,
                 const ClosureOptions& options) {
  const LipChannels& middle = pairs[0].inner;
  const FrameSpan search = frames_near(signal, phone, kClosureSearch);
  const std::size_t least = least_gap_at(signal, search, middle);
  if (search.first == search.last || !(inner_gap(signal, least, middle) > options.target))
    return false;
  for (const LipPair& pair : pairs) {
    const double amount = inner_gap(signal, least, pair.inner) - options.target;
    if (!(amount > 0)) continue;
    around_contact(signal, phone, least, [&](std::size_t i, double share) {
      close_pair(pair, amount * share, options,
                 [&](std::size_t channel, double value) { signal.at(i, channel) += value; });
    });
  }
  return true;
}

bool raise_to_teeth(Signal& signal, const Phone& phone, const std::vector<LipPair>& pairs,
                    double raise, const ClosureOptions& options) {
  const std::size_t lower = pairs[0].inner.lower;
  const FrameSpan search = frames_near(signal, phone, kClosureSearch);
  std::size_t highest = search.first;
  for (std::size_t i = search.first; i < search.last; ++i)
    if (signal.at(i, lower) > signal.at(highest, lower)) highest = i;
  if (search.first == search.last || !(signal.at(highest, lower) < raise)) return false;
  const double missing = raise - signal.at(highest, lower);
  around_contact(signal, phone, highest, [&](std::size_t i, double share) {
    for (const LipPair& pair : pairs) {
      const double room = std::max(0.0, inner_gap(signal, i, pair.inner) - kLeastOpen);
      const double moved = std::min(missing * share, room);
      signal.at(i, pair.inner.lower) += moved;
      if (pair.outer_lower >= 0)
        signal.at(i, std::size_t(pair.outer_lower)) += options.lower_follow * moved;
    }
  });
  return true;
}

}  // namespace

void close_pose(std::span<const std::string> names, std::span<double> pose,
                const ClosureOptions& options) {
  for (const LipPair& pair : lip_pairs(names)) {
    const double gap = -(pose[pair.inner.upper] + pose[pair.inner.lower]);
    if (gap > 0)
      close_pair(pair, gap, options,
                 [&](std::size_t channel, double value) { pose[channel] += value; });
  }
}

bool is_labiodental(std::string_view label) {
  const PhoneInfo* info = find_phone(label);
  return info != nullptr && info->labiodental;
}

bool is_bilabial(std::string_view label) {
  const PhoneInfo* info = find_phone(label);
  return info != nullptr && info->bilabial;
}

std::optional<LipChannels> inner_lip_channels(std::span<const std::string> names) {
  return channels_of(names, 4, 5);
}

double ClosureDuration::of(double duration) const {
  return std::clamp(base + slope * duration, 0.0, kLongestClosure);
}

std::optional<ClosedSpan> closed_span(const Signal& signal, const Phone& phone,
                                      const LipChannels& lips, double reach) {
  const FrameSpan search = frames_near(signal, phone, kClosureSearch);
  if (search.first == search.last) return std::nullopt;
  const std::size_t least = least_gap_at(signal, search, lips);
  if (!(inner_gap(signal, least, lips) < kClosedGap)) return std::nullopt;
  const double frames = reach * signal.rate.frames_per_second();
  return ClosedSpan{least, shut_frames_from(signal, least, -1, lips, frames),
                    shut_frames_from(signal, least, 1, lips, frames)};
}

FrameSpan frames_near(const Signal& signal, const Phone& phone, double margin) {
  const double rate = signal.rate.frames_per_second(), frames = double(signal.frames());
  const double first = double(signal.first_frame);
  if (!(phone.start * rate - first < frames)) return {};
  const double from = std::ceil((phone.start - margin) * rate) - first;
  const double to = std::floor((phone.end + margin) * rate) + 1 - first;
  FrameSpan span{std::size_t(std::clamp(from, 0.0, frames)),
                 std::size_t(std::clamp(to, 0.0, frames))};
  if (to <= 0) return {};
  if (span.first >= span.last && frames > 0) {  // low frame rates: the phone falls between frames
    const double nearest = std::round((phone.start + phone.end) / 2 * rate) - first;
    span.first = std::size_t(std::clamp(nearest, 0.0, frames - 1));
    span.last = span.first + 1;
  }
  return span;
}

std::size_t apply_lip_tooth_contact(Signal& signal, const Script& script, double raise,
                                    const ClosureOptions& options) {
  if (!inner_lip_channels(signal.names)) return 0;
  const auto pairs = lip_pairs(signal.names);
  std::size_t repaired = 0;
  for (const Phone& phone : script.phones)
    if (is_labiodental(phone.label) && raise_to_teeth(signal, phone, pairs, raise, options))
      ++repaired;
  return repaired;
}

std::size_t apply_contact(Signal& signal, const ClosureOptions& options) {
  std::size_t touched = 0;
  const auto pairs = lip_pairs(signal.names);
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    bool moved = false;
    for (const LipPair& pair : pairs) {
      const double overlap = options.least - inner_gap(signal, i, pair.inner);
      if (!(overlap > 0)) continue;
      moved = true;
      const auto open = [&](std::ptrdiff_t channel, double share) {
        if (channel >= 0) signal.at(i, std::size_t(channel)) -= share * overlap / 2;
      };
      open(std::ptrdiff_t(pair.inner.upper), 1);
      open(std::ptrdiff_t(pair.inner.lower), 1);
      open(pair.outer_upper, options.upper_follow);
      open(pair.outer_lower, options.lower_follow);
    }
    touched += moved ? 1 : 0;
  }
  return touched;
}

std::size_t apply_closure(Signal& signal, const Script& script, const ClosureOptions& options) {
  if (!inner_lip_channels(signal.names)) return 0;
  const auto pairs = lip_pairs(signal.names);
  std::size_t closed = 0;
  for (const Phone& phone : script.phones) {
    if (!is_bilabial(phone.label)) continue;
    if (close_phone(signal, phone, pairs, options)) ++closed;
    if (options.duration) hold_shut(signal, phone, pairs, options);
  }
  return closed;
}

}  // namespace animeme::dam

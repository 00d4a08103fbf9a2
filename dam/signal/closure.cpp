#include "dam/signal/closure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dam/maths/raised_cosine.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

constexpr double kHalfWidth = 0.050;  // seconds added to half the phone on both sides
constexpr double kUpperShare = 0.3;

std::ptrdiff_t channel_of(std::span<const std::string> names, int fap) {
  for (std::size_t c = 0; c < names.size(); ++c)
    if (fap_of_channel(names[c]) == fap) return std::ptrdiff_t(c);
  return -1;
}

/// One place along the lips: inner upper, inner lower, outer upper, outer lower channel (-1: none).
struct LipPair {
  std::ptrdiff_t upper, lower, outer_upper, outer_lower;
};

std::array<LipPair, 3> lip_pairs(std::span<const std::string> names) {
  const auto at = [&](int fap) { return channel_of(names, fap); };
  return {{{at(4), at(5), at(51), at(52)},
           {at(8), at(10), at(55), at(57)},
           {at(9), at(11), at(56), at(58)}}};
}

void close_pair(Signal& signal, const LipPair& pair, const FrameSpan& span, double centre,
                double half_width, double amount, const ClosureOptions& options) {
  const auto add = [&](std::size_t frame, std::ptrdiff_t channel, double value) {
    if (channel >= 0) signal.at(frame, std::size_t(channel)) += value;
  };
  for (std::size_t i = span.first; i < span.last; ++i) {
    const double x = (signal.time(i) - centre) / half_width;
    if (std::abs(x) >= 1) continue;
    const double shift = amount * raised_bell(x);
    add(i, pair.upper, kUpperShare * shift);
    add(i, pair.lower, (1 - kUpperShare) * shift);
    add(i, pair.outer_upper, options.upper_follow * kUpperShare * shift);
    add(i, pair.outer_lower, options.lower_follow * (1 - kUpperShare) * shift);
  }
}

bool close_phone(Signal& signal, const Phone& phone, const std::array<LipPair, 3>& pairs,
                 const ClosureOptions& options) {
  const LipChannels middle{std::size_t(pairs[0].upper), std::size_t(pairs[0].lower)};
  const FrameSpan search = frames_near(signal, phone, kClosureSearch);
  std::size_t least = search.first;
  for (std::size_t i = search.first; i < search.last; ++i)
    if (inner_gap(signal, i, middle) < inner_gap(signal, least, middle)) least = i;
  if (search.first == search.last || !(inner_gap(signal, least, middle) > options.target))
    return false;
  const double centre = signal.time(least);
  const double half_width = phone.duration() / 2 + kHalfWidth;
  const FrameSpan span = frames_near(signal, {centre, centre, {}, {}}, half_width);
  for (const LipPair& pair : pairs) {
    if (pair.upper < 0 || pair.lower < 0) continue;
    const LipChannels lips{std::size_t(pair.upper), std::size_t(pair.lower)};
    const double amount = inner_gap(signal, least, lips) - options.target;
    if (amount > 0) close_pair(signal, pair, span, centre, half_width, amount, options);
  }
  return true;
}

bool raise_to_teeth(Signal& signal, const Phone& phone, const std::array<LipPair, 3>& pairs,
                    double raise, const ClosureOptions& options) {
  const auto lower = std::size_t(pairs[0].lower);
  const FrameSpan search = frames_near(signal, phone, kClosureSearch);
  std::size_t highest = search.first;
  for (std::size_t i = search.first; i < search.last; ++i)
    if (signal.at(i, lower) > signal.at(highest, lower)) highest = i;
  if (search.first == search.last || !(signal.at(highest, lower) < raise)) return false;
  const double missing = raise - signal.at(highest, lower);
  const double centre = signal.time(highest);
  const double half_width = phone.duration() / 2 + kHalfWidth;
  const FrameSpan span = frames_near(signal, {centre, centre, {}, {}}, half_width);
  for (std::size_t i = span.first; i < span.last; ++i) {
    const double x = (signal.time(i) - centre) / half_width;
    if (std::abs(x) >= 1) continue;
    const double shift = missing * raised_bell(x);
    for (const LipPair& pair : pairs) {
      if (pair.upper < 0 || pair.lower < 0) continue;
      const LipChannels lips{std::size_t(pair.upper), std::size_t(pair.lower)};
      const double room = std::max(0.0, inner_gap(signal, i, lips) - kLeastOpen);
      const double moved = std::min(shift, room);
      signal.at(i, lips.lower) += moved;
      if (pair.outer_lower >= 0)
        signal.at(i, std::size_t(pair.outer_lower)) += options.lower_follow * moved;
    }
  }
  return true;
}

}  // namespace

void close_pose(std::span<const std::string> names, std::span<double> pose,
                const ClosureOptions& options) {
  const auto add = [&](std::ptrdiff_t channel, double value) {
    if (channel >= 0) pose[std::size_t(channel)] += value;
  };
  for (const LipPair& pair : lip_pairs(names)) {
    if (pair.upper < 0 || pair.lower < 0) continue;
    const double gap = -(pose[std::size_t(pair.upper)] + pose[std::size_t(pair.lower)]);
    if (!(gap > 0)) continue;
    add(pair.upper, kUpperShare * gap);
    add(pair.lower, (1 - kUpperShare) * gap);
    add(pair.outer_upper, options.upper_follow * kUpperShare * gap);
    add(pair.outer_lower, options.lower_follow * (1 - kUpperShare) * gap);
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
  const auto upper = channel_of(names, 4), lower = channel_of(names, 5);
  if (upper < 0 || lower < 0) return std::nullopt;
  return LipChannels{std::size_t(upper), std::size_t(lower)};
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
      if (pair.upper < 0 || pair.lower < 0) continue;
      const LipChannels lips{std::size_t(pair.upper), std::size_t(pair.lower)};
      const double overlap = options.least - inner_gap(signal, i, lips);
      if (!(overlap > 0)) continue;
      moved = true;
      const auto open = [&](std::ptrdiff_t channel, double share) {
        if (channel >= 0) signal.at(i, std::size_t(channel)) -= share * overlap / 2;
      };
      open(pair.upper, 1);
      open(pair.lower, 1);
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
  for (const Phone& phone : script.phones)
    if (is_bilabial(phone.label) && close_phone(signal, phone, pairs, options)) ++closed;
  return closed;
}

}  // namespace animeme::dam

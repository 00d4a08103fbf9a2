#include "codec/encode/live_settings_internal.h"

#include <bitset>

#include "codec/syntax/quantise_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

std::int32_t face_step(std::size_t fap, const LiveOptions& options) {
  return step_at(false, fap::info(int(fap)).quant_step, options.fap_quant);
}
std::int32_t body_step(std::size_t slot, const LiveOptions& options) {
  return step_at(true, kBapSteps[slot], options.bap_quant);
}

// For the largest change that was seen and half as much again.
std::uint8_t predictive_range(std::int64_t largest, int scale) {
  return std::uint8_t(std::clamp(range_number(largest + largest / 2, scale), 1, kMaxRange));
}

std::uint8_t face_range(std::size_t fap, const Motion& motion, const LiveOptions& options,
                        bool young) {
  if (options.ranges) return motion.ranges[fap];
  const std::uint8_t seen =
      predictive_range(motion.face.largest(fap), scale_at(false, options.fap_quant));
  if (!young) return seen;
  const int usual = range_number(fap::info(int(fap)).default_p_range, 1);
  return std::max(seen, std::uint8_t(std::clamp(usual, 1, kMaxRange)));
}

// The tightest range, and `wider` more on its upper side, or its lower one where that is full.
template <class Settings>
void set_intra_range(Settings& settings, std::size_t number, std::int64_t level, int scale,
                     int wider) {
  const auto reach = [&](std::int64_t most) {
    return std::min(range_number(std::max<std::int64_t>(most, 0), scale), kMaxRange);
  };
  const int up = reach(level);
  const int down = reach(-level);
  const int more = std::min(wider, kMaxRange - up);
  settings.range[kIntraMax][number] = std::uint8_t(up + more);
  settings.range[kIntraMin][number] = std::uint8_t(std::min(down + wider - more, kMaxRange));
}

// Groups whose FAPs follow the other side and nothing else: not jaw, lips, tongue and head.
bool has_sides(int group) {
  constexpr std::array kGroups = {3, 4, 5, 9, 10};
  return std::find(kGroups.begin(), kGroups.end(), group) != kGroups.end();
}

// FAPs that receivers mirror. Notes which ones differ from their other side.
fap::Mask mirrored(HeldFrame& held) {
  fap::Mask equal;
  std::bitset<fap::kGroupCount> unlike;  // a FAP would be mirrored that nobody gives
  for (const fap::FapInfo& fap : fap::kFaps) {
    const auto own = std::size_t(fap.number), other = std::size_t(fap.mirror);
    if (other == 0 || !has_sides(fap.group) || !held.occurred[other]) continue;
    if (!held.occurred[own]) unlike.set(std::size_t(fap.group - 1));
    if (own < other) continue;
    if (held.face.value[own] != held.face.value[other]) held.differs.set(own);
    equal[own] = held.occurred[own] && !held.differs[own];
  }
  for (const fap::FapInfo& fap : fap::kFaps) {
    if (unlike[std::size_t(fap.group - 1)]) equal.reset(std::size_t(fap.number));
  }
  return equal;
}

std::bitset<fap::kGroupCount> groups_of(const fap::Mask& faps) {
  std::bitset<fap::kGroupCount> groups;
  for (const fap::FapInfo& fap : fap::kFaps) {
    if (faps[std::size_t(fap.number)]) groups.set(std::size_t(fap.group - 1));
  }
  return groups;
}

// By how much so many detours widen the parameter whose turn this is.
int wider(const HeldFrame& held, std::size_t turn, int detour) {
  const std::size_t coded = held.low_level_count() + held.body_count();
  return int((std::size_t(detour * detour) + coded - 1 - turn) / coded);
}

}  // namespace

void HeldFrame::take_in(const fap::Frame& frame, const BodyFrame* given_body,
                        const LiveOptions& options) {
  fap::Mask mask = frame.mask;
  if (options.faps) mask &= *options.faps;
  occurred |= mask;
  if (options.faps) occurred = *options.faps;
  occurred.reset(0);  // no FAP
  if (mask[1]) face.viseme = frame.viseme;
  if (mask[2]) face.expression = frame.expression;
  keep_legal(face.viseme, face.expression, options.fap_quant);
  if (!mask[1]) face.viseme.def = false;
  if (!mask[2]) face.expression.def = face.expression.init_face = false;
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (mask[fap]) face.value[fap] = frame.value[fap];
  }
  face.mask = occurred;
  if (options.mirror) face.mask &= ~mirrored(*this);
  if (given_body == nullptr) return;
  has_body = true;
  body.mask |= given_body->mask;
  body.mask.reset(0);
  guard_last_group(body.mask);
  for (std::size_t bap = 1; bap <= std::size_t(kBapCount); ++bap) {
    if (given_body->mask[bap]) body.value[bap] = given_body->value[bap];
  }
}

void Motion::see(const HeldFrame& held, const Shown& last, const LiveOptions& options) {
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!last.face.mask[fap]) continue;
    const std::int64_t change = std::int64_t(held.face.value[fap]) - last.face.value[fap];
    const std::int64_t level = quantise(change, face_step(fap, options));
    face.see(fap, level);
    const int needed = range_number(std::abs(level), scale_at(false, options.fap_quant));
    if (needed <= kMaxRange) ranges[fap] = std::max(ranges[fap], std::uint8_t(needed));
  }
  for (std::size_t slot = 0; slot < kBapOrder.size(); ++slot) {
    const std::size_t bap = kBapOrder[slot];
    if (!last.body.mask[bap]) continue;
    const std::int64_t change = std::int64_t(held.body.value[bap]) - last.body.value[bap];
    body.see(bap, quantise(change, body_step(slot, options)));
  }
}

void limit(HeldFrame& held, const LiveOptions& options) {
  const auto limit_value = [](std::int32_t& value, std::int64_t step, int scale) {
    const std::int64_t most = level_range(kMaxRange, scale) * step;
    if (std::abs(std::int64_t(value)) > most + step / 2) {
      value = std::int32_t(value > 0 ? most : -most);
    }
  };
  for (std::size_t fap = fap::kFirstLowLevel; options.fap_quant != 0 && fap <= fap::kFapCount;
       ++fap) {
    limit_value(held.face.value[fap], face_step(fap, options), scale_at(false, options.fap_quant));
  }
  for (std::size_t slot = 0; options.bap_quant != 0 && slot < kBapOrder.size(); ++slot) {
    limit_value(held.body.value[kBapOrder[slot]], body_step(slot, options),
                scale_at(true, options.bap_quant));
  }
}

Outlook look_ahead(const HeldFrame& held, std::uint32_t skip,
                   const std::deque<WaitingFrame>& coming, std::int64_t period, bool last,
                   const LiveOptions& options) {
  Outlook outlook;
  if (coming.empty() && !last) return outlook;
  HeldFrame next = held;
  // As receivers will have them.
  std::array<std::int64_t, fap::kFapCount + 1> face{};
  std::array<std::int64_t, kBapCount + 1> body{};
  const auto follow = [](std::int64_t& value, std::int64_t wanted, std::int64_t step, int scale,
                         std::uint8_t& up, std::uint8_t& down) {
    const std::int64_t change = quantise(wanted - value, step);
    value += change * step;
    std::uint8_t& side = change < 0 ? down : up;
    const int needed = range_number(std::abs(change), scale);
    side = std::max(side, std::uint8_t(std::min(needed, kMaxRange)));
    return needed <= kMaxRange;
  };
  // False: there is a change that no predictive plane can code.
  const auto follow_all = [&](Outlook& seen) {
    bool fits = true;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!held.face.mask[fap]) continue;
      fits &= follow(face[fap], next.face.value[fap], face_step(fap, options),
                     scale_at(false, options.fap_quant), seen.up[fap], seen.down[fap]);
    }
    for (std::size_t slot = 0; held.has_body && slot < kBapOrder.size(); ++slot) {
      const std::size_t bap = kBapOrder[slot];
      if (!held.body.mask[bap]) continue;
      fits &= follow(body[bap], next.body.value[bap], body_step(slot, options),
                     scale_at(true, options.bap_quant), seen.body_up[bap], seen.body_down[bap]);
    }
    return fits;
  };
  Outlook of_intra;  // whose ranges are its own
  follow_all(of_intra);
  std::int64_t frames = 1 + std::int64_t(skip);
  outlook.complete = last;
  for (const WaitingFrame& frame : coming) {
    next.take_in(frame.face, frame.body ? &*frame.body : nullptr, options);
    if ((period > 0 && frames >= period) || next.face.mask != held.face.mask ||
        next.has_body != held.has_body || next.body.mask != held.body.mask) {
      outlook.complete = true;  // there is the next intra plane
      break;
    }
    Outlook with_frame = outlook;
    if (!follow_all(with_frame)) {
      outlook.complete = true;  // likewise
      break;
    }
    outlook = with_frame;
    frames += 1 + std::int64_t(frame.skip);
  }
  outlook.complete |= period > 0 && frames >= period;
  return outlook;
}

FaceSettings settle_face(const HeldFrame& held, const Motion& motion, const LiveOptions& options,
                         const Outlook& outlook, bool young, int detour) {
  FaceSettings face;
  face.fap_quant = options.fap_quant;
  face.send_range = {true, true, true, true};
  face.mask = held.face.mask;
  set_mask_types(face, groups_of(held.occurred & ~held.face.mask));
  std::size_t turn = held.low_level_count();
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!face.mask[fap]) continue;
    --turn;
    set_intra_range(face, fap, quantise(held.face.value[fap], face_step(fap, options)),
                    scale_at(false, options.fap_quant), wider(held, turn, detour));
    std::uint8_t up = outlook.up[fap];
    std::uint8_t down = outlook.down[fap];
    if (!outlook.complete) {
      const std::uint8_t range = face_range(fap, motion, options, young);
      up = std::max(up, range);
      down = std::max(down, range);
    }
    // Zeros of the very last range may reach into the values behind it.
    if (turn == 0 && detour > 0 && down == 0) down = 1;
    face.range[kPredictiveMax][fap] = up;
    face.range[kPredictiveMin][fap] = down;
  }
  guard_fap4(face);
  return face;
}

BodySettings settle_body(const HeldFrame& held, const Motion& motion, const LiveOptions& options,
                         const Outlook& outlook, bool young, int detour) {
  BodySettings body;
  body.bap_quant = options.bap_quant;
  body.send_range = {true, true, true, true};
  body.mask = held.body.mask;
  set_mask_types(body);
  std::size_t turn = held.low_level_count();
  for (std::size_t slot = 0; slot < kBapOrder.size(); ++slot) {
    const std::size_t bap = kBapOrder[slot];
    if (!body.mask[bap]) continue;
    const int scale = scale_at(true, options.bap_quant);
    set_intra_range(body, bap, quantise(held.body.value[bap], body_step(slot, options)), scale,
                    wider(held, turn++, detour));
    std::uint8_t up = outlook.body_up[bap];
    std::uint8_t down = outlook.body_down[bap];
    if (!outlook.complete) {
      const std::uint8_t range =
          young ? std::uint8_t(kMaxRange) : predictive_range(motion.body.largest(bap), scale);
      up = std::max(up, range);
      down = std::max(down, range);
    }
    body.range[kPredictiveMax][bap] = up;
    body.range[kPredictiveMin][bap] = down;
  }
  return body;
}

}  // namespace animeme::fba::internal

namespace animeme::fba {

PredictiveRanges ranges_of(const fap::Sequence& clip, int fap_quant) {
  PredictiveRanges ranges{};
  fap::Frame last;
  for (const fap::Frame& frame : clip.frames) {
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!frame.mask[fap]) continue;
      // Levels of the reconstruction can change by one more than the values.
      const std::int64_t change = std::int64_t(frame.value[fap]) - last.value[fap];
      const std::int32_t step = internal::step_at(false, fap::info(int(fap)).quant_step, fap_quant);
      const std::int64_t level = std::abs(change) / step + 1;
      const int range = internal::range_number(level, internal::scale_at(false, fap_quant));
      if (last.mask[fap]) {
        ranges[fap] = std::max(ranges[fap], std::uint8_t(std::min(range, internal::kMaxRange)));
      }
      last.value[fap] = frame.value[fap];
      last.mask.set(fap);
    }
  }
  return ranges;
}

}  // namespace animeme::fba

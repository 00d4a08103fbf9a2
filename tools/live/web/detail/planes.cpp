#include "tools/live/web/detail/planes.h"

#include "tools/live/web/detail/messages.h"

namespace animeme::web {
namespace {

constexpr std::size_t kMaskAt = 1;  // behind the flags
constexpr std::size_t kMaskBytes = 9;

/// Seven bits a byte, the lowest first; the highest bit: there are more.
void put_number(std::vector<std::uint8_t>& out, std::uint64_t number) {
  for (; number > 127; number >>= 7) out.push_back(std::uint8_t(number | 128));
  out.push_back(std::uint8_t(number));
}

/// 0, -1, 1, -2 ... as 0, 1, 2, 3 ...
void put_signed(std::vector<std::uint8_t>& out, std::int64_t number) {
  put_number(out, number < 0 ? std::uint64_t(-number) * 2 - 1 : std::uint64_t(number) * 2);
}

/// FAP 1 and 2 are written whole; the others as a difference.
void put_change(std::vector<std::uint8_t>& out, int fap, const fap::Frame& from,
                const fap::Frame& to) {
  const auto at = std::size_t(fap);
  if (fap >= fap::kFirstLowLevel) {
    put_signed(out, std::int64_t(to.value[at]) - from.value[at]);
  } else if (fap == 1) {
    const fap::Viseme& shown = to.viseme;
    for (const std::int32_t each : {shown.select1, shown.select2, shown.blend}) {
      put_signed(out, each);
    }
  } else {
    const fap::Expression& shown = to.expression;
    for (const std::int32_t each :
         {shown.select1, shown.intensity1, shown.select2, shown.intensity2}) {
      put_signed(out, each);
    }
  }
}

bool has_changed(int fap, const fap::Frame& from, const fap::Frame& to) {
  const auto at = std::size_t(fap);
  if (!to.mask[at]) return false;
  if (!from.mask[at]) return true;
  if (fap == 1) return from.viseme != to.viseme;
  return fap == 2 ? from.expression != to.expression : from.value[at] != to.value[at];
}

}  // namespace

std::vector<std::uint8_t> PlaneWriter::write(const Plane& plane, const fap::Frame& face) {
  // A removed value, or an earlier plane, cannot be sent as a change.
  const bool gone = (before_.mask & ~face.mask).any();
  const bool whole = plane.intra || !begun_ || gone || plane.time < time_;
  if (whole) {
    before_ = {};
    time_ = 0;
  }
  std::vector<std::uint8_t> out(kMaskAt + kMaskBytes);
  out[0] = std::uint8_t((plane.intra ? kIntra : 0) | (whole ? kWhole : 0));
  put_number(out, plane.time - time_);
  put_number(out, plane.duration);
  put_number(out, plane.bytes);
  for (int fap = 1; fap <= fap::kFapCount; ++fap) {
    if (!has_changed(fap, before_, face)) continue;
    out[kMaskAt + std::size_t(fap - 1) / 8] |= std::uint8_t(1 << (fap - 1) % 8);
    put_change(out, fap, before_, face);
  }
  before_ = face;
  time_ = plane.time;
  begun_ = true;
  return out;
}

}  // namespace animeme::web

#include "codec/decode/plane_header.h"

#include <algorithm>

#include "codec/decode/plane_reader_internal.h"
#include "codec/syntax/bits.h"

namespace animeme::fba {
namespace {

constexpr std::uint32_t kStuffing = 0x7F;
constexpr std::size_t kEnough = 64;  // bytes: rate, time code and a few hundred skipped frames

// Behind the start codes of a unit; false: there is no plane.
bool find_plane(BitReader& in) {
  if (is_object_start(in.peek32())) {
    in.bits(32);
    if (in.peek32() >> 24 == kStuffing) in.bits(8);
  }
  return is_plane_start(in.bits(32));
}

}  // namespace

std::optional<PlaneHeader> read_plane_header(std::span<const std::uint8_t> unit) {
  BitReader in(unit);
  if (!find_plane(in) || in.overrun()) return std::nullopt;
  const std::size_t begin = in.position() / 8;
  BitReader head(unit.subspan(begin, std::min(kEnough, unit.size() - begin)));

  // Never changed: without an intra plane before it no predictive plane is read.
  thread_local internal::StreamState nothing_known;
  internal::ParsedPlane plane;
  const Result<void> parsed = internal::parse_plane(head, nothing_known, false, plane);
  // A predictive plane cannot be read without the planes before it, but that is found out behind
  // its header. The header of an intra plane is complete once its masks have been reached.
  if (!parsed) {
    const bool stopped = parsed.error().code == Code::need_data;
    const bool in_header = plane.progress.stage <= internal::PlaneProgress::Stage::skip;
    if (stopped ? in_header : plane.intra) return std::nullopt;
  }
  return PlaneHeader{plane.intra, plane.object_mask, plane.temporal};
}

}  // namespace animeme::fba

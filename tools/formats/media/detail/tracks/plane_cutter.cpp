#include "tools/formats/media/detail/tracks/plane_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace animeme::media {
namespace {

constexpr std::array<std::uint8_t, 4> kPlaneCode = {0x00, 0x00, 0x01, 0xBB};
constexpr std::size_t kMostShared = 60000;  // bytes; sizes of PES packets have 16 bits
constexpr double kStamp = 1.0 / 90000;      // seconds

}  // namespace

// The decoder knows the end of a plane by what follows, so it gets the next start code ahead.
std::vector<PlaneCutter::Piece> PlaneCutter::cut(std::span<const std::uint8_t> packet, bool intra) {
  const bool plane = packet.size() > kPlaneCode.size() &&
                     std::equal(kPlaneCode.begin(), kPlaneCode.end(), packet.begin());
  const bool goes_on = following_ && plane;
  if (!goes_on) {
    following_ = intra;
    decoder_ = {};
    fed_ = 0;
  }
  std::vector<Piece> pieces;
  if (following_) {
    decoder_.push(packet.subspan(goes_on ? kPlaneCode.size() : 0));
    decoder_.push(kPlaneCode);
    following_ =
        parse(pieces, std::exchange(fed_, fed_ + std::int64_t(packet.size())), packet.size());
  }
  if (!following_) pieces = {{packet.size(), 0}};
  return pieces;
}

// Planes have to fill the packet without a gap; else it is not what it seems.
bool PlaneCutter::parse(std::vector<Piece>& pieces, std::int64_t begin, std::size_t size) {
  std::int64_t at = begin;  // where the next plane has to have its start code, or the object's
  double first = 0;
  for (;;) {
    const Result<fba::Event> event = decoder_.next();
    if (!event && event.error().code == Code::need_data) break;
    if (!event) return false;
    if (event->kind != fba::Event::Kind::plane) continue;
    const fba::Plane& plane = event->plane;
    const std::int64_t code = plane.bit_begin / 8 - std::int64_t(kPlaneCode.size());
    const std::int64_t ahead = pieces.empty() && begin == 0 ? code - at : 0;  // object start code
    if (plane.bit_begin % 8 != 0 || code != at + ahead || ahead < 0 || ahead > 5) return false;
    if (pieces.empty()) first = plane.seconds;
    const std::int64_t end = plane.bit_end / 8 + 1;  // stuffing is a bit or more
    pieces.push_back({std::size_t(end - at), plane.seconds - first});
    at = end;
  }
  return at == begin + std::int64_t(size);
}

fba::AccessUnits share_packets(const fba::AccessUnits& face, double seconds) {
  fba::AccessUnits out{face.config, face.timescale, {}};
  PlaneCutter cutter;
  const auto from_first = [&](const fba::AccessUnit& unit, const fba::AccessUnit& first) {
    return double(unit.time - first.time) / face.timescale;
  };
  for (auto first = face.units.begin(); first != face.units.end();) {
    fba::AccessUnit packet = *first;
    auto end = first + 1;
    for (; end != face.units.end() && !end->intra && from_first(*end, *first) < seconds &&
           packet.bytes.size() + end->bytes.size() <= kMostShared;
         ++end) {
      packet.bytes.insert(packet.bytes.end(), end->bytes.begin(), end->bytes.end());
    }
    const auto& last = *(end - 1);
    packet.duration = last.time + last.duration - first->time;
    const std::vector<PlaneCutter::Piece> pieces = cutter.cut(packet.bytes, packet.intra);
    const bool same =
        std::equal(pieces.begin(), pieces.end(), first, end,
                   [&](const PlaneCutter::Piece& piece, const auto& unit) {
                     const double off = from_first(unit, *first) - piece.seconds;
                     return piece.size == unit.bytes.size() && std::abs(off) < kStamp / 2;
                   });
    if (same) {
      out.units.push_back(std::move(packet));
    } else {
      out.units.insert(out.units.end(), first, end);
    }
    first = end;
  }
  return out;
}

}  // namespace animeme::media

#include "codec/decode/access_unit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "codec/decode/decoder.h"
#include "codec/decode/unit_writer_internal.h"
#include "codec/syntax/bits.h"
#include "codec/syntax/plane.h"

namespace animeme::fba {

namespace {

// Profiles (codec/bitstream.md, section 13): a face alone, or anything with a body. Level 2 is for
// more than 16 or 32 kbit/s in any second.
constexpr std::uint8_t kSimpleFaceLevel1 = 0x61;
constexpr std::uint8_t kSimpleFbaLevel1 = 0x63;
constexpr std::int64_t kFaceLevel1Rate = 16000, kFbaLevel1Rate = 32000;
constexpr std::uint32_t kMinimumTimescale = 10000;  // muxers replace coarser ones
constexpr std::uint32_t kFallbackTimescale = 90000;

struct TimeBase {
  std::uint32_t timescale = kFallbackTimescale;
  std::int64_t frame = 0;  // ticks per frame; 0: rates change, round absolute times
};

// Exact for every rate that the stream can express. Source: tools/formats/media/containers.md,
// section 1.3.
TimeBase time_base(const std::vector<Plane>& planes) {
  const fap::Rate rate = planes.front().rate;
  for (const Plane& plane : planes) {
    if (plane.rate != rate) return {};
  }
  const std::optional<CodedRate> coded = code_rate(rate);
  if (!coded) return {};
  TimeBase base{(16U * coded->frame_rate + coded->sixteenths) * 1000U,
                std::int64_t(16) * (coded->frequency_offset ? 1001 : 1000)};
  if (coded->sixteenths % 2 == 0) {
    base.timescale /= 16;
    base.frame /= 16;
  }
  const std::uint32_t factor = (kMinimumTimescale + base.timescale - 1) / base.timescale;
  base.timescale *= factor;
  base.frame *= factor;
  return base;
}

// The most bits in any second that begins with a plane.
std::int64_t peak_rate(const std::vector<Plane>& planes) {
  std::int64_t peak = 0, bits = 0;
  std::size_t end = 0;
  for (const Plane& first : planes) {
    while (end < planes.size() && planes[end].seconds < first.seconds + 1.0) {
      bits += planes[end].bit_end - planes[end].bit_begin;
      ++end;
    }
    peak = std::max(peak, bits);
    bits -= first.bit_end - first.bit_begin;
  }
  return peak;
}

std::uint8_t profile(const std::vector<Plane>& planes) {
  const bool body = std::any_of(planes.begin(), planes.end(),
                                [](const Plane& plane) { return has_body(plane.object_mask); });
  const bool level2 = peak_rate(planes) > (body ? kFbaLevel1Rate : kFaceLevel1Rate);
  return std::uint8_t((body ? kSimpleFbaLevel1 : kSimpleFaceLevel1) + (level2 ? 1 : 0));
}

std::vector<std::uint8_t> configuration(std::uint8_t profile) {
  BitWriter out;
  out.start_code(kSequenceStart);
  out.bits(profile, 8);
  out.start_code(kVisualObject);
  out.bit(1);                                        // is_visual_object_identifier
  out.bits(profile >= kSimpleFbaLevel1 ? 2 : 1, 4);  // visual_object_verid
  out.bits(1, 3);                                    // visual_object_priority
  out.bits(4, 4);                                    // visual_object_type: FBA
  out.stuff();
  return out.take();
}

}  // namespace

Result<AccessUnits> split_access_units(std::span<const std::uint8_t> stream) {
  Result<DecodedStream> decoded = decode(stream);
  if (!decoded) return decoded.error();
  const std::vector<Plane>& planes = decoded->planes;
  const TimeBase base = time_base(planes);

  AccessUnits out;
  out.config = configuration(profile(planes));
  out.timescale = base.timescale;
  const double start = planes.front().seconds;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    AccessUnit unit;
    unit.bytes = internal::write_unit(stream, planes[i].bit_begin, planes[i].bit_end, i == 0);
    unit.intra = planes[i].intra;
    if (base.frame > 0) {
      unit.time = (planes[i].number - planes.front().number) * base.frame;
    } else {
      unit.time = std::llround((planes[i].seconds - start) * base.timescale);
    }
    unit.duration =
        base.frame > 0 ? base.frame : std::llround(planes[i].rate.seconds(base.timescale));
    if (i > 0)
      out.units.back().duration = std::max<std::int64_t>(1, unit.time - out.units.back().time);
    out.units.push_back(std::move(unit));
  }
  return out;
}

std::vector<std::uint8_t> join_access_units(const AccessUnits& units, bool with_headers) {
  std::vector<std::uint8_t> out;
  if (with_headers) out = units.config;
  for (const AccessUnit& unit : units.units) {
    out.insert(out.end(), unit.bytes.begin(), unit.bytes.end());
  }
  constexpr std::array<std::uint8_t, 4> kEnd = {0x00, 0x00, 0x01, 0xB1};
  out.insert(out.end(), kEnd.begin(), kEnd.end());
  return out;
}

}  // namespace animeme::fba

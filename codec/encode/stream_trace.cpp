#include <algorithm>

#include "codec/encode/stream_trace_internal.h"
#include "codec/syntax/arith.h"
#include "codec/syntax/bits.h"

namespace animeme::fba::internal {

namespace {

constexpr std::size_t kPrefixZeros = 23;  // of a start code, at any bit position
constexpr std::size_t kLookAhead = 14;    // bits that a decoder reads past its segment
static_assert(kManyZeros + kLookAhead == std::size_t(kStuffingRun));

bool bit_at(std::span<const std::uint8_t> bytes, std::size_t bit) {
  return ((bytes[bit / 8] >> (7 - bit % 8)) & 1) != 0;
}

// Zeros just before `end`, not before `begin`.
std::size_t zeros_before(std::span<const std::uint8_t> bytes, std::size_t begin, std::size_t end) {
  std::size_t count = 0;
  while (end > begin && !bit_at(bytes, end - 1)) {
    --end;
    ++count;
  }
  return count;
}

// Behind the last byte comes a start code, if anything: zeros.
std::size_t zeros_from(std::span<const std::uint8_t> bytes, std::size_t begin, std::size_t most) {
  std::size_t count = 0;
  while (count < most && (begin + count >= bytes.size() * 8 || !bit_at(bytes, begin + count))) {
    ++count;
  }
  return count;
}

void add_start_codes(std::span<const std::uint8_t> bytes, const StreamTrace& trace,
                     std::vector<Hazard>& hazards) {
  // 23 zeros at any position hold two whole zero bytes.
  for (std::size_t byte = 0; byte + 1 < bytes.size(); ++byte) {
    if (bytes[byte] != 0 || bytes[byte + 1] != 0) continue;
    std::size_t behind = byte + 2;
    while (behind < bytes.size() && bytes[behind] == 0) ++behind;
    if (behind == bytes.size()) return;
    const std::size_t one = behind * 8 + zeros_from(bytes, behind * 8, 8);
    const std::size_t zeros = zeros_before(bytes, 0, one);
    const bool real =
        one >= kPrefixZeros &&
        std::binary_search(trace.start_codes.begin(), trace.start_codes.end(), one - kPrefixZeros);
    if (zeros >= kPrefixZeros && !real) {
      hazards.push_back({Hazard::Kind::start_code, one - kPrefixZeros});
    }
    byte = behind;
  }
}

void add_look_aheads(std::span<const std::uint8_t> bytes, const StreamTrace& trace,
                     std::vector<Hazard>& hazards) {
  for (const StreamTrace::Segment& segment : trace.segments) {
    const std::size_t tail = zeros_before(bytes, segment.begin, segment.end);
    if (tail + kLookAhead < std::size_t(kStuffingRun)) continue;
    if (tail + zeros_from(bytes, segment.end, kLookAhead) >= std::size_t(kStuffingRun)) {
      hazards.push_back({Hazard::Kind::look_ahead, segment.end - tail});
    }
  }
}

}  // namespace

std::vector<Hazard> find_hazards(std::span<const std::uint8_t> bytes, const StreamTrace& trace) {
  std::vector<Hazard> hazards;
  add_look_aheads(bytes, trace, hazards);
  add_start_codes(bytes, trace, hazards);
  for (const std::size_t bit : trace.lost) hazards.push_back({Hazard::Kind::lost_plane, bit});
  std::stable_sort(hazards.begin(), hazards.end(),
                   [](const Hazard& a, const Hazard& b) { return a.bit < b.bit; });
  return hazards;
}

}  // namespace animeme::fba::internal

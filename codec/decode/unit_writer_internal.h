// One plane as an access unit. Not installed API.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/syntax/bits.h"

namespace animeme::fba::internal {

/// The field skip_frames and, if it is set, the number; 0 may be coded, too.
void write_skip(BitWriter& out, const std::optional<std::uint32_t>& skip);

/// The bits from `begin` to `end` of a stream, which are a plane, shifted to behind a plane start
/// code; `first`: and an object start code. `skip`: the frames that it skips, in place of those
/// that it says; a plane without face and body says none and stays as it is.
std::vector<std::uint8_t> write_unit(std::span<const std::uint8_t> stream, std::int64_t begin,
                                     std::int64_t end, bool first,
                                     std::optional<std::uint32_t> skip = std::nullopt);

}  // namespace animeme::fba::internal

// Bytes as the page holds them: behind a header, deflated, as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/common/json.h"
#include "tools/view/viewer/rig/numbers.h"

namespace animeme::viewer::detail {

/// In a line, ASCII alone; bytes that are no UTF-8 become U+FFFD.
std::string text_of(const tools::Json& json);

/// A length of 32 bits, a header in JSON, the rest.
std::vector<std::uint8_t> with_header(const tools::Json& header, const Bytes& rest);

/// Smaller, as zlib writes it (RFC 1950); other versions of zlib may choose other bytes.
std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes);

std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace animeme::viewer::detail

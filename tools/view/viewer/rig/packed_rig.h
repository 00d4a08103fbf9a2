/// @file
/// A rig as bytes that are small when they are deflated: what the page's WebAssembly moves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fap/head/rig.h"

namespace animeme::viewer::detail {

/// Places are rounded to 1/65535 of the size of their part, moves to 1/32767 of the largest of
/// their target and axis.
std::vector<std::uint8_t> pack_rig(const head::Rig& rig);

/// A rig that pose() may be called with; names of shapes, irises and pupils stay behind. Nothing
/// where the bytes are not those of pack_rig().
std::optional<head::Rig> unpack_rig(std::span<const std::uint8_t> bytes);

}  // namespace animeme::viewer::detail

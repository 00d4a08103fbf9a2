/// @file
/// Scales down textures of heads, to keep pages small for mail and mobile phones.
#pragma once

#include <cstddef>

#include "fap/head/model.h"

namespace animeme::studio {

/// Re-encodes textures with files larger than `most_bytes` as WebP, at most 1024 texels per side,
/// with alpha. Files that would not get smaller are kept. Returns the number re-encoded; takes 0.1
/// s each.
std::size_t shrink_pictures(head::Head& head, std::size_t most_bytes = 250'000);

}  // namespace animeme::studio

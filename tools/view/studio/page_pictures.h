/// @file
/// Textures of heads for pages, which people send by mail and open on phones.
#pragma once

#include <cstddef>

#include "fap/head/model.h"

namespace animeme::studio {

/// Codes pictures of coats again whose files have more than `most_bytes`: as WebP, 1024 texels a
/// side at most, alpha as it is. Those that get no smaller stay. How many were; 0.1 s each.
std::size_t shrink_pictures(head::Head& head, std::size_t most_bytes = 250'000);

}  // namespace animeme::studio

// A JPEG file of a picture.
#pragma once

#include <cstdint>
#include <vector>

#include "fap/result.h"
#include "tools/view/render/image.h"

namespace animeme::studio {

/// Baseline, 4:2:0. The picture is valid, quality 1..100. Errors: out_of_range (memory).
Result<std::vector<std::uint8_t>> jpeg_of(const render::Image& image, int quality);

}  // namespace animeme::studio

// Which of ARKit's shapes people speak with. Internal.
#pragma once

#include <optional>
#include <span>

#include "fap/detail/bounded_fit.h"

namespace animeme::fap::internal {

/// For shapes by their channels, as ShapeFitter has them: those of ARKit count if they have a jaw,
/// else moods alone. `share`: of the usual sparsity; 0: none.
Sparsity sparsity_of(std::span<const std::optional<int>> channels, double share);

/// The FAPs of a frame that count. A chin that nobody measured is 0 and would keep the jaw from
/// opening, cheeks would keep the lips from rounding: FAP 14, 18 and 39 to 42 at 0 do not.
Mask without_unmeasured(const Frame& frame);

}  // namespace animeme::fap::internal

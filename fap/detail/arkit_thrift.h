// Which of ARKit's shapes people speak with. Internal.
#pragma once

#include <vector>

#include "fap/detail/bounded_fit.h"

namespace animeme::fap::internal {

/// Channel of a shape that is none of ARKit's.
inline constexpr std::size_t kNoChannel = ~std::size_t(0);

/// Of one that is a whole face.
inline constexpr std::size_t kMoodChannel = kNoChannel - 1;

/// For shapes by their channels. `share`: of the usual thrift; 0: none.
Thrift thrift_of(const std::vector<std::size_t>& channels, double share);

/// The FAPs of a frame that count. A chin that nobody measured is 0 and would keep the jaw from
/// opening, cheeks would keep the lips from rounding: FAP 14, 18 and 39 to 42 at 0 do not.
Mask without_unmeasured(const Frame& frame);

}  // namespace animeme::fap::internal

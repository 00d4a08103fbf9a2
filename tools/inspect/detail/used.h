// Which parameters occur in a clip.
#pragma once

#include <vector>

namespace animeme::inspect {

/// The masks of all frames together; for FAPs and BAPs.
template <class Frame>
auto used_mask(const std::vector<Frame>& frames) {
  decltype(Frame().mask) used;
  for (const Frame& frame : frames) used |= frame.mask;
  return used;
}

}  // namespace animeme::inspect

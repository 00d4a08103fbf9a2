// Which regions a head gets in an .fdp file.
#pragma once

#include "fap/xml/detail/xface.h"
#include "fap/xml/fdp.h"

namespace animeme::head::detail {

struct FdpPlan {
  std::vector<Part> parts;  ///< submeshes, in their order
  /// XfaceItem::mesh counts in `parts`. Each feature point comes first with its own name.
  std::vector<XfaceItem> items;
  std::size_t left_out = 0;  ///< moves of vertices beyond eight influences
};

/// Plans. At most kXfaceSlots influences a vertex; of more, the strongest stay.
FdpPlan plan_fdp(const Head& head, const Rig& rig, const FdpOptions& options);

}  // namespace animeme::head::detail

// Averages over time. Internal.
#pragma once

#include <cstddef>
#include <vector>

namespace animeme::dam {

/// Each of `columns` columns of a table, row by row, averaged over time by a bell of this standard
/// deviation in rows, cut off at three of them; at the ends over what is there. 0: as it is.
void smooth_columns(std::vector<double>& table, std::size_t columns, double deviation);

}  // namespace animeme::dam

/// @file
/// The bit rate of a clip: one meaning in every report.
#pragma once

#include <cstddef>

namespace animeme::tools {

/// The mean rate in kbit/s (1000 bits a second) of `bytes` that last `seconds`: everything that is
/// stored or sent counts, also start codes and stuffing. 0 for a clip without a length.
inline double kbit_per_s(std::size_t bytes, double seconds) {
  return seconds > 0 ? double(bytes) * 8e-3 / seconds : 0;
}

}  // namespace animeme::tools

/// @file
/// Curves as a table, one column a control: what train reads and speak and follow write.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "dam/signal/signal.h"

namespace animeme::tools {

/// "time_s,NAME,NAME ..." and a line end.
std::string curve_header(std::span<const std::string> names);

/// One frame: its time in seconds and all values, and a line end.
std::string curve_row(const dam::Signal& signal, std::size_t frame);

}  // namespace animeme::tools

// What assemble() refuses.
#pragma once

#include "fap/head/own_head.h"

namespace animeme::head::detail {

/// The first thing in a source that cannot be: numbers that are none, vertices that do not exist,
/// unknown or double feature points, targets of nothing.
std::optional<Error> check(const Source& source);

}  // namespace animeme::head::detail

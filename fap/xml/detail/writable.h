// What the writers of face definitions need of a head.
#pragma once

#include "fap/head/rig.h"

namespace animeme::head::detail {

/// Errors: invalid_argument (no feature point on the skin, no FAPU, a rig of another head).
Result<void> check_writable(const Head& head, const Rig& rig);

}  // namespace animeme::head::detail

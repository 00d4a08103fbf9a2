/// @file
/// The text form of what is kept of a performance: "lips=0.5,brows=0".
#pragma once

#include <functional>
#include <string>

#include "dam/performance/performance.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::dam {

/// FAPs of a part of the face by its name. Errors: invalid_argument.
using PartOfFace = std::function<Result<fap::Mask>(const std::string& name)>;

/// The parts of fap::regions() and "all".
Result<fap::Mask> part_of_face(const std::string& name);

/// Reads shares of parts, 0 to 1, separated by commas; the last one counts. "all" is all but jaw
/// and tongue; an empty text keeps what KeptShares keeps. Errors: invalid_argument (no share, the
/// tongue), those of `part`.
Result<KeptShares> parse_kept_shares(const std::string& text,
                                     const PartOfFace& part = part_of_face);

}  // namespace animeme::dam

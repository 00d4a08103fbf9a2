/// @file
/// Cuts and joins of coded streams without a change of any value.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/encode/splice.h"
#include "fap/result.h"
#include "tools/app/commands/edit_source.h"

namespace animeme::tools {

/// The planes of cuts as one raw stream.
struct EditedPlanes {
  std::vector<std::uint8_t> stream;  ///< with its end code
  fba::SpliceReport report;          ///< how many planes kept their bits
};

/// Whether the cuts can be copied: all are coded, at this rate.
bool can_copy(const std::vector<EditCut>& cuts, fap::Rate rate);

/// Copies them. The first frame of all is held for `hold` more frames. `start_codes`: before each
/// plane, for containers; otherwise as in the sources. Errors: those of fba::Splicer.
Result<EditedPlanes> copy_planes(const std::vector<EditCut>& cuts, std::int64_t hold,
                                 bool start_codes);

/// Frames of a source at which an intra plane is.
std::vector<std::int64_t> intra_frames(const EditSource& source);

}  // namespace animeme::tools

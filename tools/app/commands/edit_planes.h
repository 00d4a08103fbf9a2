/// @file
/// Cuts and joins of coded streams without a change of any value.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/encode/splice.h"
#include "fap/result.h"
#include "tools/app/commands/edit_source.h"

namespace animeme::tools {

/// Takes bytes of a stream, in order. Its errors are passed on.
using TakeStream = std::function<Result<void>(std::span<const std::uint8_t>)>;

/// Whether the cuts can be copied: all are coded, at this rate.
bool can_copy(const std::vector<EditCut>& cuts, fap::Rate rate);

/// Hands over the planes of cuts as one raw stream with its end code. The first frame of all is
/// held for `hold` more frames. `start_codes`: before each plane, for containers; otherwise as in
/// the sources. Errors: those of fba::Splicer and of `take`. The report says how many planes kept
/// their bits.
Result<fba::SpliceReport> copy_planes(const std::vector<EditCut>& cuts, std::int64_t hold,
                                      bool start_codes, const TakeStream& take);

/// Frames of a source at which an intra plane is.
std::vector<std::int64_t> intra_frames(const EditSource& source);

}  // namespace animeme::tools

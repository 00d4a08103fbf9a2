// One frame of a FAP text: a mask, a frame number and values. Internal.
#pragma once

#include <cstdint>

#include "fap/detail/text_notes.h"
#include "fap/detail/text_scanner.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fap::detail {

/// Reads the frame whose mask the scanner stands at, with the number as it is in the text.
/// Returns the line of the number. Errors: those of read_text().
Result<std::int64_t> read_frame(TextScanner& scanner, TextNotes& notes, Frame& frame);

/// Frames of one number: what `later` has wins.
void merge_frames(Frame& into, const Frame& later);

}  // namespace animeme::fap::detail

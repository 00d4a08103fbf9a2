/// @file
/// BAP text: the ASCII .bap file with body animation parameters. The grammar is that of FAP text
/// (fap/text.h) with other versions and longer masks; fap/text_format.md, section 1, and
/// codec/bitstream.md, section 11.
///
///     3.2 my_clip 25 2                         version, name, frames per second, frame count
///     0 0 1 0 0 ...                            mask values: which BAPs follow
///     0 341                                    frame number, one value per BAP of the mask
///     0 0 1 0 0 ...
///     1 356
///
/// Version 3.1 has 186 mask values per frame (the BAPs of the standard), version 3.2 has 296 (with
/// the extension BAPs). Values are 1e-5 rad, millimetres for BAP 181..183.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/syntax/plane.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::fba {

/// Body animation. Frame numbers ascend strictly; they match the face clip, so the first one need
/// not be 0.
struct BodySequence {
  fap::Rate rate{25, 1};          ///< frames per second
  std::vector<BodyFrame> frames;  ///< by ascending number
  std::string name;               ///< free text for people; written as one word

  friend bool operator==(const BodySequence&, const BodySequence&) = default;
};

/// Reads a BAP text of any origin. Safe for untrusted input: time and memory are linear in the
/// text (below twelve times its size), whatever numbers it contains.
///
/// Warnings and errors are the same as for fap::read_text() with its default options, except that
/// - frame numbers keep their offset, since they refer to a face clip;
/// - versions 3.1 and 3.2 are known, others are read like 3.2 with a warning;
/// - a first mask of 186 or 296 values alone on its line sets the length of all masks, with a
///   warning if the version disagrees;
/// - version 2.0 to 2.2, which is FAP text, is Code::unsupported.
///
/// `warnings` (may be null) gets one line per kind of deviation, "line 2: ...". Errors carry line
/// and column.
Result<BodySequence> read_bap_text(std::string_view text,
                                   std::vector<std::string>* warnings = nullptr);

/// Writes the plain form: no comments, a one-word name, the exact frame count, mask and values on
/// separate lines, LF. Version 3.1 if no mask has a BAP above 186, else 3.2.
///
/// read_bap_text() gives the same sequence back if the name is one word and values of absent BAPs
/// are 0, as in frames made by Animeme. An invalid rate is written as 0.
std::string write_bap_text(const BodySequence& sequence);

/// The body planes of a decoded stream: coded values, masks say what was coded, numbers include
/// skipped frames. No frames if the stream has no body.
BodySequence body_sequence(const DecodedStream& stream);

}  // namespace animeme::fba

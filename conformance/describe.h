/// @file
/// Fills the computed part of a case: features, limits, sums; and proves what can be proved.
#pragma once

#include "conformance/case_builder.h"
#include "fap/result.h"

namespace animeme::conformance {

/// Computes object, features, sections, certainty, limits and files of `made.info` from
/// `made.content`. For a stream that can be decoded it further checks that
///   - the decoder gives the expected values,
///   - StreamWriter, the second encoder, gives the same bits,
///   - the encoder gives the same bytes from the parameters, if there are any,
/// and for a damaged one that the decoder gives the intact planes and an error of the right kind.
/// Errors: syntax (a file cannot be read), internal (one of the checks failed; the message says
/// which).
Result<void> describe(MadeCase& made);

}  // namespace animeme::conformance

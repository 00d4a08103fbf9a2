// Coding a clip that has a body, with or without a face: what encode() is for faces alone.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/bap_text.h"
#include "codec/encoder.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// Codes `body` and, unless it has no frames, `face` in one stream. Every plane codes all that
/// occurs; the planes are the frame numbers of either, and what a frame leaves out keeps its last
/// value (0 at first). Ranges are as tight as the format allows, with an intra plane at the start,
/// every `intra_period` planes, and wherever a change is too large for a predictive plane.
/// `fap_quant` is the quantiser of the face and the quantiser index of the body. Deterministic.
/// Errors: those of encode(), and invalid_argument if the body has no frames or the rates differ.
Result<std::vector<std::uint8_t>> encode_with_body(const fap::Sequence& face,
                                                   const BodySequence& body,
                                                   const EncodeOptions& options = {});

}  // namespace animeme::fba

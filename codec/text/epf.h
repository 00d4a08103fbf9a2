/// @file
/// Encoder parameter files (.epf): every coding decision of a stream as text, one tag per line. An
/// EPF fully determines the bytes of a stream. Source: codec/bitstream.md, section 11.
#pragma once

#include <string_view>
#include <vector>

#include "codec/encode/encoder.h"
#include "fap/result.h"

namespace animeme::fba {

/// One plane of an EPF. Ranges are already the 5-bit numbers of the stream.
struct EpfPlane {
  bool intra = false;                         ///< ISI
  ObjectMask object_mask = ObjectMask::face;  ///< FBM
  std::int64_t face_frame = 0;                ///< FFR: number of the frame in the .fap file
  std::int64_t body_frame = 0;                ///< BFR: number of the frame in the .bap file
  TemporalHeader temporal;                    ///< FRR, TC, SKN and their BAP twins
  FaceSettings face;                          ///< FMT, FQU, FIX..., intra planes
  BodySettings body;                          ///< BMT, BQU, BIX..., intra planes
};

/// Reads an EPF. Blank lines and # comments are allowed anywhere; CRLF is accepted. An intra plane
/// without FMT or FQU (BMT, BQU) uses those of the previous intra plane. A range tag gives the 66
/// (FIX FIN FPX FPN) or 296 (BIX BIN BPX BPN) limits in quantiser steps of fap_quant 1, maxima
/// 0..1860 and minima -1860..0; they are rounded up to the next multiple of 60. As in the reference
/// encoder, predictive limits of 0 and 0 for FAP 4 turn all four sets into +-1020. Errors: syntax
/// (unknown tag, missing or extra numbers, a quantiser after the ranges, settings in a predictive
/// plane), out_of_range, unsupported (CDM 1), with line and column.
Result<std::vector<EpfPlane>> read_epf(std::string_view text);

/// Encodes a clip exactly as the EPF specifies; the masks of the EPF override those of the clip.
/// FFR and BFR refer to frames by their numbers. FAPs and BAPs that the EPF codes and a frame lacks
/// keep their last value (0 at first). `bodies` is BAP data in any order, empty for streams without
/// a body; of two frames with the same number the later one counts. Errors: those of
/// Encoder::write(), and not_found if the EPF refers to a frame that does not exist.
Result<std::vector<std::uint8_t>> encode_epf(const fap::Sequence& clip,
                                             const std::vector<BodyFrame>& bodies,
                                             const std::vector<EpfPlane>& planes,
                                             const StreamOptions& options = {});

}  // namespace animeme::fba

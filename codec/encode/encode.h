/// @file
/// Encodes clips: makes the decisions of an encoder in two passes over the whole clip.
///
///     auto stream = animeme::fba::encode(clip);                              // all parameters
///     auto small = animeme::fba::encode(clip, animeme::fba::file_options()); // the same values
///     animeme::fba::EncodeOptions options = animeme::fba::file_options();
///     options.max_rms = 2;                                                   // not visible
///     auto tiny = animeme::fba::encode(clip, options);
///
/// For clips that do not fit into memory see long_clip.h, for motion that is not known in advance
/// live.h, for full control encoder.h and epf.h.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/encode/encoder.h"
#include "codec/syntax/plane.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// Options of encode(). The defaults are the plain form: every parameter that occurs in the clip is
/// coded in every plane, in the tightest ranges that the format allows.
struct EncodeOptions {
  int fap_quant = 1;  ///< 0..31; 1: the standard's steps, 0: lossless for values up to +-1860
  int bap_quant = 1;  ///< 0..31, index into kBapScale
  /// Largest distance of intra planes, where receivers can join, in seconds (planes and the frames
  /// that they skip count, rounded to whole frames); 0: only where needed.
  double intra_seconds = 0;
  StreamOptions stream;  ///< start codes

  /// Parameters that stay at 0 are not coded (nor are FAP 1 and 2 that stay neutral, or all of a
  /// body beside a face or of a face beside a body), and right sides that equal their left sides in
  /// every plane are left to the decoder (mask type 2). The values after fill() are the same, also
  /// in decoders that copy left and right sides whatever the mask type says.
  bool leave_out = false;
  /// Intra planes also where they save bits: at a jump that would widen the ranges of other planes.
  bool extra_intra = false;
  /// Planes in which nothing moves are not sent; the previous plane codes how many frames to skip.
  bool skip_still = false;
  /// The first plane is coarse (fap_quant up to 31), which makes the steps of ranges fine, and
  /// defines the ranges of all predictive planes; later intra planes keep them as numbers of levels
  /// (codec/bitstream.md, section 3.2). Saves some 5 % on speech and was read correctly by the two
  /// other decoders that were tried, but the intention of the standard is uncertain. Only the first
  /// frame has larger errors (max_rms does not count them, EncodeReport does), and receivers can
  /// only join at the beginning: invalid_argument with intra_seconds. Not done where it saves
  /// nothing.
  bool kept_ranges = false;
  /// Intra planes of a face send no intra ranges: decoders use their tables of default ranges, as
  /// long as every value lies within them. Saves some 10 % of streams that can be joined each
  /// second. The tables of the printed standard and of the reference decoder differ, and this
  /// encoder uses the latter (fap::FapInfo::default_i_range): only for players that were tested
  /// with it. Not together with kept_ranges (invalid_argument); not done where a value lies
  /// outside.
  bool default_ranges = false;

  /// > 0: choose fap_quant and the levels for the fewest bits at this error, root mean square over
  /// all FAPs that move: FAP units (half a quantiser step for angles and for BAPs). The two kinds
  /// meet it separately. fap_quant and bap_quant are ignored. Blend and intensities of FAP 1 and 2
  /// are rounded to multiples of the chosen fap_quant; this error does not count.
  double max_rms = 0;
  /// > 0: choose fap_quant and the levels for the smallest error at this rate, bits per second.
  /// With max_rms: whichever needs fewer bits. Not all rates can be reached, see EncodeReport.
  double max_bits_per_second = 0;
  /// > 0: parameters that move by less than this altogether (from their least to their greatest
  /// value, FAP units or half quantiser steps) are kept constant at their mean.
  double still_below = 0;
  /// Decode the stream again and compare; a difference is Code::internal.
  bool verify = true;
  /// Progress callback: called during the search of levels (max_rms, max_bits_per_second) with an
  /// estimate of the completed share, 0..1. May be empty.
  std::function<void(double)> progress;
};

/// Options for files: the smallest stream with the same values.
EncodeOptions file_options();
/// Options for transmission: everything in the clip is coded, and receivers can join every 2 s,
/// with separate ranges for each section.
EncodeOptions live_options();

/// Decisions and statistics of encode().
struct EncodeReport {
  int fap_quant = 0;             ///< as requested, or as found for an error or rate target
  int bap_quant = 0;             ///< likewise
  std::size_t planes = 0;        ///< all, intra planes included
  std::size_t intra_planes = 0;  ///< intra planes among them
  std::size_t skipped = 0;       ///< frames of the clip not sent because nothing moved
  std::size_t coded = 0;         ///< parameters coded, with zeros that a decoder would overwrite
  std::size_t mirrored = 0;      ///< right sides left to the decoder
  std::size_t left_out = 0;      ///< parameters that stay at 0, not coded
  std::size_t stilled = 0;       ///< parameters that move in the clip but not in the stream
  double rms = 0;                ///< error of the moving FAPs except angles, FAP units
  double rms_other = 0;          ///< error of moving angles and BAPs, half quantiser steps
  double values = 0;             ///< number of values that `rms` is the mean of
  double values_other = 0;       ///< the same of `rms_other`
  bool kept_ranges = false;      ///< the first plane is coarse and defines the ranges of the others
  bool default_ranges = false;   ///< intra ranges are those of the decoder's tables
  /// Values beyond the largest range (+-1860 quantiser steps in intra planes and from plane to
  /// plane), replaced by the nearest that can be coded.
  std::size_t limited = 0;
  std::size_t retries = 0;  ///< number of changes of the ranges to avoid a hazard (Encoder::hazard)
  /// Hazards that are left after 40 plans: usually 0; FAP 1 and 2 alone can cause one that no range
  /// change removes, and so can many consecutive values at the limit of the ranges.
  std::size_t hazards = 0;
};

/// Encodes a clip of a face, a body, or both. FAPs and BAPs absent from a frame keep their last
/// value (0 at first). Gaps in the frame numbers become skipped frames; where only one of face and
/// body has a frame, the other one is held. Deterministic: the same bytes on every machine.
///
/// The stream begins with an intra plane; there is another one every `intra_seconds` and wherever a
/// change is too large for a predictive plane. Every intra plane sends all masks, ranges (except
/// with kept_ranges) and the rate, so decoding can start there. The stream contains neither false
/// start codes nor zero runs that mislead old decoders, except for EncodeReport::hazards.
///
/// Memory: about 10 bytes per plane for each parameter that occurs, with leave_out 600 bytes per
/// plane (every FAP counts), with max_rms or max_bits_per_second another 400 bytes per plane; and
/// the stream. It is decoded again plane by plane.
///
/// `face` may be empty if `body` is not; its rate is that of the stream. Errors: invalid_argument
/// (no frames, numbers that do not ascend or skip more than a million frames, options out of
/// bounds), unsupported (a rate that the format cannot express: use k/16 frames per second up to
/// 255 15/16, or those times 1000/1001), out_of_range (without quantisation, a value beyond +-1860;
/// a viseme outside 0..14, an expression outside 0..6, a blend or an intensity outside 0..63; the
/// message names parameter and frame), internal (verify failed).
Result<std::vector<std::uint8_t>> encode(const fap::Sequence& face, const EncodeOptions& = {},
                                         std::span<const BodyFrame> body = {},
                                         EncodeReport* report = nullptr);

}  // namespace animeme::fba

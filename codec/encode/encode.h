/// @file
/// Clips to streams: the decisions of an encoder, made in two passes over the whole clip.
///
///     auto stream = animeme::fba::encode(clip);                              // all that is there
///     auto small = animeme::fba::encode(clip, animeme::fba::file_options()); // the same values
///     animeme::fba::EncodeOptions options = animeme::fba::file_options();
///     options.max_rms = 2;                                                   // not visible
///     auto tiny = animeme::fba::encode(clip, options);
///
/// For streams that are made while they are sent see live.h, for full control encoder.h and epf.h.
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

/// What encode() may do. The defaults are the plain form: every parameter that occurs in the clip
/// is coded in every plane, in the tightest ranges that the format has.
struct EncodeOptions {
  int fap_quant = 1;  ///< 0..31; 1: the standard's steps, 0: lossless for values up to +-1860
  int bap_quant = 1;  ///< 0..31, index into kBapScale
  /// An intra plane, where receivers can join, at least every so many seconds (a plane and the
  /// frames that it skips count, rounded to whole frames); 0: only where needed.
  double intra_seconds = 0;
  StreamOptions stream;  ///< start codes

  /// Parameters that stay at 0 are not coded (nor are FAP 1 and 2 that stay neutral, or all of a
  /// body beside a face or of a face beside a body), and right sides that equal their left sides in
  /// every plane are left to the decoder (mask type 2). The values after fill() are the same; they
  /// are too in decoders that copy left and right sides whatever the mask type says.
  bool leave_out = false;
  /// Intra planes also where they save bits: at a jump that would widen the ranges of the rest.
  bool extra_intra = false;
  /// Planes in which nothing moves are not sent; the plane before says how many frames to skip.
  bool skip_still = false;
  /// The first plane is coarse (fap_quant up to 31), which makes the steps of ranges fine, and
  /// tells the ranges of all predictive planes; later intra planes keep them as numbers of levels
  /// (codec/bitstream.md, section 3.2). Some 5 % less on speech, read by the two other decoders
  /// that were tried, but what the standard means is not sure. Only the first frame has larger
  /// errors (max_rms does not count them, EncodeReport does), and receivers can join at the begin
  /// only: invalid_argument with intra_seconds. Not done where it saves nothing.
  bool kept_ranges = false;

  /// > 0: choose fap_quant and the levels for the fewest bits at this error, root mean square over
  /// all FAPs that move: FAP units (half a quantiser step for angles and for BAPs). The two kinds
  /// keep to it separately. fap_quant and bap_quant are ignored. Blend and intensities of FAP 1
  /// and 2 are rounded to multiples of the fap_quant that is chosen; this error does not count.
  double max_rms = 0;
  /// > 0: choose fap_quant and the levels for the smallest error at this rate, bits per second.
  /// With max_rms: whichever asks for fewer bits. Not all rates can be reached, see EncodeReport.
  double max_bits_per_second = 0;
  /// > 0: parameters that move by less than this altogether (from their least to their greatest
  /// value, FAP units or half quantiser steps) are left still at their mean.
  double still_below = 0;

  /// Decode the stream again and compare; a difference is Code::internal.
  bool verify = true;
  /// Called now and then while levels are searched (max_rms, max_bits_per_second) with the share
  /// that is done, 0..1, as well as it can be told. May be empty.
  std::function<void(double)> progress;
};

/// The options for files: the smallest stream of the same values.
EncodeOptions file_options();
/// For clips that are to be sent: all that the clip has is coded, and there is a joining point
/// every 2 s, with ranges of its own up to the next.
EncodeOptions live_options();

/// What encode() chose.
struct EncodeReport {
  int fap_quant = 0;             ///< of the stream: as asked for, or as found for a limit of error
  int bap_quant = 0;             ///< likewise
  std::size_t planes = 0;        ///< all, intra planes included
  std::size_t intra_planes = 0;  ///< of them
  std::size_t skipped = 0;       ///< frames of the clip not sent because nothing moved
  std::size_t coded = 0;         ///< parameters coded, with zeros that a decoder would overwrite
  std::size_t mirrored = 0;      ///< right sides left to the decoder
  std::size_t left_out = 0;      ///< parameters that stay at 0, not coded
  std::size_t stilled = 0;       ///< parameters that moved in the clip and do not in the stream
  double rms = 0;                ///< error of the moving FAPs that are no angles, FAP units
  double rms_other = 0;          ///< error of moving angles and BAPs, half quantiser steps
  bool kept_ranges = false;      ///< the first plane is coarse and tells the ranges of the others
  /// Values beyond what planes can tell (+-1860 quantiser steps in intra planes and from plane to
  /// plane), replaced by the nearest that can be told.
  std::size_t limited = 0;
  std::size_t retries = 0;  ///< how often the ranges were changed to avoid a trap (Encoder::trap)
  /// Traps that are left when 40 plans have been tried: 0 as a rule; FAP 1 and 2 alone can make one
  /// that no range changes, and so can many values in a row at the end of what can be told.
  std::size_t traps = 0;
};

/// Codes a clip of a face, a body, or both. FAPs and BAPs that a frame leaves out keep their last
/// value (0 at first). Gaps in the frame numbers become skipped frames; where only one of face and
/// body has a frame, the other one is held. Deterministic: the same bytes on every machine.
///
/// The stream begins with an intra plane; there is another one every `intra_seconds` and wherever a
/// change is too large for a predictive plane. Every intra plane sends all masks, ranges (but see
/// kept_ranges) and the rate, so decoding can start there. The stream holds neither false start
/// codes nor zero runs that mislead old decoders, but see EncodeReport::traps.
///
/// Memory: about 10 bytes a plane for each parameter that occurs, with leave_out 600 bytes a plane
/// (every FAP counts), with max_rms or max_bits_per_second 400 bytes a plane more; and the stream.
/// It is decoded again plane by plane.
///
/// `face` may be empty if `body` is not; its rate is that of the stream. Errors: invalid_argument
/// (no frames, numbers that do not ascend or leave out more than a million frames, options out of
/// bounds), unsupported (a rate that the format cannot express: use k/16 frames per second up to
/// 255 15/16, or those times 1000/1001), out_of_range (without quantisation, a value beyond +-1860;
/// a viseme outside 0..14, an expression outside 0..6, a blend or an intensity outside 0..63; the
/// message names parameter and frame), internal (verify failed).
Result<std::vector<std::uint8_t>> encode(const fap::Sequence& face, const EncodeOptions& = {},
                                         std::span<const BodyFrame> body = {},
                                         EncodeReport* report = nullptr);

}  // namespace animeme::fba

/// @file
/// Encodes clips that do not fit into memory, window by window.
///
///     animeme::fba::ClipSource source{rate, [&](const TakeInstant& take) { ... }};
///     auto report = animeme::fba::encode_long(source, options, write_bytes);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "codec/encode/encode.h"
#include "codec/syntax/plane.h"
#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::fba {

/// Takes what a clip has at one frame number: a face, a body or both, of one number; what is
/// missing is null. An error ends the reading.
using TakeInstant = std::function<Result<void>(const fap::Frame* face, const BodyFrame* body)>;

/// A clip that is read twice.
struct ClipSource {
  fap::Rate rate;  ///< frames per second
  /// Hands over all instants with ascending numbers, each time it is called. Its errors are passed
  /// on, and so are those of `take`.
  std::function<Result<void>(const TakeInstant& take)> each;
};

/// Takes bytes of the stream, in order. Its errors are passed on.
using TakeBytes = std::function<Result<void>(std::span<const std::uint8_t>)>;

/// Largest number of planes of a window that holds a face alone. With a body it is a quarter.
inline constexpr std::size_t kWindowPlanes = 24'576;

/// Encodes in windows of at most `window` planes, as encode() does, with the same bytes for clips
/// of one window. Of longer ones each window is coded on its own, and the windows are joined
/// (splice.h): each begins with an intra plane, and limits of error and rate hold in each of them.
/// Windows end where an intra period does, if there is one of at most a window. Every parameter
/// that occurs anywhere in the clip counts as occurring in all windows.
///
/// In the report of several windows quantisers are the largest, `coded` and `mirrored` the most and
/// `left_out` and `stilled` the fewest of any window; all other numbers are sums, and errors those
/// of the whole clip.
///
/// A window costs what its intra plane and the learning of its models do: 1 % of a face of 66 FAPs
/// that all move.
///
/// Memory: a kilobyte for each plane of a window, with limits of error or rate half as much again,
/// with a body four times as much; with EncodeOptions::kept_ranges the whole clip, since its first
/// plane defines the ranges of all others. Errors: those of encode(), of `source` and of `take`.
Result<EncodeReport> encode_long(const ClipSource& source, const EncodeOptions& options,
                                 const TakeBytes& take, std::size_t window = kWindowPlanes);

}  // namespace animeme::fba

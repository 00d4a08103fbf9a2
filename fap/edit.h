/// @file
/// Editing clips: scaling, smoothing, mirroring, fading, and motion from several clips.
///
///     Sequence clip = fill(decoded).value();
///     scale(clip, *region_faps("brows"), 1.4);        // livelier brows
///     smooth(clip, *region_faps("head"), 0.2);        // a steadier head
///     replace(clip, other, *region_faps("lips"), 0.2);
///
/// All functions work in place on complete frames, as fap/fill.h makes them: numbers 0, 1, 2 ...
/// and one mask. Values are rounded to the nearest.
///
/// A clip that does not fit into memory is edited piece by piece: scale() and mirror() know no
/// neighbours, fade() and replace() are told where a piece lies, and smooth() is right where
/// smooth_reach() frames are on both sides, or the end of the clip.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "fap/frame.h"

namespace animeme::fap {

/// A part of the face by name, with its FAPs.
struct Region {
  std::string_view name;  ///< "lips"
  Mask faps;              ///< never empty
};

/// lips (with FAP 1), jaw, brows, lids, gaze (eyeballs, pupils), cheeks, nose, tongue, head, ears,
/// expression (FAP 2): together all FAPs, each in one region.
std::span<const Region> regions();

/// The FAPs of the region of this name; nullopt: there is none.
std::optional<Mask> region_faps(std::string_view name);

/// Where a piece lies in its clip.
struct PieceOf {
  std::int64_t first = 0;   ///< number of its first frame in the clip
  std::int64_t frames = 0;  ///< of the clip
};

/// Multiplies low-level FAPs by `factor`. Intensities of FAP 2 are limited to 63, the blend of FAP
/// 1 is no amplitude and stays.
void scale(Sequence& clip, const Mask& faps, double factor);

/// Smooths low-level FAPs without a delay, by a Gaussian whose standard deviation is half of
/// `seconds`; the ends are held. A motion that is shorter than `seconds` nearly disappears.
void smooth(Sequence& clip, const Mask& faps, double seconds);
/// How many frames on each side have a part in a smoothed one; of a long clip, which may be
/// shorter.
double smooth_reach(Rate rate, double seconds);

/// Swaps left and right: sides, and the directions of jaw, tongue, nose, gaze and head.
void mirror(Sequence& clip);

/// Low-level FAPs and the intensities of FAP 2 rise from rest over the first `in` seconds and
/// return to rest over the last `out` seconds, in a smooth curve. The shape of FAP 1 stays.
void fade(Sequence& clip, double in, double out);
/// The same for a piece of a clip.
void fade(Sequence& piece, double in, double out, const PieceOf& place);

/// Takes FAPs from another clip of the same rate, frame by frame, also if `clip` did not have them;
/// those that `from` does not have rest. Where `from` has ended, the FAPs of `clip` go on, and
/// over the last `cross_fade` seconds before that one turns into the other.
void replace(Sequence& clip, const Sequence& from, const Mask& faps, double cross_fade);
/// The same for a piece of a clip; `from` are the frames of the other one at the same place, as far
/// as there are any of its `taken` frames. The mask of a piece behind them stays.
void replace(Sequence& piece, const Sequence& from, const Mask& faps, double cross_fade,
             const PieceOf& place, std::int64_t taken);

/// Appends the frames of another clip of the same rate. FAPs that only one of them has are at rest
/// in the other. Over `cross_fade` seconds behind the joint the last pose turns into the motion
/// that follows; 0: it changes at once.
void append(Sequence& clip, const Sequence& next, double cross_fade);

}  // namespace animeme::fap

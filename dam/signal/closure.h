/// @file
/// Corrects lip contacts in synthesis: P, B and M close the lips, F and V bring the lower lip to
/// the upper teeth. Sums of smooth functions undershoot short contacts, and viewers notice this
/// most. Source: dam/lipsync.md, section 6.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"

namespace animeme::dam {

/// Distance from the phone within which a closure is searched, seconds.
inline constexpr double kClosureSearch = 0.040;

/// FAP units: lips with a smaller inner gap count as closed when times are measured.
inline constexpr double kClosedGap = 45;
/// Seconds: longest time for which lips are held closed.
inline constexpr double kLongestClosure = 0.3;

/// How long a P, B or M keeps the lips closed, in seconds: `base` + `slope` * its duration.
struct ClosureDuration {
  double base = 0;   ///< seconds
  double slope = 0;  ///< seconds per second

  /// Seconds for a phone, 0..kLongestClosure.
  double of(double duration) const;

  friend bool operator==(const ClosureDuration&, const ClosureDuration&) = default;
};

/// Options of closures.
struct ClosureOptions {
  double least = -15;  ///< FAP units: lips pressed together; they cannot pass through each other
  double target = 25;  ///< FAP units: largest inner gap that counts as closed
  double upper_follow =
      0.6;  ///< motion of the upper lip's outer contour, as a share of its inner contour's
  double lower_follow = 0.9;  ///< the same for the lower lip
  /// How long P, B and M stay closed; nullopt: as long as in the signal.
  std::optional<ClosureDuration> duration;
};

/// Makes every P, B and M of the script close the lips in at least one frame. If the least inner
/// gap -(FAP 4 + FAP 5) from 40 ms before to 40 ms after the phone is above the target, the lips
/// are moved together around that frame by a raised cosine of half-width duration / 2 + 50 ms: 30 %
/// by the upper lip, 70 % by the lower, middle (FAP 4, 5) and sides (8, 10 and 9, 11: each by its
/// own gap) alike. The outer contour (51, 55, 56; 52, 57, 58) follows. With `duration`, lips that
/// are closed for a shorter time are held closed for that time around the same moment, and released
/// over 50 ms on either side. Returns the number of phones closed. Does nothing if FAP 4 or 5 is
/// missing.
std::size_t apply_closure(Signal& signal, const Script& script, const ClosureOptions& options = {});

/// Makes every F and V raise the inner lower lip (FAP 5) to `raise` FAP units in at least one
/// frame, in the same way; its sides (10, 11) and the outer contour (52, 57, 58) follow. The lips
/// stay apart: the inner gap never falls below kLeastOpen for this. Returns the number of phones
/// corrected.
inline constexpr double kLeastOpen = 50;
/// As apply_closure(); `raise` in FAP units, Model::lip_tooth_raise.
std::size_t apply_lip_tooth_contact(Signal& signal, const Script& script, double raise,
                                    const ClosureOptions& options = {});

/// Stops lips where they meet: inner gaps below `least` are opened to it, in the middle and at the
/// sides, each lip by half; the outer contour follows. Returns the number of frames changed.
std::size_t apply_contact(Signal& signal, const ClosureOptions& options = {});

/// Closes the lips of a still pose in the same way: inner gaps above 0 become 0. Does nothing
/// without FAP 4 and 5. `pose` has one value per name.
void close_pose(std::span<const std::string> names, std::span<double> pose,
                const ClosureOptions& options = {});

/// The time around a moment in which lips are closed: the gap is below kClosedGap, interpolated
/// linearly between frames.
struct ClosedSpan {
  std::size_t least = 0;                            ///< frame of the least gap
  double before = 0,                                ///< frames closed before it
      after = 0;                                    ///< frames closed after it
  double frames() const { return before + after; }  ///< duration
};
struct LipChannels;
/// Around the least gap within kClosureSearch of the phone, at most `reach` seconds from it;
/// nullopt: never closed.
std::optional<ClosedSpan> closed_span(const Signal& signal, const Phone& phone,
                                      const LipChannels& lips, double reach);

/// Channel indices of FAP 4 and 5.
struct LipChannels {
  std::size_t upper = 0,  ///< FAP 4
      lower = 0;          ///< FAP 5
};
/// The channels of a signal by their names; nullopt: one of them is missing.
std::optional<LipChannels> inner_lip_channels(std::span<const std::string> names);

/// -(FAP 4 + FAP 5) in FAP units: closed at 0 and below.
inline double inner_gap(const Signal& signal, std::size_t frame, const LipChannels& lips) {
  return -(signal.at(frame, lips.upper) + signal.at(frame, lips.lower));
}

/// Frames [first, last) of the signal within `margin` seconds of a phone; at least the nearest
/// frame, as long as the phone begins before the signal ends.
struct FrameSpan {
  std::size_t first = 0,  ///< first frame
      last = 0;           ///< one past the last
};
/// See FrameSpan; `margin` >= 0 seconds.
FrameSpan frames_near(const Signal& signal, const Phone& phone, double margin);

/// True for P, B, M.
bool is_bilabial(std::string_view label);
/// True for F, V.
bool is_labiodental(std::string_view label);

}  // namespace animeme::dam

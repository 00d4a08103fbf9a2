// State of a live encoder, and the settings of its intra planes. Not installed API.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "codec/encode/live.h"
#include "codec/syntax/plane.h"

namespace animeme::fba::internal {

/// What was given so far, held where frames leave something out. Masks: what has occurred, or the
/// FAPs that the options name.
struct HeldFrame {
  fap::Frame face;  // mask: what is coded
  BodyFrame body;
  bool has_body = false;
  fap::Mask occurred;  // FAPs
  fap::Mask differs;   // FAPs of the right side that are not always those of the left

  /// FAP 1 and 2 have been checked. `given_body` may be null.
  void take_in(const fap::Frame& frame, const BodyFrame* given_body, const LiveOptions& options);
  /// Coded low-level FAPs and BAPs.
  std::size_t low_level_count() const { return (face.mask >> fap::kFirstLowLevel).count(); }
  std::size_t body_count() const { return has_body ? body.mask.count() : 0; }
};

/// One plane as receivers have it.
struct Shown {
  fap::Frame face;
  BodyFrame body;
};

/// Largest changes from plane to plane, in levels, over this period and the one before.
template <std::size_t kSize>
class Activity {
 public:
  void see(std::size_t number, std::int64_t change) {
    std::int64_t& largest = now_[number];
    largest = std::max(largest, change < 0 ? -change : change);
  }
  void next_period() {
    before_ = now_;
    now_.fill(0);
  }
  std::int64_t largest(std::size_t number) const { return std::max(before_[number], now_[number]); }

 private:
  std::array<std::int64_t, kSize> now_{};
  std::array<std::int64_t, kSize> before_{};
};

struct Motion {
  Activity<fap::kFapCount + 1> face;
  PredictiveRanges ranges{};  // where the options give some: those, widened by larger changes
  Activity<kBapCount + 1> body;

  /// Changes of the held values since the last plane, of what is coded in it.
  void see(const HeldFrame& held, const Shown& last, const LiveOptions& options);
  void next_period() {
    face.next_period();
    body.next_period();
  }
};

/// What comes behind an intra plane, as far as it is known.
struct Outlook {
  PredictiveRanges up{};    // range numbers that its differences need
  PredictiveRanges down{};  // likewise, downwards
  std::array<std::uint8_t, kBapCount + 1> body_up{};
  std::array<std::uint8_t, kBapCount + 1> body_down{};
  bool complete = false;  // it reaches to the next intra plane
};

/// A frame that waits.
struct WaitingFrame {
  fap::Frame face;
  std::uint32_t skip = 0;
  std::optional<BodyFrame> body;
};

/// Looks at the frames that follow the held one, which skips `skip`, up to the end of a period of
/// so many frames (0: none). `last`: no more will come.
Outlook look_ahead(const HeldFrame& held, std::uint32_t skip,
                   const std::deque<WaitingFrame>& coming, std::int64_t period, bool last,
                   const LiveOptions& options);

/// Makes values beyond what an intra plane can hold the nearest that it can. Not without
/// quantisation, where angles could not be followed at all.
void limit(HeldFrame& held, const LiveOptions& options);

/// What an intra plane of the held values settles, with the tightest intra ranges, and predictive
/// ranges for the motion to come (`outlook`), if all of it is known, else of late, or wider ones
/// while `young`, when too little has been seen of it. A `detour` widens intra ranges, of one
/// parameter after the other (from the last coded FAP backwards, then on over the BAPs): that gives
/// other bits. The first widens one range, the second four, the third nine: what lies behind a
/// hazard in its segment does not move it.
FaceSettings settle_face(const HeldFrame& held, const Motion& motion, const LiveOptions& options,
                         const Outlook& outlook, bool young, int detour);
BodySettings settle_body(const HeldFrame& held, const Motion& motion, const LiveOptions& options,
                         const Outlook& outlook, bool young, int detour);

}  // namespace animeme::fba::internal

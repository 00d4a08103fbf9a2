/// @file
/// fill() (fap/fill.h) frame by frame, as a receiver does: for clips that do not fit into memory
/// and for those that are still arriving.
///
///     Receiver receiver({.keep_high_level = true});
///     for (each coded frame) use(with_mask(receiver.receive(frame, rules), receiver.mask()));
///
/// The mask grows with the FAPs received. fill() gives all frames the final mask; a writer that
/// needs the same reads its source twice.
#pragma once

#include <cstddef>
#include <optional>

#include "fap/expand.h"
#include "fap/fill.h"
#include "fap/frame.h"

namespace animeme::fap {

/// The state of a receiver. A plain value of a few kilobytes.
class Receiver {
 public:
  /// `interpolate` and `max_frames` have no effect: nothing is skipped here.
  explicit Receiver(const FillOptions& options = {});

  /// A frame arrives; returns the frame shown from then on, with the same number, valid until the
  /// next call. `rules` are those of its groups (fap/fill.h). The mask has all FAPs shown so far.
  const Frame& receive(const Frame& frame, const GroupRules& rules = {});
  /// The next frame if nothing arrives: the same values under the next number, without events.
  const Frame& hold();
  /// The FAPs that the result of fill() would have if the clip ended here.
  Mask mask() const;

 private:
  void hold_events();
  const Frame& expand();
  void follow(const Frame& frame, const Mask& faps);
  std::size_t source_of(const FapInfo& fap, const Mask& coded) const;
  Mask derive(Mask known, const Mask& targets);
  Mask copy(const Mask& known, const Mask& targets, int FapInfo::*other);

  FillOptions options_;
  Mask has_value_;  // sent, or derived under rule interpolate
  Frame shown_;     // its mask grows: all FAPs that ever had a value
  std::optional<Expander> expander_;
  Frame expanded_;  // shown_ without FAP 1 and 2
  Mask ever_;       // of all that was expanded
};

/// The frame with another mask: FAPs that it lacks are at rest, 0; viseme and expression are
/// dropped if the mask does not have them.
Frame with_mask(Frame frame, const Mask& mask);

}  // namespace animeme::fap

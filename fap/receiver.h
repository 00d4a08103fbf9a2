/// @file
/// What a receiver shows, frame after frame: fill() of fap/fill.h for clips that nobody wants to
/// have in memory, and for those that are still coming.
///
///     Receiver receiver({.keep_high_level = true});
///     for (each coded frame) use(with_mask(receiver.receive(frame, rules), receiver.mask()));
///
/// The mask grows with what is sent. fill() gives all frames the last one; a writer that wants the
/// same reads its source twice.
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

  /// A frame arrives; the result is what is shown from then on, numbered like it, valid up to the
  /// next call. `rules` are those of its groups (fap/fill.h). Its mask has what was ever shown.
  const Frame& receive(const Frame& frame, const GroupRules& rules = {});
  /// A frame in which nothing arrives: the same values under the next number, events are over.
  const Frame& hold();
  /// The FAPs that fill() would have in its result if the clip ended here.
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

/// The frame with another mask: FAPs that it did not have are at rest, 0; viseme and expression are
/// forgotten where the mask has none.
Frame with_mask(Frame frame, const Mask& mask);

}  // namespace animeme::fap

/// @file
/// FAP 1 and 2 (visemes, expressions) as low-level FAPs, for players and heads that know these
/// only.
///
///     Result<Sequence> plain = fill(clip, {.expand = true});   // whole clips: fap/fill.h
///     Frame frame = low_level(other);                          // one frame
///
/// The standard names the shapes and leaves their form to the player; these are ours, chosen by eye
/// on the heads of fap/head, which show FAP 1 and 2 by the same tables. What the same visemes look
/// like in measured speech, which is calmer and has no tongue: viseme_shape() in fap/viseme.h.
#pragma once

#include <array>

#include "fap/frame.h"

namespace animeme::fap {

/// The low-level FAPs of viseme 0..14 at full strength; FAPs that rest are absent. Others: empty.
Frame viseme_pose(int viseme);

/// The same for expression 0..6.
Frame expression_pose(int expression);

/// The frame with its FAP 1 and 2 as low-level FAPs: viseme1 * blend/63 + viseme2 * (1 - blend/63)
/// + expression1 * intensity1/63 + expression2 * intensity2/63. Low-level FAPs that the frame has
/// itself win over those of the shapes. Source: fap/semantics.md, sections 4 and 5.
Frame low_level(const Frame& frame);

/// The same from frame to frame, with shapes that the stream defines itself:
///
/// - viseme_def: the jaw, lips and tongue that are coded in the same frame are from then on what
///   the viseme looks like that this frame shows alone (blend 63: select1, blend 0: select2);
/// - expression_def: all low-level FAPs of the frame, made as much larger as the intensity is
///   smaller than 63, are what its only expression looks like.
///
/// With two shapes in the frame a definition is ambiguous and passed over. init_face changes the
/// neutral face, which is the player's own, and no FAP. Source: fap/semantics.md, sections 4 and 5.
class Expander {
 public:
  Expander();

  /// A frame has arrived; `coded` has what is coded and no more.
  void receive(const Frame& coded);
  /// `shown`, the same frame with what is held and derived, without FAP 1 and 2. Low-level FAPs of
  /// its own win over the shapes, but for those that have come in definitions only.
  Frame expand(const Frame& shown) const;

 private:
  void define(const Frame& coded);

  std::array<Frame, 15> visemes_;
  std::array<Frame, 7> expressions_;
  Mask defining_;  // sent as part of definitions, and what follows from it
};

}  // namespace animeme::fap

/// @file
/// FAP 1 and 2 (visemes, expressions) as low-level FAPs, for players and heads that support only
/// these.
///
///     Result<Sequence> plain = fill(clip, {.expand = true});   // whole clips: fap/fill.h
///     Frame frame = low_level(other);                          // one frame
///
/// The standard names the shapes and leaves their form to the player; these were chosen by eye on
/// the heads of fap/head, which use the same tables. For the visemes of measured speech, which is
/// calmer and has no tongue, see viseme_shape() in fap/viseme.h.
#pragma once

#include <array>

#include "fap/frame.h"

namespace animeme::fap {

/// The low-level FAPs of viseme 0..14 at full strength; FAPs at rest are absent. Other numbers:
/// empty.
Frame viseme_pose(int viseme);

/// The same for expression 0..6.
Frame expression_pose(int expression);

/// The frame with its FAP 1 and 2 as low-level FAPs: viseme1 * blend/63 + viseme2 * (1 - blend/63)
/// + expression1 * intensity1/63 + expression2 * intensity2/63. The frame's own low-level FAPs
/// override those of the shapes. Source: fap/semantics.md, sections 4 and 5.
Frame low_level(const Frame& frame);

/// The same from frame to frame, with shapes that the stream defines:
///
/// - viseme_def: the jaw, lips and tongue coded in the same frame become the shape of the viseme
///   that this frame shows alone (blend 63: select1, blend 0: select2);
/// - expression_def: all low-level FAPs of the frame, scaled by 63 / intensity, become the shape of
///   its only expression.
///
/// With two shapes in the frame a definition is ambiguous and ignored. init_face changes the
/// neutral face, which belongs to the player, and no FAP. Source: fap/semantics.md, sections 4 and
/// 5.
class Expander {
 public:
  Expander();

  /// Takes the definitions of a frame; `coded` has only what is coded.
  void receive(const Frame& coded);
  /// `shown` without FAP 1 and 2; `shown` is the same frame with held and derived values. Its own
  /// low-level FAPs override the shapes, except those that only occurred in definitions.
  Frame expand(const Frame& shown) const;

 private:
  void define(const Frame& coded);

  std::array<Frame, 15> visemes_;
  std::array<Frame, 7> expressions_;
  Mask defining_;  // sent as part of definitions, and what is derived from it
};

}  // namespace animeme::fap

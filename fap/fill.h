/// @file
/// Completes coded frames, whose masks have gaps, so that any player can show them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "fap/frame.h"
#include "fap/result.h"
#include "fap/tables.h"

namespace animeme::fap {

/// Value of the FAPs of a group that a frame does not carry. A coded stream defines it, group by
/// group (mask types, codec/bitstream.md, section 3.1); a text file does not.
enum class GroupRule : std::uint8_t {
  unknown,      ///< undefined: held, or derived by FillOptions
  hold,         ///< types 0, 1 and 3: they keep the shown value, neutral (0) if there is none
  interpolate,  ///< type 2: they follow other FAPs of this frame, or hold if none applies
};

/// The rules of one frame; index = group number - 1. All unknown by default.
using GroupRules = std::array<GroupRule, kGroupCount>;

/// Default limit for missing frames.
inline constexpr std::int64_t kMostMissing = 100'000;

/// The rules of the standard that fill() applies.
struct FillOptions {
  /// A side that was never sent takes the value of the other side (23 left/right pairs). Positive
  /// directions are mirrored by definition, so this is a copy.
  bool mirror = true;
  /// A lip contour that was never sent follows the other one (10 inner/outer pairs).
  bool lips = true;
  /// A FAP that is absent from a frame takes the value of its partner in the same frame even if it
  /// has an older value of its own, as in mask type 2 of the bitstream; false holds the older
  /// value, as in types 0 and 1. Text files do not define this. No effect on groups with a known
  /// rule.
  bool prefer_partner = false;
  /// Imitates the known public decoder, to compare with its output: a FAP that is absent from a
  /// frame takes the value of the other side if the frame has it, whatever the rule of its group;
  /// else it holds. Lips never follow. `mirror`, `lips`, `prefer_partner` and all rules are
  /// ignored. Source: codec/bitstream.md, section 9.
  bool like_public_decoder = false;
  /// Skipped frames: interpolated between their neighbours, rounded (true), or copies of the
  /// previous frame (false, like a receiver).
  bool interpolate = false;
  /// Keep FAP 1 and 2 in frames with low-level FAPs. Known players disagree about such frames, so
  /// FAP 1 and 2 are dropped if there are any other FAPs.
  bool keep_high_level = false;
  /// Convert FAP 1 and 2 to low-level FAPs (fap/expand.h), for players that support no others.
  /// Low-level FAPs that are sent or held override those of the shapes.
  bool expand = false;
  /// With `expand`: FAP 2 stays as it is, also beside other FAPs, for heads that show it by faces
  /// of their own (head::control_values()); only FAP 1 is converted. What a stream defines as an
  /// expression (Expression::def) is not used then.
  bool keep_expressions = false;
  /// Include low-level FAPs that were never sent and cannot be derived, at 0 (neutral), unless FAP
  /// 1 and 2 are the only ones. This is what a receiver of a coded stream shows: an encoder omits
  /// FAPs that stay at 0.
  bool complete = false;
  /// Largest number of frames in the result, about 380 bytes each.
  std::int64_t max_frames = 1'000'000;
  /// Largest total number of missing frames: they take no room in a file but as much as others in
  /// the result, so a text of two lines could exhaust the memory. More than an hour at 25 frames
  /// per second.
  std::int64_t max_missing = kMostMissing;
};

/// Fills `sequence`: the result has the frame numbers 0, 1, 2 ... up to the last one, and the same
/// mask in each frame: all FAPs that were ever sent and those that follow from them.
///
/// Rules in order of priority, by mask and never by "the value is 0" (which would move the other
/// side of a face that rests on purpose): the value in the frame; the last value sent; for a FAP
/// that was never sent, the other side, then the other lip contour, then the other side of that; 0
/// (neutral). Held visemes and expressions lose their `def` and `init_face` flags, which are
/// events. Source: fap/semantics.md, section 6; a table sent in the scene (FIT) is not supported.
///
/// Errors: Code::invalid_argument if the frame numbers are negative or do not ascend;
/// Code::out_of_range if the result would have more than max_frames frames, or more than
/// max_missing of them are not in `sequence`.
Result<Sequence> fill(const Sequence& sequence, const FillOptions& options = {});

/// The same with known rules: rules[i] are those of sequence.frames[i]. A FAP obeys the rule of its
/// own group; the group of the FAP that it follows does not matter.
///
/// hold: the value shown before stays, whether sent or derived under an earlier rule, so nothing
/// jumps when a stream changes the rule. The FAP follows nothing.
///
/// interpolate: the FAP takes the value of the first of these that is in the same frame: its other
/// side (`mirror`); its other lip contour (`lips`); the other side of that (both). Neither its own
/// older value nor a held or derived value of a partner counts: only FAPs of this frame are
/// sources. If there is none (any more), the value shown before stays. The result does not depend
/// on the order in which FAPs are filled.
///
/// Values in the frame always win. Skipped frames hold, or are interpolated between their
/// neighbours if `interpolate` is set. Filling the result again under the same rules changes
/// nothing if the rules are the same in all frames.
///
/// Errors: as above, and Code::invalid_argument if `rules` does not have one entry per frame. An
/// empty `rules` means that all are unknown.
Result<Sequence> fill(const Sequence& sequence, std::span<const GroupRules> rules,
                      const FillOptions& options);

}  // namespace animeme::fap

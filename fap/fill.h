/// @file
/// From coded frames, whose masks have gaps, to complete ones that any player can show.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "fap/frame.h"
#include "fap/result.h"
#include "fap/tables.h"

namespace animeme::fap {

/// What becomes of the FAPs of a group that a frame does not carry. A coded stream says so, group
/// by group (mask types, codec/bitstream.md, section 3.1); a text file does not.
enum class GroupRule : std::uint8_t {
  unknown,      ///< not said: held, or derived as FillOptions say
  hold,         ///< types 0, 1 and 3: they keep the value they show; never had one: neutral, 0
  interpolate,  ///< type 2: they follow the FAPs of this frame, or hold if none of those fits
};

/// The rules of one frame; index = group number - 1. All unknown by default.
using GroupRules = std::array<GroupRule, kGroupCount>;

/// Most frames that are filled in unless more are asked for.
inline constexpr std::int64_t kMostMissing = 100'000;

/// Which of the rules of the standard fill() follows.
struct FillOptions {
  /// A side that was never sent takes the value of the other side (23 left/right pairs). Positive
  /// directions are mirrored by definition, so this is a copy.
  bool mirror = true;
  /// A lip contour that was never sent follows the other one (10 inner/outer pairs).
  bool lips = true;
  /// A FAP that is absent from a frame takes the value of its partner in the same frame even
  /// if it has an older value of its own. That is what mask type 2 of the bitstream means; false
  /// holds the older value as types 0 and 1 mean. Text files do not say which. No effect on
  /// groups whose rule is known.
  bool prefer_partner = false;
  /// Shows what the known public decoder shows, to compare with its output: a FAP that is absent
  /// from a frame takes the value of the other side if that is in the frame, whatever the rule of
  /// its group; else it holds. Lips never follow. `mirror`, `lips`, `prefer_partner` and all rules
  /// are ignored. Source: codec/bitstream.md, section 9.
  bool like_public_decoder = false;
  /// Frames that were skipped: values between their neighbours, rounded (true), or those of the
  /// frame before (false, what a receiver shows).
  bool interpolate = false;
  /// Keep FAP 1 and 2 beside low-level FAPs. Known players disagree about such frames, so they
  /// are left out as long as there is anything else.
  bool keep_high_level = false;
  /// FAP 1 and 2 become low-level FAPs as fap/expand.h says, so that players that know no others
  /// show them. Low-level FAPs that are sent win over those of the shapes; held ones do, too.
  bool expand = false;
  /// Low-level FAPs that were never sent and follow from none are in the result, too, at 0
  /// (neutral), unless FAP 1 and 2 are all there is. That is what a receiver of a coded
  /// stream shows: an encoder leaves FAPs out that stay at 0.
  bool complete = false;
  /// Most frames that the result may have, about 380 bytes each.
  std::int64_t max_frames = 1'000'000;
  /// Most frames that may be missing, all together: they take no room in a file but as much in the
  /// result, so a text of two lines could ask for all of the memory. More than an hour at 25 a
  /// second.
  std::int64_t max_missing = kMostMissing;
};

/// Fills `sequence`: the result has the frame numbers 0, 1, 2 ... up to the last one, and the same
/// mask in each frame: all FAPs that were ever sent and those that follow from them.
///
/// The rules in their order, by mask and never by "the value is 0" (which would move the other
/// side of a face that rests on purpose): the value in the frame; the last value sent; for a FAP
/// never sent so far the other side, then the other lip contour, then the other side of that;
/// 0 (neutral). Held visemes and expressions lose their `def` and `init_face` flags, which are
/// events. Source: fap/semantics.md, section 6; a table sent in the scene (FIT) is not known here.
///
/// Errors: Code::invalid_argument if the frame numbers are negative or do not ascend;
/// Code::out_of_range if the result would have more than max_frames frames, or more than
/// max_missing of them are not in `sequence`.
Result<Sequence> fill(const Sequence& sequence, const FillOptions& options = {});

/// The same where the rules are known: rules[i] are those of sequence.frames[i]. A FAP obeys the
/// rule of its own group; the group of the FAP that it follows does not matter.
///
/// hold: the value shown before stays, be it sent or derived under an earlier rule, so nothing
/// jumps when a stream changes the rule. The FAP follows nothing.
///
/// interpolate: the FAP takes the value of the first of these that is in the same frame: its
/// other side (`mirror`); its other lip contour (`lips`); the other side of that (both). An older
/// value of its own does not count, and neither does a held or derived value of a partner: only
/// what this frame carries is a source. If there is none (any more), the value shown before stays.
/// The result does not depend on the order in which FAPs are filled.
///
/// Values in the frame always win. Skipped frames hold, or lie between their neighbours if
/// `interpolate` is set. Filling the result again under the same rules changes nothing, if
/// these are the same in all frames.
///
/// Errors: as above, and Code::invalid_argument if `rules` has not one entry for each frame. An
/// empty `rules` means that all are unknown.
Result<Sequence> fill(const Sequence& sequence, std::span<const GroupRules> rules,
                      const FillOptions& options);

}  // namespace animeme::fap

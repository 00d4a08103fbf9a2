/// @file
/// The meaning of morph target names in FAPs.
///
///     meaning_of("eyeBlink_L")       // ARKit, in any usual spelling
///     meaning_of("viseme_PP")        // Oculus and Meta; also "PP", "v_PP", "vrc.v_pp"
///     meaning_of("eyesClosed")       // both lids: other usual names
///     meaning_of("Face.M_F00_000_00_Fcl_MTH_A")  // VRoid
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/frame.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

/// The naming convention of a shape.
enum class ShapeSet : std::uint8_t { arkit, viseme, other };

/// A part of a shape of ARKit.
struct ArkitPart {
  int channel = 0;  ///< see fap::kArkitNames
  int sides = 3;    ///< 1 left half, 2 right half, 3 both
  int lips = 3;     ///< 1 what it does to the upper lip, 2 to the lower one, 3 both

  friend auto operator<=>(const ArkitPart&, const ArkitPart&) = default;
};

/// The meaning of a name.
struct ShapeMeaning {
  ShapeSet set = ShapeSet::other;  ///< naming convention
  int viseme = -1;                 ///< of a viseme
  int mood = 0;                    ///< of a whole face: expression 1..6 of FAP 2; 7: a calm smile
  int fap = 0;                     ///< of a single FAP, 3..68; 0: of none
  std::vector<ArkitPart> parts;    ///< of the others, ascending
  std::string_view house = {};     ///< a convention beside ARKit's; see detail/house_names.h
  /// At weight 1: of a single FAP 1024 units, 20 degrees of an eye (make_rig() measures what the
  /// shape does, where the feature point is known); else the sum of fap::arkit_to_fap() of the
  /// parts; for a viseme head::viseme_shape(), so that FAP 1 at full strength is weight 1.
  fap::Frame faps;
};

/// Meaning of a name; nullopt if unknown.
///
/// Ignores case, spaces, dots and underscores, a prefix such as "blendShape1." or "A14_", and the
/// spelling of the side ("_L", "Left"). A shape of ARKit with two sides may be split
/// ("browInnerUp_L"); one with sides may be joined ("mouthSmile"). Other names: blink and
/// eyesClosed, winks, mouthOpen, smile, gaze up, down, left, right, brows up and down, the brows of
/// VRoid (BRW_Angry ...) and MMD; the vowels A I U E O of VRM, VRoid and MMD are visemes; joy,
/// angry, sorrow, fun, surprised of VRM 0.x and VRoid (ALL_Joy ...), happy, sad and relaxed of VRM
/// 1.0 are moods. Names of Character Creator, Unified Expressions, SRanipal, Faceshift, Daz,
/// Autodesk's Character Generator (VALID) and MakeHuman: detail/house_names.h. FAPs by name or
/// number
/// ("open_jaw", "FAP3", "fap_03_open_jaw"), but those of the head's turns. What stands before
/// the name proper may be any words that end in ".", ":", "|" or "__". Names that are known no
/// other way may have their side at another place ("L_eyeBlink", "eyeLeftBlink"), and words such as
/// "_bs", "_mesh" or ".001" behind them.
std::optional<ShapeMeaning> meaning_of(std::string_view name);

/// The same; a name that is not known and begins with `prefix` means what follows it.
std::optional<ShapeMeaning> meaning_of(std::string_view name, std::string_view prefix);

/// What stands before at least three names that would be known without it, and not before more that
/// would not: "Emma_" of "Emma_jawOpen", "Emma_mouthClose" ...; empty: nothing does.
std::string common_prefix(const std::vector<std::string>& names);

/// A shape that a head uses.
struct ChosenShape {
  std::string name;                ///< the first of its names
  ShapeMeaning meaning;            ///< what it does
  std::vector<std::size_t> names;  ///< all its names, as indices of the list given
};

/// Names that neither meaning_of() nor a rule knows.
std::vector<std::string> unknown_names(const std::vector<std::string>& names,
                                       const ShapeRules& rules = {});

/// A sentence for a file that nothing moves: which names it has, and what to do. `unknown`: these.
std::string advice_on_names(const std::vector<std::string>& unknown);

/// The shape as a control of a head.
head::ShapeControl control_of(const ChosenShape& shape);

/// Selects the shapes that move a head: first those of ARKit. If ARKit's jaw and mouth are complete
/// (see MouthShapes), visemes have no FAPs and are used for FAP 1 only. Other names are used only
/// for what no ARKit shape does. Of several names that mean the same, that of the convention with
/// the most shapes counts, ARKit's if it has a mouth, and the others are its further names: for
/// meshes that have only those. Unknown and unused shapes are noted. Names with a rule mean what
/// that says, and go before all others; rules for other names are ignored (check_rules()).
std::vector<ChosenShape> choose_shapes(const std::vector<std::string>& names, MouthShapes mouth,
                                       std::vector<std::string>& notes,
                                       const ShapeRules& rules = {});

}  // namespace animeme::gltf

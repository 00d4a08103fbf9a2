/// @file
/// The tables of the standard: each FAP with its unit, group, feature point and quantiser step.
/// Data only; the source of each table is noted beside it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "fap/frame.h"

namespace animeme::fap {

/// FAP units (FAPU). A distance unit is that distance on the neutral face; one FAP step is
/// 1/1024 of it, for `angle` 1e-5 rad. Source: fap/semantics.md, section 2.
enum class Unit : std::uint8_t { none, irisd, es, ens, mns, mw, angle };

/// "IRISD", "ES", "ENS", "MNS", "MW", "AU" (angle unit), "" for none.
std::string_view unit_name(Unit unit);

/// Direction of positive values, from the person's view ("left" is the person's left).
enum class Motion : std::uint8_t { none, down, up, left, right, forward, growing, concave_upward };

/// One row of the FAP table. Source: fap/semantics.md, section 3; ranges: codec/bitstream.md,
/// section 3.2.
struct FapInfo {
  int number;                      ///< 1..68
  std::string_view name;           ///< the standard's name, e.g. "open_jaw"
  Unit unit;                       ///< none for FAP 1 and 2
  Motion motion;                   ///< direction of positive values
  bool unidirectional;             ///< meant for values >= 0 only (real files break this)
  int group;                       ///< 1..10
  int mirror;                      ///< the same FAP of the other side, 0: none
  int partner;                     ///< inner lip <-> outer lip FAP, 0: none
  std::string_view feature_point;  ///< e.g. "2.1", empty: none or rotation
  int quant_step;                  ///< FAP units per level at fap_quant 1 (QP)
  int default_i_range;             ///< intra levels are within +-this if no range was sent
  int default_p_range;             ///< predictive levels are within +-this if no range was sent
};

/// One FAP group: FAPs first .. first + size - 1.
struct GroupInfo {
  int first;              ///< number of its first FAP
  int size;               ///< number of FAPs
  std::string_view name;  ///< for people
};

inline constexpr int kGroupCount = 10;                    ///< groups of a mask
extern const std::array<GroupInfo, kGroupCount> kGroups;  ///< index = group number - 1
extern const std::array<FapInfo, kFapCount> kFaps;        ///< index = FAP number - 1

/// Row of FAP `number` (1..68; anything else is a programming error).
inline const FapInfo& info(int number) { return kFaps[std::size_t(number - 1)]; }

/// FAP number of a name ("open_jaw"; case as in the standard), nullopt if unknown.
std::optional<int> find_fap(std::string_view name);

/// The 15 visemes of FAP 1 by number. `morph` is the Oculus / Ready Player Me target name.
struct VisemeInfo {
  std::string_view name;      ///< "PP", "aa" ...
  std::string_view phonemes;  ///< SAMPA
  std::string_view morph;     ///< "viseme_PP" ...
};
extern const std::array<VisemeInfo, 15> kVisemes;  ///< index = viseme number

/// The expressions of FAP 2 by number; 0 is neutral.
extern const std::array<std::string_view, 7> kExpressions;

/// One of the 84 feature points, e.g. {"2.1", "bottom of the chin"}.
struct FeaturePointInfo {
  std::string_view id;    ///< "2.1"
  std::string_view name;  ///< its position on the face
};
extern const std::array<FeaturePointInfo, 84> kFeaturePoints;  ///< by group, then by number

}  // namespace animeme::fap

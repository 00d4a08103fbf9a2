#include "tools/view/gltf/detail/house_names.h"

#include <algorithm>
#include <unordered_map>

#include "fap/arkit.h"

namespace animeme::gltf {
namespace {

// `keys` and `shapes` are words between blanks. "#" in both is left, then right. A shape may have a
// part behind a colon: l, r (its side), u, d (upper, lower lip), or both ("ul").
struct Row {
  std::string_view house;
  std::string_view keys;
  std::string_view shapes;
  int viseme = -1;
};

constexpr std::string_view kCreator = "Character Creator", kUnified = "Unified Expressions",
                           kSranipal = "SRanipal", kFaceshift = "Faceshift", kDaz = "Daz",
                           kValid = "Autodesk", kHuman = "MakeHuman";

constexpr Row kRows[] = {
    // Character Creator 3 and 4.
    {kCreator, "browraiseinner#", "browInnerUp:#"},
    {kCreator, "browraiseouter#", "browOuterUp#"},
    {kCreator, "browdrop#", "browDown#"},
    {kCreator, "cheekraise#", "cheekSquint#"},
    {kCreator, "mouthrollinlower mouthlipsrollinlower", "mouthRollLower"},
    {kCreator, "mouthrollinupper mouthlipsrollinupper", "mouthRollUpper"},
    {kCreator, "mouthrollinlower#", "mouthRollLower:#"},
    {kCreator, "mouthrollinupper#", "mouthRollUpper:#"},
    {kCreator, "mouthdownlower#", "mouthLowerDown#"},
    {kCreator, "mouthupupper#", "mouthUpperUp#"},
    {kCreator, "mouthdownlower", "mouthLowerDownLeft mouthLowerDownRight"},
    {kCreator, "mouthupupper", "mouthUpperUpLeft mouthUpperUpRight"},
    {kCreator, "mouthpuckerup#", "mouthPucker:u#"},
    {kCreator, "mouthpuckerdown#", "mouthPucker:d#"},
    {kCreator, "mouthfunnelup#", "mouthFunnel:u#"},
    {kCreator, "mouthfunneldown#", "mouthFunnel:d#"},
    {kCreator, "mouthchinup mouthlipsjawadjust", "mouthShrugLower"},
    {kCreator, "mouthlipstuck", "mouthRollUpper mouthRollLower"},
    {kCreator, "mouthlipspartclose mouthlipstight", "mouthPressLeft mouthPressRight"},
    {kCreator, "mouthwiden mouthwidensides", "mouthStretchLeft mouthStretchRight"},
    {kCreator, "mouthplosive", "", 1},
    {kCreator, "mouthpuckeropen mouthpout", "mouthPucker"},
    {kCreator, "eyeleftlookup eyelooksupleft", "eyeLookUpLeft"},
    {kCreator, "eyerightlookup eyelooksupright", "eyeLookUpRight"},
    {kCreator, "eyeleftlookdown", "eyeLookDownLeft"},
    {kCreator, "eyerightlookdown", "eyeLookDownRight"},
    {kCreator, "eyeleftlookleft", "eyeLookOutLeft"},
    {kCreator, "eyeleftlookright", "eyeLookInLeft"},
    {kCreator, "eyerightlookleft", "eyeLookInRight"},
    {kCreator, "eyerightlookright", "eyeLookOutRight"},
    {kCreator, "vopen", "", 10},
    {kCreator, "vexplosive explosive", "", 1},
    {kCreator, "vdentallip dentallip", "", 2},
    {kCreator, "vtighto tighto", "", 14},
    {kCreator, "vwide", "", 12},
    {kCreator, "vaffricate affricate", "", 6},
    // VRCFaceTracking's Unified Expressions.
    {kUnified, "eyeclosed#", "eyeBlink#"},
    {kUnified, "eyeclosed", "eyeBlinkLeft eyeBlinkRight"},
    {kUnified, "browlowerer#", "browDown#"},
    {kUnified, "browinnerup#", "browInnerUp:#"},
    {kUnified, "cheekpuff# cheekpuffsuck#", "cheekPuff:#"},
    {kUnified, "mouthclosed", "mouthClose"},
    {kUnified, "lipsuckupper", "mouthRollUpper"},
    {kUnified, "lipsucklower", "mouthRollLower"},
    {kUnified, "lipsuckupper#", "mouthRollUpper:#"},
    {kUnified, "lipsucklower#", "mouthRollLower:#"},
    {kUnified, "lipfunnel", "mouthFunnel"},
    {kUnified, "lippucker", "mouthPucker"},
    {kUnified, "lipfunnelupper#", "mouthFunnel:u#"},
    {kUnified, "lipfunnellower#", "mouthFunnel:d#"},
    {kUnified, "lippuckerupper#", "mouthPucker:u#"},
    {kUnified, "lippuckerlower#", "mouthPucker:d#"},
    {kUnified, "lipfunnelupper", "mouthFunnel:u"},
    {kUnified, "lipfunnellower", "mouthFunnel:d"},
    {kUnified, "lippuckerupper", "mouthPucker:u"},
    {kUnified, "lippuckerlower", "mouthPucker:d"},
    {kUnified, "mouthcornerpull#", "mouthSmile#"},
    {kUnified, "mouthsad#", "mouthFrown#"},
    {kUnified, "mouthsad", "mouthFrownLeft mouthFrownRight"},
    {kUnified, "mouthdimpler#", "mouthDimple#"},
    {kUnified, "mouthraiserupper", "mouthShrugUpper"},
    {kUnified, "mouthraiserlower", "mouthShrugLower"},
    {kUnified, "mouthtightener#", "mouthPress#"},
    // HTC's SRanipal.
    {kSranipal, "eye#blink", "eyeBlink#"},
    {kSranipal, "eye#wide", "eyeWide#"},
    {kSranipal, "eye#squeeze", "eyeSquint#"},
    {kSranipal, "eye#up", "eyeLookUp#"},
    {kSranipal, "eye#down", "eyeLookDown#"},
    {kSranipal, "eyeleftleft", "eyeLookOutLeft"},
    {kSranipal, "eyeleftright", "eyeLookInLeft"},
    {kSranipal, "eyerightleft", "eyeLookInRight"},
    {kSranipal, "eyerightright", "eyeLookOutRight"},
    {kSranipal, "mouthapeshape", "mouthClose"},
    {kSranipal, "mouthoshape", "mouthFunnel"},
    {kSranipal, "mouthpout", "mouthPucker"},
    {kSranipal, "mouthupperinside", "mouthRollUpper"},
    {kSranipal, "mouthlowerinside", "mouthRollLower"},
    {kSranipal, "mouthupperoverturn", "mouthShrugUpper"},
    {kSranipal, "mouthloweroverlay", "mouthShrugLower"},
    {kSranipal, "tonguelongstep2", "tongueOut"},
    // Faceshift.
    {kFaceshift, "eyeopen#", "eyeWide#"},
    {kFaceshift, "eyedown#", "eyeLookDown#"},
    {kFaceshift, "eyeup#", "eyeLookUp#"},
    {kFaceshift, "eyein#", "eyeLookIn#"},
    {kFaceshift, "eyeout#", "eyeLookOut#"},
    {kFaceshift, "browsd#", "browDown#"},
    {kFaceshift, "browsu#", "browOuterUp#"},
    {kFaceshift, "browsuc", "browInnerUp"},
    {kFaceshift, "jawfwd", "jawForward"},
    {kFaceshift, "lipstogether", "mouthClose"},
    {kFaceshift, "lipsfunnel", "mouthFunnel"},
    {kFaceshift, "lipspucker", "mouthPucker"},
    {kFaceshift, "lipsstretch#", "mouthStretch#"},
    {kFaceshift, "lipsupperclose", "mouthRollUpper"},
    {kFaceshift, "lipslowerclose", "mouthRollLower"},
    {kFaceshift, "lipsupperup lipsupperopen", "mouthUpperUpLeft mouthUpperUpRight"},
    {kFaceshift, "lipslowerdown lipsloweropen", "mouthLowerDownLeft mouthLowerDownRight"},
    {kFaceshift, "lipsupperup#", "mouthUpperUp#"},
    {kFaceshift, "lipslowerdown#", "mouthLowerDown#"},
    {kFaceshift, "chinlowerraise", "mouthShrugLower"},
    {kFaceshift, "chinupperraise", "mouthShrugUpper"},
    {kFaceshift, "sneer", "noseSneerLeft noseSneerRight"},
    {kFaceshift, "puff", "cheekPuff"},
    // Daz Studio: Genesis 3 and 8; 8.1 and 9 have ARKit's names.
    {kDaz, "eyesclosed#", "eyeBlink#"},
    {kDaz, "mouthopenwide", "jawOpen"},
    {kDaz, "mouthsmilesimple# mouthcornerup#", "mouthSmile#"},
    {kDaz, "mouthsmilesimple", "mouthSmileLeft mouthSmileRight"},
    {kDaz, "lippucker lipspucker lipspuckerwide", "mouthPucker"},
    {kDaz, "vaa", "", 10},
    {kDaz, "veh ver", "", 11},
    {kDaz, "vih viy vee", "", 12},
    {kDaz, "vow", "", 13},
    {kDaz, "vuw vw", "", 14},
    {kDaz, "vf", "", 2},
    {kDaz, "vm", "", 1},
    {kDaz, "vth", "", 3},
    {kDaz, "vt vl", "", 4},
    {kDaz, "vk", "", 5},
    {kDaz, "vsh", "", 6},
    {kDaz, "vs", "", 7},
    // Autodesk's Character Generator, and the avatars of VALID that it made.
    {kValid, "leyeclose", "eyeBlinkLeft"},
    {kValid, "reyeclose", "eyeBlinkRight"},
    {kValid, "leyeopen", "eyeWideLeft"},
    {kValid, "reyeopen", "eyeWideRight"},
    {kValid, "llowlid", "eyeSquintLeft"},
    {kValid, "rlowlid", "eyeSquintRight"},
    {kValid, "lsmileclose lsmileopen", "mouthSmileLeft"},
    {kValid, "rsmileclose rsmileopen", "mouthSmileRight"},
    {kValid, "lmouthsad", "mouthFrownLeft"},
    {kValid, "rmouthsad", "mouthFrownRight"},
    {kValid, "kiss", "mouthPucker"},
    {kValid, "lbrowup", "browInnerUp:left"},
    {kValid, "rbrowup", "browInnerUp:right"},
    {kValid, "llbrowup", "browOuterUpLeft"},
    {kValid, "rrbrowup", "browOuterUpRight"},
    {kValid, "lbrowdown llbrowdown", "browDownLeft"},
    {kValid, "rbrowdown rrbrowdown", "browDownRight"},
    {kValid, "lblowcheek lblowcheeks", "cheekPuff:left"},
    {kValid, "rblowcheek rblowcheeks", "cheekPuff:right"},
    {kValid, "mpbup mpb mpbdown", "", 1},
    {kValid, "fv", "", 2},
    {kValid, "tds tdi", "", 4},
    {kValid, "kg", "", 5},
    {kValid, "shch", "", 6},
    {kValid, "aeaa aoa", "", 10},
    {kValid, "axe hest", "", 11},
    {kValid, "uhoo", "", 13},
    {kValid, "uwu", "", 14},
    // MakeHuman's face units, also in MPFB.
    {kHuman, "jawdrop jawdropstretched", "jawOpen"},
    {kHuman, "lipskiss", "mouthPucker"},
    {kHuman, "leftupperlidclosed", "eyeBlinkLeft"},
    {kHuman, "rightupperlidclosed", "eyeBlinkRight"},
    {kHuman, "leftupperlidopen", "eyeWideLeft"},
    {kHuman, "rightupperlidopen", "eyeWideRight"},
    {kHuman, "leftlowerlidup", "eyeSquintLeft"},
    {kHuman, "rightlowerlidup", "eyeSquintRight"},
    {kHuman, "leftbrowdown", "browDownLeft"},
    {kHuman, "rightbrowdown", "browDownRight"},
    {kHuman, "leftouterbrowup", "browOuterUpLeft"},
    {kHuman, "rightouterbrowup", "browOuterUpRight"},
    {kHuman, "leftinnerbrowup", "browInnerUp:left"},
    {kHuman, "rightinnerbrowup", "browInnerUp:right"},
    {kHuman, "leftcheekup", "cheekSquintLeft"},
    {kHuman, "rightcheekup", "cheekSquintRight"},
    {kHuman, "cheekspump", "cheekPuff"},
    {kHuman, "nosewrinkler", "noseSneerLeft noseSneerRight"},
    {kHuman, "mouthleftpullup", "mouthSmileLeft"},
    {kHuman, "mouthrightpullup", "mouthSmileRight"},
    {kHuman, "mouthleftpulldown", "mouthFrownLeft"},
    {kHuman, "mouthrightpulldown", "mouthFrownRight"},
    {kHuman, "mouthleftpullside", "mouthStretchLeft"},
    {kHuman, "mouthrightpullside", "mouthStretchRight"},
    {kHuman, "mouthmoveleft", "mouthLeft"},
    {kHuman, "mouthmoveright", "mouthRight"},
    {kHuman, "chinleft", "jawLeft"},
    {kHuman, "chinright", "jawRight"},
    {kHuman, "chinforward", "jawForward"},
    {kHuman, "upperlipup", "mouthUpperUpLeft mouthUpperUpRight"},
    {kHuman, "lowerlipdown", "mouthLowerDownLeft mouthLowerDownRight"},
    {kHuman, "upperlipbackward", "mouthRollUpper"},
    {kHuman, "lowerlipbackward", "mouthRollLower"},
    {kHuman, "lowerlipup", "mouthShrugLower"},
};

std::vector<std::string> blank_separated(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    words.emplace_back(text.substr(0, text.find(' ')));
    text.remove_prefix(std::min(words.back().size() + 1, text.size()));
  }
  return words;
}

// "mouthFunnel:ul", "eyeBlinkLeft".
ArkitPart part_of_text(const std::string& text) {
  ArkitPart part;
  const std::size_t colon = text.find(':');
  part.channel = fap::find_arkit(text.substr(0, colon)).value_or(0);
  if (colon == std::string::npos) return part;
  const std::string_view where = std::string_view(text).substr(colon + 1);
  const bool upper = where.starts_with("u"), lower = where.starts_with("d");
  if (upper || lower) part.lips = upper ? 1 : 2;
  if (where.ends_with("left")) part.sides = 1;
  if (where.ends_with("right")) part.sides = 2;
  return part;
}

using Table = std::unordered_map<std::string, HouseName>;

void add(Table& table, const Row& row, std::string_view side) {
  const auto expand = [&](std::string word, bool capital) {
    const std::size_t at = word.find('#');
    if (at == std::string::npos) return word;
    std::string text(side);
    // "eyeBlink#" is eyeBlinkLeft, "cheekPuff:#" a part.
    if (capital && word.find(':') == std::string::npos) text[0] = char(text[0] - 'a' + 'A');
    return word.replace(at, 1, text);
  };
  HouseName name{row.house, {}, row.viseme};
  for (const std::string& shape : blank_separated(row.shapes)) {
    name.parts.push_back(part_of_text(expand(shape, true)));
  }
  std::sort(name.parts.begin(), name.parts.end());
  for (const std::string& key : blank_separated(row.keys)) {
    table.try_emplace(expand(key, false), name);
  }
}

Table make_table() {
  Table table;
  for (const Row& row : kRows) {
    const bool sided = row.keys.find('#') != std::string_view::npos;
    add(table, row, "left");
    if (sided) add(table, row, "right");
  }
  return table;
}

}  // namespace

const HouseName* find_house_name(const std::string& key) {
  static const Table kTable = make_table();
  const auto found = kTable.find(key);
  return found == kTable.end() ? nullptr : &found->second;
}

}  // namespace animeme::gltf

// Names of shapes in the conventions of programs and projects other than ARKit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {

/// What a convention says of a name.
struct HouseName {
  std::string_view house;        ///< "Character Creator", "Unified Expressions" ...
  std::vector<ArkitPart> parts;  ///< of shapes of ARKit, ascending; empty: a viseme
  int viseme = -1;
};

/// By the words of a name (words.h), joined: "mouthdownlowerleft". Conventions: Character Creator 4
/// (Mouth_Down_Lower_L, V_Open), Unified Expressions of VRCFaceTracking (MouthCornerPullLeft),
/// SRanipal (Mouth_Ape_Shape), Faceshift (LipsFunnel), Daz (eCTRLvAA), VALID and Autodesk's
/// Character Generator (LeyeClose, MPB_Up), MakeHuman and MPFB (JawDrop). nullptr: unknown.
const HouseName* find_house_name(const std::string& key);

}  // namespace animeme::gltf

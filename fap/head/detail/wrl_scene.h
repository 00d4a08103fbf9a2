// VRML97 as a scene graph.
#pragma once

#include "fap/head/detail/scene.h"

namespace animeme::head::detail {

/// The nodes at the top of a VRML97 text. Errors: see read_wrl().
Result<std::vector<SceneNodePtr>> wrl_scene(std::string_view text,
                                            std::vector<std::string>* notes = nullptr);

}  // namespace animeme::head::detail

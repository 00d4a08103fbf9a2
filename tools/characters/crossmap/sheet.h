/// @file
/// A picture of a project: each key shape as captured and as shown by the target, and frames of the
/// first recording with their fit.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/characters/crossmap/run.h"

namespace animeme::crossmap {

/// An SVG with pictures of the target inside. FAPs and ARKit's shapes are shown on the built-in
/// woman, heads by their own mesh; keys and tables have no picture of the target. At most 48 key
/// shapes are drawn. Deterministic. Errors: those of studio::HeadView::make() and render::png_of().
Result<std::string> sheet_svg(const Mapped& mapped);

}  // namespace animeme::crossmap

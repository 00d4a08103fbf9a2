/// @file
/// Scenes of heads, and cameras.
#pragma once

#include <optional>
#include <string_view>

#include "fap/head/rig.h"
#include "tools/view/render/raster.h"

namespace animeme::render {

/// The parts of a head in a pose. The scene borrows all three.
Scene scene_of(const head::Head& head, const head::Rig& rig, const head::Pose& pose);

/// A camera in front of a head, rotated around it: degrees to the person's left (90: the left side)
/// and up. `zoom` 1 shows head and shoulders; larger values move closer.
Camera look_at(const head::Head& head, double left_degrees, double up_degrees = 0, double zoom = 1);

/// The same camera for a picture of this size in pixels: one that is narrower than 0.74 of its
/// height sees more, so that hair and ears are not cut off. The page does the same
/// (viewer/js/camera.js).
Camera fit_to(Camera camera, int width, int height);

/// Degrees of "front" (0), "three-quarter" (35), "side" (90) or a number; otherwise nullopt.
std::optional<double> view_degrees(std::string_view text);

}  // namespace animeme::render

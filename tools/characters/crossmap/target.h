/// @file
/// The character of a project, with a shape for each key shape of the recordings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dam/crossmap/retarget.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/characters/crossmap/keys.h"
#include "tools/characters/crossmap/mesh.h"

namespace animeme::crossmap {

/// What a character is moved by.
enum class TargetKind : std::uint8_t {
  keys,   ///< nothing but the coefficients of the key shapes
  table,  ///< controls that a table gives for each key shape
  faps,   ///< FAPs
  arkit,  ///< the 52 shapes of ARKit
  mesh,   ///< the shapes of a head
};

/// A character that is ready to be fitted.
struct Target {
  TargetKind kind = TargetKind::faps;  ///< what moves it
  dam::Character character;            ///< rows 0: its values are mixed, see dam::mix_controls()
  std::vector<double> values;          ///< of each control in each key shape: keys x controls
  std::vector<bool> adjusted;          ///< per key shape; false: the first guess
  std::optional<TargetMesh> mesh;      ///< of heads
  std::vector<std::vector<head::Vec3>> mesh_keys;  ///< of heads: displacements of all vertices
};

/// Makes the character of a project.
///
/// A key shape looks like what the artist says: KEY.obj in the folder of key shapes (heads), else
/// its row of controls.csv there. Of others the guess is: the FAPs of its captured points, and the
/// controls whose FAPs come nearest to them (least squares over lengths on a usual face, with the
/// distances of the lips six times, 0 <= c <= 1).
///
/// Controls that are not named (Project::controls) and do less than a third of their work where
/// points were captured are left out.
///
/// Errors: those of the readers, with the file; Capture::no_face and not_found (a shape that nobody
/// adjusted and that cannot be guessed: the remedy is named).
Result<Target> load_target(const Project& project, const Capture& capture, const Keys& keys,
                           const tools::Log& log);

/// The recordings as control curves: fit_controls() or mix_controls(). Errors: as there.
Result<dam::Retarget> fit_target(const Target& target, const dam::Blend& blend, fap::Rate rate,
                                 const dam::RetargetOptions& options);

/// What a face shows at these values of the controls; nothing for keys and tables of other names.
std::optional<fap::Frame> shown_faps(const Target& target, const double* values);

}  // namespace animeme::crossmap

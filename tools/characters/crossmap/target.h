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

/// How a character is moved.
enum class TargetKind : std::uint8_t {
  keys,   ///< by the coefficients of the key shapes
  table,  ///< by controls from a table for each key shape
  faps,   ///< FAPs
  arkit,  ///< the 52 shapes of ARKit
  mesh,   ///< the shapes of a head
};

/// A character prepared for fitting.
struct Target {
  TargetKind kind = TargetKind::faps;  ///< how it is moved
  dam::Character character;            ///< rows 0: its values are mixed, see dam::mix_controls()
  std::vector<double> values;          ///< of each control in each key shape: keys x controls
  std::vector<bool> adjusted;          ///< per key shape; false: the first guess
  std::optional<TargetMesh> mesh;      ///< of heads
  std::vector<std::vector<head::Vec3>> mesh_keys;  ///< of heads: displacements of all vertices
};

/// Makes the character of a project.
///
/// The shape for a key comes from the artist: KEY.obj in the folder of key shapes (heads), or its
/// row of controls.csv there. Without these it is guessed: the FAPs of its captured points, and the
/// controls whose FAPs are nearest to them (least squares over lengths on an average face, with lip
/// distances weighted six times, 0 <= c <= 1).
///
/// Controls that are not listed (Project::controls) and act mostly (more than two thirds) away from
/// the captured points are dropped.
///
/// Errors: those of the readers, with the file; Capture::no_face and not_found (a shape that is
/// neither adjusted nor can be guessed; the message has the remedy).
Result<Target> load_target(const Project& project, const Capture& capture, const Keys& keys,
                           const tools::Log& log);

/// The recordings as control curves: fit_controls() or mix_controls(). Errors: as there.
Result<dam::Retarget> fit_target(const Target& target, const dam::Blend& blend, fap::Rate rate,
                                 const dam::RetargetOptions& options);

/// The FAPs for these values of the controls; nullopt for keys and for tables with unknown names.
std::optional<fap::Frame> shown_faps(const Target& target, const double* values);

}  // namespace animeme::crossmap

/// @file
/// The recordings of a project, ready to be fitted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dam/crossmap/blend.h"
#include "dam/crossmap/face_points.h"
#include "dam/crossmap/points.h"
#include "fap/result.h"
#include "tools/characters/crossmap/project.h"
#include "tools/formats/files/log.h"

namespace animeme::crossmap {

/// Displacements of the points that count, and what is known of them.
struct Capture {
  std::vector<dam::PointTrack> tracks;  ///< one an input, named like its file without the ending
  std::vector<double> neutral;          ///< places of the same points at rest
  std::vector<dam::Region> regions;     ///< of the project, else by feature points, else "all"
  dam::BlendOptions fit;                ///< of the project, with weights and contacts
  std::string unit;                     ///< of lengths: "mm", "px" ...; empty: not known
  std::optional<dam::Face> face;        ///< nothing: the points are not known on a face
  Error no_face;                        ///< why there is none, with the remedy
};

/// Reads the inputs of a project and takes the head off. Says what it found and warns of what is
/// missing. Errors: those of the readers, with the file; invalid_argument and not_found for what
/// the project names and is not there.
Result<Capture> load_capture(const Project& project, const tools::Log& log);

}  // namespace animeme::crossmap

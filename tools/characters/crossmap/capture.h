/// @file
/// The recordings of a project, prepared for fitting.
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

/// Displacements of the fitted points, and their properties.
struct Capture {
  std::vector<dam::PointTrack> tracks;  ///< one per input, named like its file without extension
  std::vector<double> neutral;          ///< positions of the same points at rest
  std::vector<dam::Region> regions;     ///< of the project, else by feature points, else "all"
  dam::BlendOptions fit;                ///< of the project, with weights and contacts
  std::string unit;                     ///< of lengths: "mm", "px" ...; empty: unknown
  std::optional<dam::Face> face;        ///< nullopt: unknown positions on a face
  Error no_face;                        ///< why there is none, with the remedy
};

/// Reads the inputs of a project and removes head motion. Logs what it found and warns about
/// missing data. Errors: those of the readers, with the file; invalid_argument and not_found for
/// missing items that the project names.
Result<Capture> load_capture(const Project& project, const tools::Log& log);

}  // namespace animeme::crossmap

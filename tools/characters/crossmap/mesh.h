/// @file
/// The target as a mesh: vertices, their displacement by controls, and OBJ import and export.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fap/fapu.h"
#include "fap/frame.h"
#include "fap/head/model.h"
#include "fap/result.h"
#include "tools/characters/crossmap/project.h"
#include "tools/formats/files/log.h"

namespace animeme::crossmap {

/// A control and its effect at 1.
struct MeshControl {
  std::string name;  ///< its original name, or of a FAP: "fap3_open_jaw"
  double low = 0;    ///< its lower limit
  double high = 1;   ///< its upper limit; for FAPs those of streams
  fap::Frame faps;   ///< the FAPs that it shows at 1; empty: unknown
  std::vector<std::pair<std::uint32_t, head::Vec3>> moves;  ///< vertices, ascending
};

/// A character at rest. Vertices are numbered as the "v" lines of `obj`.
struct TargetMesh {
  std::string name;                       ///< for people
  std::string obj;                        ///< the neutral mesh as an OBJ file
  std::vector<head::Vec3> vertices;       ///< places, units of the OBJ file
  std::vector<head::Vec3> colours;        ///< linear RGB, one a vertex
  std::vector<head::Triangle> triangles;  ///< of vertices
  std::vector<MeshControl> controls;      ///< at least one
};

/// Positions of the "v" lines of an OBJ file. Errors: syntax with line and column (a "v" without
/// three numbers), truncated (no vertex).
Result<std::vector<head::Vec3>> obj_vertices(std::string_view text);

/// The text of `obj` with new vertex positions (as many as obj_vertices() returns); colours after
/// them and all other lines are kept.
std::string obj_with_vertices(std::string_view obj, const std::vector<head::Vec3>& vertices);

/// The head of a project, with its selected controls.
///
/// - An .obj with `shapes`: its vertices, and a control for each file, named like it; the FAPs that
/// a
///   control shows are measured at the feature points if `head_points` are given (the file then has
///   +Y up and looks along +Z).
/// - Any other head that `animeme render` takes: the vertices of head::write_obj(), in cm. Its
///   controls are its shapes (glTF), else the FAPs that move it.
///
/// Errors: those of the readers, with the file; not_found (a missing control; a head without
/// controls), invalid_argument (an OBJ file with another number of vertices).
Result<TargetMesh> load_mesh(const Project& project, const tools::Log& log);

}  // namespace animeme::crossmap

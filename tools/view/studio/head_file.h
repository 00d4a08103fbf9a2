/// @file
/// Loads heads by name: a built-in one, or a file of any supported format.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fap/head/model.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"

namespace animeme::studio {

/// Options --head, --points, --shape-name, --shape-names and --gain.
struct HeadChoice {
  std::string head = "woman";  ///< a description for head::parse_head(), or a file
  std::string points;          ///< list of feature points; see fap/head/point_list.h
  /// What morph targets with other names mean, "NAME=jawOpen"; see gltf/shape_rules.h.
  std::vector<std::string> shape_names;
  std::string shape_table;  ///< a file with the same as a table; empty: none
  std::string gain = "1";  ///< Head::mouth_gain, or "auto": speaking_gain() of speak_check.h; 1 and
                           ///< a note if the mouth cannot be measured
  /// Subdivide triangles so that vertex colours represent textures, for formats without materials.
  /// Not needed for pictures and pages.
  bool colours_at_vertices = false;

  /// Whether names of shapes are given.
  bool names_shapes() const { return !shape_names.empty() || !shape_table.empty(); }
};

/// A head with notes.
struct LoadedHead {
  head::Head head;                 ///< see fap/head/model.h
  std::vector<std::string> notes;  ///< what was guessed or is missing, one sentence each
};

/// Parses a --gain from 0.25 to 4; otherwise nullopt.
std::optional<double> gain_of(const std::string& text);

/// Checks a choice by its names alone: neither a built-in head nor a file, an unsupported format,
/// --points missing or superfluous, an invalid gain. Empty: no problem.
std::string problem_of(const HeadChoice& choice);

/// Makes or reads a head. Files: .glb, .gltf, .vrm (moved by their shapes, or by points if given),
/// .obj or .obj.gz (with points), folders of OBJ (gltf/obj_folder.h; points improve them), .fdp,
/// .xmt and .xmta. Referenced files are read from their folder and below, see gltf::files_of().
/// Errors: invalid_argument with problem_of(), and those of the readers, with the file;
/// out_of_range if memory is insufficient.
Result<LoadedHead> load_head(const HeadChoice& choice);

/// The same; each note goes to log.info, after the file name.
Result<head::Head> load_head(const HeadChoice& choice, const tools::Log& log);

}  // namespace animeme::studio

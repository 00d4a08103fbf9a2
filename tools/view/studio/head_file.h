/// @file
/// Heads by name: one of ours, or a file of any kind.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fap/head/model.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"

namespace animeme::studio {

/// --head, --points and --gain.
struct HeadChoice {
  std::string head = "woman";  ///< one of head::kHeadNames, or a file
  std::string points;          ///< list of feature points; see fap/head/point_list.h
  std::string gain = "1";  ///< Head::mouth_gain, or "auto": speaking_gain() of speak_check.h; 1 and
                           ///< a note where the mouth cannot be measured
  /// Triangles are divided so that colours at the vertices show textures: for formats that have no
  /// materials. Pictures and pages need it not.
  bool colours_at_vertices = false;
};

/// A head and what there is to say of it.
struct LoadedHead {
  head::Head head;                 ///< see fap/head/model.h
  std::vector<std::string> notes;  ///< what was guessed or is missing, a sentence each
};

/// The number that a --gain is, if it is one from 0.25 to 4.
std::optional<double> gain_of(const std::string& text);

/// What is wrong with a choice, as far as names tell: neither a head of ours nor a file, a kind of
/// file that is not read, --points missing or not wanted, a gain that is none. Empty: nothing.
std::string problem_of(const HeadChoice& choice);

/// Makes or reads a head. Files: .glb, .gltf, .vrm (moved by their shapes, or by points if they are
/// given), .obj (with points), .fdp, .xmt and .xmta. Files that they name are read from their
/// folder and below, see gltf::files_of(). Errors: invalid_argument with problem_of(), and those of
/// the readers, with the file; out_of_range if memory does not do.
Result<LoadedHead> load_head(const HeadChoice& choice);

/// The same; each note goes to talk.say, behind the name of the file.
Result<head::Head> load_head(const HeadChoice& choice, const tools::Log& log);

}  // namespace animeme::studio

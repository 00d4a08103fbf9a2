/// @file
/// The head that a command shows: one of ours, or a file of the user's.
#pragma once

#include <string>
#include <vector>

#include "fap/head/model.h"
#include "fap/result.h"

namespace CLI {
class App;
}

namespace animeme::tools {

/// --head and --points.
struct HeadChoice {
  std::string head = "woman";  ///< one of head::kHeadNames, or a file
  std::string points;          ///< list of feature points; see fap/head/point_list.h
};

/// What --help says of them.
extern const char* const kHeadHelp;
extern const char* const kPointsHelp;  ///< of --points

/// Adds --head and --points.
void add_head_options(CLI::App& app, HeadChoice& choice);

/// A head that is ready to be shown.
struct LoadedHead {
  head::Head head;                 ///< see fap/head/model.h
  std::vector<std::string> notes;  ///< what was guessed or is missing, a sentence each
};

/// What is wrong with a choice, as far as names tell: neither a head of ours nor a file, a kind of
/// file that is not read, --points missing or not wanted. Empty: nothing.
std::string problem_of(const HeadChoice& choice);

/// Makes or reads a head. Files: .glb, .gltf, .vrm (moved by their shapes, or by points if they are
/// given), .obj (with points), .fdp, .xmt and .xmta.
/// Errors: invalid_argument with problem_of(), and those of the readers, with the file.
Result<LoadedHead> load_head(const HeadChoice& choice);

/// The same, with the notes on standard error.
Result<head::Head> load_head_and_tell(const HeadChoice& choice);

}  // namespace animeme::tools

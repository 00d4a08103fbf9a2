/// @file
/// What the program is linked with, under which licences, and what of it is there.
#pragma once

#include <span>
#include <string>

namespace animeme::tools {

/// A row of tools/release/packaging/libraries.tsv.
struct Library {
  const char* name;     ///< as its makers call it
  const char* object;   ///< the stem of its shared object; "-": headers alone; "?": words of FFmpeg
  const char* licence;  ///< SPDX; "FFmpeg": it says so itself
  const char* version;  ///< that the program was built with; empty: unknown
  const char* use;      ///< what it is for
  const char* by;       ///< who brings it with it; empty: nobody but the program
};

/// All rows. Made by the build (tools/release/packaging/libraries.cmake).
std::span<const Library> known_libraries();

/// The version; with `verbose` also the modules that are found, the libraries that are loaded with
/// them, with versions and licences (SPDX), and what the program was built without. `json`: for
/// scripts.
std::string version_text(bool verbose, bool json);

}  // namespace animeme::tools

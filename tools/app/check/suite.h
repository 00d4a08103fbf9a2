/// @file
/// A folder of conformance cases.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "conformance/case_file.h"
#include "fap/result.h"
#include "tools/formats/programs/scratch_folder.h"

namespace animeme::tools {

/// A case with its files.
struct SuiteCase {
  conformance::Case info;                             ///< case.json
  std::map<std::string, std::filesystem::path> path;  ///< by role
  std::string problem;    ///< not empty: a file is missing or not the one of case.json
  bool described = true;  ///< false: no case.json; described by file names only
};

/// All cases of a folder or archive.
struct Suite {
  std::string name;              ///< for reports
  std::vector<SuiteCase> cases;  ///< by name
  /// Folders of unpacked archives, kept as long as the suite.
  std::vector<std::unique_ptr<ScratchFolder>> unpacked;
};

/// Finds the cases at a path:
///   - a folder with case.json files somewhere in it; archives *.tar.xz directly in the folder are
///     unpacked (by the program tar) into a scratch folder and hold data of the cases;
///   - such an archive by itself;
///   - a bare folder: every X.fba somewhere in it with X.dec.fap or X.dec.bap (to be decoded) or
///     X.intact.fap or .bap (damaged) beside it, and perhaps X.epf with X.src.fap and X.src.bap.
/// Names of two cases must not be equal.
/// Errors: not_found (no such place, no cases), io (an archive cannot be unpacked), syntax (a
/// case.json cannot be read, two cases of one name).
Result<Suite> load_suite(const std::string& place);

/// Verifies the SHA-256 of every file of a case, if given; sets `problem`.
void verify(SuiteCase& one);

}  // namespace animeme::tools

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

/// A case and where its files are.
struct SuiteCase {
  conformance::Case info;                             ///< case.json
  std::map<std::string, std::filesystem::path> path;  ///< by role
  std::string problem;    ///< not empty: a file is missing or not the one of case.json
  bool described = true;  ///< false: there is no case.json, the names of the files say it all
};

/// All cases of a place.
struct Suite {
  std::string name;              ///< for reports
  std::vector<SuiteCase> cases;  ///< by name
  /// Folders of archives, as long as the suite lives.
  std::vector<std::unique_ptr<ScratchFolder>> unpacked;
};

/// Finds the cases of a place:
///   - a folder with case.json files somewhere in it; archives *.tar.xz directly in the folder are
///     unpacked (by the program tar) into a scratch folder and hold data of the cases;
///   - such an archive by itself;
///   - a bare folder: every X.fba somewhere in it with X.dec.fap or X.dec.bap (to be decoded) or
///     X.intact.fap or .bap (damaged) beside it, and perhaps X.epf with X.src.fap and X.src.bap.
/// Names of two cases must not be equal.
/// Errors: not_found (no such place, no cases), io (an archive cannot be unpacked), syntax (a
/// case.json cannot be read, two cases of one name).
Result<Suite> load_suite(const std::string& place);

/// Holds every file of a case against its SHA-256, if it has one; sets `problem`.
void verify(SuiteCase& one);

}  // namespace animeme::tools

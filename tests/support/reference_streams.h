// The streams that the codec tests run on: the cases of conformance/ that can be decoded, unpacked
// by the build, and any further streams of the reference data.
#pragma once

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "codec/syntax/plane.h"
#include "tests/support/files.h"
#include "tests/support/folders.h"
#include "tests/support/shared.h"

namespace animeme::test {

/// Base paths (without extension) of all streams at hand, by name. A stream without expected
/// values is none: it belongs to a case of what must not be decoded.
inline std::vector<std::filesystem::path> reference_streams() {
  namespace fs = std::filesystem;
  std::vector<fs::path> out;
  std::set<std::string> names;
  std::vector<fs::path> folders = {fs::path(test::kBinaryFolder) / "conformance" / "cases"};
  if (!shared_dir().empty()) folders.push_back(shared_dir() / "conformance" / "streams");
  for (const auto& folder : folders) {
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".fba") continue;
      const fs::path base = entry.path().parent_path() / entry.path().stem();
      if (!fs::exists(base.string() + ".dec.fap") && !fs::exists(base.string() + ".dec.bap")) {
        continue;
      }
      if (names.insert(base.filename().string()).second) out.push_back(base);
    }
  }
  std::sort(out.begin(), out.end(),
            [](const auto& a, const auto& b) { return a.filename() < b.filename(); });
  return out;
}

/// `path` with `extension` appended ("x" and ".dec.fap" give "x.dec.fap").
inline std::filesystem::path with(const std::filesystem::path& path, const char* extension) {
  return std::filesystem::path(path.string() + extension);
}

/// The body frames of a .bap text (version 3.1 or 3.2), plainly: every token in its place. Shares
/// nothing with read_bap_text(), which is tested against it.
inline std::vector<fba::BodyFrame> read_bap(const std::string& text) {
  std::istringstream lines(text);
  std::string clean;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != '#') clean += line + "\n";
  }
  std::istringstream in(clean);
  std::string version, name, rate;
  int count = 0;
  in >> version >> name >> rate >> count;
  const int masks = version == "3.1" ? 186 : 296;
  std::vector<fba::BodyFrame> frames(static_cast<std::size_t>(count));
  for (fba::BodyFrame& frame : frames) {
    for (int bap = 1; bap <= masks; ++bap) {
      int flag = 0;
      in >> flag;
      frame.mask[std::size_t(bap)] = flag != 0;
    }
    long number = 0;
    in >> number;
    frame.number = number;
    for (int bap = 1; bap <= masks; ++bap) {
      if (frame.mask[std::size_t(bap)]) in >> frame.value[std::size_t(bap)];
    }
  }
  return in ? frames : std::vector<fba::BodyFrame>();
}

}  // namespace animeme::test

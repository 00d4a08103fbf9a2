// Batches and what they made, for their tests.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace animeme::test {

// Everything below a folder, by its name there.
inline std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    // Locks stay; shards have indices and reports of their own.
    if (!entry.is_regular_file() || name.ends_with(".lock") || name.find("-of-") != name.npos)
      continue;
    all[name] = slurp(entry.path().string());
  }
  return all;
}

inline std::vector<std::string> batch_line(const std::string& manifest, const std::string& out,
                                           const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"batch", manifest, "-o", out, "-q"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

}  // namespace animeme::test

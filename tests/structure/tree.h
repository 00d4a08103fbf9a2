// All files of the source tree that are text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace animeme::test {

struct SourceFile {
  std::string path;  ///< relative to the root, with '/'
  std::string text;
};

/// Ours only: neither build folders nor what others put into node_modules. Sorted by path.
const std::vector<SourceFile>& tree();

/// A header or a source of C++.
bool is_code(std::string_view path);

}  // namespace animeme::test

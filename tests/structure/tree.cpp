#include "tests/structure/tree.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/folders.h"

namespace animeme::test {
namespace {

namespace fs = std::filesystem;

bool has_extension(const fs::path& path, std::initializer_list<std::string_view> extensions) {
  return std::find(extensions.begin(), extensions.end(), path.extension().string()) !=
         extensions.end();
}

bool is_text(const fs::path& path) {
  return path.filename() == "run" || path.filename() == "LICENSE" ||
         has_extension(path, {".h", ".hpp", ".cpp", ".txt", ".cmake", ".in", ".md", ".json", ".js",
                              ".mjs", ".html", ".py", ".sh", ".yml", ".1"});
}

SourceFile load(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {path.lexically_relative(test::kSourceFolder).generic_string(),
          {std::istreambuf_iterator<char>(file), {}}};
}

}  // namespace

// The folders by name, so that build folders inside the tree do not count.
const std::vector<SourceFile>& tree() {
  static const std::vector<SourceFile> files = [] {
    std::vector<fs::path> paths;
    const fs::path root = test::kSourceFolder;
    for (const auto& entry : fs::directory_iterator(root)) {
      if (entry.is_regular_file() && is_text(entry.path())) paths.push_back(entry.path());
    }
    for (const char* folder : {"fap", "codec", "dam", "tools", "conformance", "tests", ".ci"}) {
      if (!fs::is_directory(root / folder)) continue;
      for (fs::recursive_directory_iterator at(root / folder), end; at != end; ++at) {
        if (at->path().filename() == "node_modules") at.disable_recursion_pending();
        if (at->is_regular_file() && is_text(at->path())) paths.push_back(at->path());
      }
    }
    std::sort(paths.begin(), paths.end());
    std::vector<SourceFile> loaded;
    for (const fs::path& path : paths) loaded.push_back(load(path));
    return loaded;
  }();
  return files;
}

bool is_code(std::string_view path) {
  return path.ends_with(".h") || path.ends_with(".hpp") || path.ends_with(".cpp");
}

}  // namespace animeme::test

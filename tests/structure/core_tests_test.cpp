// tests/run.sh without an argument runs some test of every module that has tests. The build notes
// the folders of tests that have the label "core".
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/structure/modules.h"
#include "tests/structure/tree.h"
#include "tests/support/folders.h"

namespace animeme::test {
namespace core_tests_test {

// Modules whose tests all need what the plain round does not build.
constexpr std::string_view kOnlyInFull[] = {
    "tools/bindings/npm",     // preset npm, by Emscripten
    "tools/bindings/python",  // the Python module
};

// The folders of tests, relative to tests/, that have a test among their own files.
std::set<std::string> folders_with_tests() {
  std::set<std::string> folders;
  for (const SourceFile& file : tree()) {
    if (!file.path.starts_with("tests/")) continue;
    const std::size_t slash = file.path.rfind('/');
    const std::string name = file.path.substr(slash + 1);
    const bool test = name.find("_test.") != std::string::npos ||
                      (name.starts_with("test_") && name.ends_with(".py"));
    if (test && slash > 5) folders.insert(file.path.substr(6, slash - 6));
  }
  return folders;
}

// Where the tests of a folder are: tests/ mirrors the sources, but leaves out inner folders, and
// those of a library that lies in another one have a folder beside it.
std::string tests_of(std::string folder, const std::set<std::string>& with_tests) {
  if (folder.starts_with("tools/")) folder.erase(0, 6);
  for (;;) {
    const std::size_t slash = folder.rfind('/');
    const std::string last = folder.substr(slash == std::string::npos ? 0 : slash + 1);
    if (with_tests.contains(folder)) return folder;
    if (with_tests.contains(last)) return last;
    if (slash == std::string::npos) return {};
    folder.erase(slash);
  }
}

TEST(CoreTests, EveryModuleWithTestsHasSome) {
  std::ifstream list(std::string(kBinaryFolder) + "/tests/core_folders.txt");
  std::set<std::string> core;
  for (std::string line; std::getline(list, line);) core.insert(line);
  if (!core.contains("app/program")) GTEST_SKIP() << "configured without the program";
  const std::set<std::string> with_tests = folders_with_tests();
  ASSERT_GT(with_tests.size(), 20u);
  int checked = 0;
  for (const Module& module : kModules) {
    if (module.folders == "tests/*") continue;
    if (std::ranges::find(kOnlyInFull, module.folders) != std::end(kOnlyInFull)) continue;
    std::istringstream folders{std::string(module.folders)};
    bool has_tests = false, has_core = false;
    for (std::string folder; folders >> folder;) {
      const std::string tests = tests_of(folder, with_tests);
      has_tests = has_tests || !tests.empty();
      has_core = has_core || core.contains(tests);
    }
    if (!has_tests) continue;
    ++checked;
    EXPECT_TRUE(has_core) << module.folders << ": name suites for core in tests/CMakeLists.txt";
  }
  EXPECT_GT(checked, 35);
}

}  // namespace core_tests_test
}  // namespace animeme::test

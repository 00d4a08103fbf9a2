// Where the tests find the full reference data, if it is there at all.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/files.h"
#include "tests/support/folders.h"

namespace animeme::test {

/// The folder with the full reference data: $ANIMEME_SHARED, else ../shared beside the source
/// tree. Empty if there is none; a test then has to GTEST_SKIP() and say so.
inline std::filesystem::path shared_dir() {
  const char* set = std::getenv("ANIMEME_SHARED");
  std::filesystem::path dir =
      set != nullptr ? std::filesystem::path(set)
                     : std::filesystem::path(test::kSourceFolder).parent_path() / "shared";
  return std::filesystem::is_directory(dir) ? dir : std::filesystem::path();
}

/// A file or folder that ships with the tests.
inline std::filesystem::path data_dir() {
  return std::filesystem::path(test::kSourceFolder) / "tests" / "data";
}

/// A file of tests/data. Empty, with a failure, if it cannot be read. `name` is relative to that.
inline std::string data_file(const std::string& name) {
  const std::filesystem::path path = data_dir() / name;
  EXPECT_TRUE(std::filesystem::is_regular_file(path)) << name;
  return slurp(path);
}

}  // namespace animeme::test

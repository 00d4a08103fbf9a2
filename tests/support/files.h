// Files of tests/data, whole.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace animeme::test {

/// Empty, with a failure, if it cannot be read. `name` is relative to tests/data.
inline std::string data_file(const std::string& name) {
  std::ifstream file(std::string(ANIMEME_SOURCE_DIR "/tests/data/") + name, std::ios::binary);
  EXPECT_TRUE(file) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace animeme::test

// Files, whole.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace animeme::test {

using Bytes = std::vector<std::uint8_t>;

/// Empty if it cannot be read.
inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

inline void spill(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}
inline void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  spill(path, std::string(bytes.begin(), bytes.end()));
}

/// A file of tests/data. Empty, with a failure, if it cannot be read. `name` is relative to that.
inline std::string data_file(const std::string& name) {
  const std::filesystem::path path = ANIMEME_SOURCE_DIR "/tests/data/" + name;
  EXPECT_TRUE(std::filesystem::is_regular_file(path)) << name;
  return slurp(path);
}

}  // namespace animeme::test

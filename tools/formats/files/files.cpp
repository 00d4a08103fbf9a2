#include "tools/formats/files/files.h"

#include <filesystem>
#include <iostream>

#include "fap/detail/text_scanner.h"
#include "fap/detail/whole_file.h"

namespace animeme::tools {

namespace {

constexpr const char* kStandardInput = "standard input";

}  // namespace

Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t most) {
  const bool standard = path == "-";
  auto bytes = standard ? fap::detail::read_whole(std::cin, {.bytes = most})
                        : fap::detail::read_whole(path, {.bytes = most});
  if (!bytes) return std::move(bytes).error().in_file(standard ? kStandardInput : path);
  return bytes;
}

Result<std::string> read_text_file(const std::string& path, std::uint64_t most) {
  const bool standard = path == "-";
  auto text = standard ? fap::detail::read_whole_text(std::cin, {.bytes = most})
                       : fap::detail::read_whole_text(path, {.bytes = most});
  if (!text) return std::move(text).error().in_file(standard ? kStandardInput : path);
  return text;
}

std::string extension_of(const std::string& path) {
  return fap::detail::lower_case(std::filesystem::path(path).extension().string());
}

std::string name_of_output(const std::string& path) {
  return path == "-" ? "standard output" : path;
}

}  // namespace animeme::tools

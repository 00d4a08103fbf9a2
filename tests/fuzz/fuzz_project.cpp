// Projects of crossmap, in TOML.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/characters/crossmap/project.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme;
  const std::string_view toml(reinterpret_cast<const char*>(data), size);
  for (const char* folder : {"", "/a/b"}) {
    const auto project = crossmap::read_project(toml, folder);
    require(project || !project.error().message.empty());
  }
  return 0;
}

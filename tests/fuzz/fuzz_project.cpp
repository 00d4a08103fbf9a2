// Projects of crossmap, in TOML.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "tools/characters/crossmap/project.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme;
  const std::string_view toml(reinterpret_cast<const char*>(data), size);
  for (const char* folder : {"", "/a/b"}) {
    const auto project = crossmap::read_project(toml, folder);
    require(project || !project.error().message.empty());
  }
  return 0;
}

// Feeds arbitrary bytes to the script reader. What it accepts must keep the promises of
// dam/script/script.h and read back equal from both writers.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "dam/script/script.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::dam;
  const auto script = read_script({reinterpret_cast<const char*>(data), size});
  if (!script) {
    require(!script.error().message.empty());
    return 0;
  }
  require(check_script(*script).has_value());
  const auto from_tsv = read_script(write_script_tsv(*script));
  require(from_tsv && *from_tsv == *script);
  const auto from_grid = read_script(write_textgrid(*script));
  require(from_grid && *from_grid == *script);
  return 0;
}

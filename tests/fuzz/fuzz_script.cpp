// Feeds arbitrary bytes to the readers of scripts, text and JSON. What they accept must keep the
// promises of dam/script/script.h and read back equal from both writers that lose nothing, and in
// its labels from that of .pho.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "dam/script/script.h"
#include "dam/script/timings.h"
#include "tests/fuzz/require.h"
#include "tools/formats/scripts/script_text.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::dam;
  const auto timings = animeme::scripts::read_labels({reinterpret_cast<const char*>(data), size});
  if (!timings) {
    require(!timings.error().message.empty());
    return 0;
  }
  require(!timings->format.empty());
  const auto script = make_script(*timings);
  if (!script) {
    require(!script.error().message.empty());
    return 0;
  }
  require(!has_words(*timings));
  require(check_script(*script).has_value());
  const auto from_tsv = read_script(write_script_tsv(*script));
  require(from_tsv && *from_tsv == *script);
  const auto from_grid = read_script(write_textgrid(*script));
  require(from_grid && *from_grid == *script);
  if (script->duration() > kMaxScriptSeconds - 1) return 0;  // rounding may go beyond the day
  ScriptOptions pho;
  pho.format = "pho";
  const auto from_pho = read_script(write_pho(*script), pho);
  require(from_pho && from_pho->phones.size() == script->phones.size());
  require(write_webvtt(*script).size() >= 7);
  return 0;
}

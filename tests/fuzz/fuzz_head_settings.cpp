// Bodies of PUT /heads/NAME, and names: what is accepted is what is shown, and accepted again.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/live/serve/settings.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (serve::is_head_name(text)) require(text.find('/') == std::string_view::npos);
  const auto json = tools::Json::parse(text);
  if (!json) return 0;
  const auto settings = serve::read_settings(*json, {});
  if (!settings) {
    require(!settings.error().message.empty());
    return 0;
  }
  const tools::Json shown = serve::settings_json(*settings);
  const auto again = serve::read_settings(shown, {});
  require(again && serve::settings_json(*again).dump() == shown.dump());
  return 0;
}

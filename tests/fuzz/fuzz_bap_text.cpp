// Any bytes as BAP text: an answer without a crash, and what was read survives writing.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "codec/text/bap_text.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::fba;
  std::vector<std::string> warnings;
  const auto body = read_bap_text({reinterpret_cast<const char*>(data), size}, &warnings);
  if (!body) {
    require(!body.error().message.empty());
    return 0;
  }
  const auto again = read_bap_text(write_bap_text(*body));
  require(again.has_value());
  require(again->frames == body->frames && again->rate == body->rate);
  return 0;
}

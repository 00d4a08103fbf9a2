// Feeds arbitrary bytes to the reader of ARKit's curves. What it accepts ascends, and comes back
// frame for frame from what is written for Live Link Face.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/formats/exchange/arkit.h"

using animeme::test::require;

namespace {

void check(const animeme::exchange::Imported& take) {
  require(take.clip.rate.valid() && !take.clip.frames.empty());
  std::int64_t last = -1;
  for (const animeme::fap::Frame& frame : take.clip.frames) {
    require(frame.number > last && frame.number <= 10'000'001);
    last = frame.number;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::exchange;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  is_arkit_table(text);
  for (const ArkitOptions& options :
       {ArkitOptions{}, ArkitOptions{animeme::fap::Rate{25, 1}, true}}) {
    const auto take = read_arkit_table(text, options);
    if (!take) {
      require(!take.error().message.empty());
      continue;
    }
    check(*take);
    // The fit takes its time, so a few frames have to do.
    animeme::fap::Sequence few = take->clip;
    few.frames.resize(std::min<std::size_t>(few.frames.size(), 3));
    few.rate = {30, 1};
    const ArkitCurves curves = fit_arkit(few);
    const auto back = read_arkit_table(write_live_link(curves), {few.rate, false});
    require(back && back->clip.frames.size() == few.frames.size());
  }
  return 0;
}

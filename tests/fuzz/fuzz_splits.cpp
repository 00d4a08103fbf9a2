// What the decoder says does not depend on how the bytes arrive. The input: a number n, n sizes of
// pieces (used over and over), and the stream.
#include <algorithm>
#include <cstdint>

#include "tests/fuzz/event_trace.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme;
  if (size == 0) return 0;
  const std::size_t count = std::min<std::size_t>(data[0], size - 1);
  const std::span sizes(data + 1, count);
  const std::span bytes(data + 1 + count, size - 1 - count);
  const auto whole = test::trace(bytes, [size](std::size_t) { return size; });
  const auto pieces = test::trace(bytes, [&sizes](std::size_t i) {
    return sizes.empty() ? std::size_t(1) : std::size_t(sizes[i % sizes.size()]);
  });
  require(whole == pieces);
  return 0;
}

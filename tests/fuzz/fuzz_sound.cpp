// What decodes a file's sound, and what tells what a file is, on any bytes. The seeds are those of
// fuzz_container.
#include <cstddef>
#include <cstdint>
#include <span>

#include "tests/fuzz/require.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::media;
  const std::span<const std::uint8_t> file(data, size);
  (void)probe(file);
  // Sound decoders are FFmpeg's; a short limit keeps the fuzzer on what is around them.
  constexpr int kRate = 8000, kSeconds = 2;
  const auto sound = read_audio(file, {.sample_rate = kRate, .max_seconds = kSeconds});
  require(!sound || sound->samples.size() <= std::size_t(kRate * kSeconds));
  return 0;
}

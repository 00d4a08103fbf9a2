// Feeds arbitrary bytes to what tells kinds of files and reads all that hold motion. A kind that is
// told is what its reader then gives.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/fuzz/require.h"
#include "tools/formats/exchange/motion.h"

using animeme::test::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::exchange;
  const FileKind kind = kind_of({data, size});
  require(kind == FileKind::media || !is_playlist({data, size}));
  for (const FrameNumbers numbers : {FrameNumbers::from_zero, FrameNumbers::keep}) {
    const auto motion = read_motion(std::vector<std::uint8_t>(data, data + size), numbers);
    if (!motion) {
      require(!motion.error().message.empty());
      continue;
    }
    require(motion->kind == kind);
    require(motion->stream.empty() == (kind != FileKind::fba_stream));
    require(kind != FileKind::bap_text || motion->face.frames.empty());
    require(kind != FileKind::curves || !motion->face.frames.empty());
  }
  return 0;
}

// Feeds arbitrary bytes to the reader of landmarks and to what makes FAPs of them. The first byte
// chooses the options.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/formats/exchange/landmarks.h"

using animeme::test::require;

namespace {

using namespace animeme;
using namespace animeme::exchange;

LandmarkImportOptions options_of(std::uint8_t choice) {
  LandmarkImportOptions options;
  if (choice & 1) options.table.rate = fap::Rate{25, 1};
  if (choice & 2) options.table.flat = true;
  if (choice & 4) {
    options.table.layout =
        choice & 8 ? fap::LandmarkLayout::mediapipe : fap::LandmarkLayout::ibug68;
  }
  if (choice & 16) options.neutral = "0-1s";
  if (choice & 32) options.table.confidence = 0;
  if (choice & 64) options.table.size = PictureSize{16, 9};
  options.face.mirrored = (choice & 128) != 0;
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  is_landmark_table(text);
  const LandmarkImportOptions options = options_of(data[0]);
  const auto take = import_landmarks(text, options);
  if (!take) {
    require(!take.error().message.empty());
  } else {
    const fap::Sequence& clip = take->face.clip;
    require(clip.rate.valid() && !clip.frames.empty() && !take->face.neutral_frames.empty());
    std::int64_t last = -1;
    for (const fap::Frame& frame : clip.frames) {
      require(frame.number > last);
      last = frame.number;
    }
  }
  LandmarkImportOptions spoken;  // the text that a user gives
  spoken.table.rate = fap::Rate{25, 1};
  spoken.neutral = std::string(text.substr(0, 20));
  parse_picture_size(spoken.neutral);
  const auto tiny = import_landmarks("8.1_x,8.1_y\n1,2\n", spoken);
  require(!tiny);
  return 0;
}

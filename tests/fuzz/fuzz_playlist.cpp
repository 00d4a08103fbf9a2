// libFuzzer entry: whatever the text is, the readers of playlists return in bounded memory, and no
// name leads out of the folder.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/formats/media/detail/segments/playlist_text.h"
#include "tools/formats/media/detail/segments/presentation.h"

using animeme::test::require;

namespace {

void check(const std::string& reference) {
  const auto name = animeme::media::from_reference(reference);
  if (!name) return;
  const std::filesystem::path path(*name);
  require(!path.empty() && !path.is_absolute());
  for (const auto& part : path) {
    require(part != "..");
  }
}

void check(const animeme::media::Rendition& rendition) {
  require(rendition.segments.size() <= animeme::media::kMostSegments);
  check(rendition.init);
  for (const std::string& segment : rendition.segments) check(segment);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace animeme::media;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto hls = read_hls(text)) {
    for (const std::string& playlist : hls->playlists) check(playlist);
    check(hls->rendition);
  }
  if (const auto dash = read_dash(text)) {
    for (const Rendition& rendition : *dash) check(rendition);
  }
  check(std::string(text.substr(0, 300)));
  return 0;
}

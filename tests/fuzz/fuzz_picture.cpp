// Any bytes as a picture: an error, or as many texels as its header says. PNG is tried as it is and
// with its checksums made right, else hardly any would get beyond these.
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "tests/fuzz/require.h"
#include "tests/support/png_writer.h"
#include "tools/view/gltf/detail/picture_decoder.h"

using animeme::test::require;

namespace {

using animeme::test::Bytes;

void try_picture(std::span<const std::uint8_t> bytes) {
  constexpr std::int64_t kMost = 40'000;
  const auto size = animeme::gltf::size_of_picture(bytes);
  if (!size) return require(!size.error().message.empty());
  require(size->texels() >= 1 && size->texels() <= animeme::gltf::kMostTexels);
  if (size->texels() > kMost) return;
  for (const std::int64_t most : {kMost, std::int64_t(16)}) {
    const auto picture = animeme::gltf::decode_picture(bytes, most);
    if (!picture) return require(!picture.error().message.empty());
    require(std::int64_t(picture->width) * picture->height <= most);
    require(picture->rgba.size() == std::size_t(picture->width) * std::size_t(picture->height) * 4);
    require(most < kMost || (picture->width == size->width && picture->height == size->height));
  }
}

void repair(Bytes& png) {
  std::size_t at = 8;
  while (at + 12 <= png.size()) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | png[at + i];
    if (size > png.size() - at - 12) return;
    const auto begin = png.begin() + std::ptrdiff_t(at) + 4;
    const std::uint32_t sum =
        animeme::test::png::crc(Bytes(begin, begin + 4 + std::ptrdiff_t(size)));
    for (std::size_t i = 0; i < 4; ++i) png[at + 8 + size + i] = std::uint8_t(sum >> (24 - 8 * i));
    at += 12 + size;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, data + size);
  try_picture(bytes);
  if (size < 8 || data[1] != 'P') return 0;
  repair(bytes);
  try_picture(bytes);
  return 0;
}

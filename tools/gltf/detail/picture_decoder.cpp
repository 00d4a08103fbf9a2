#include "tools/gltf/detail/picture_decoder.h"

#include <cstddef>
#include <limits>

// Only what glTF names: decoders of other formats are the buggier ones.
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_FAILURE_STRINGS
#define STBI_MAX_DIMENSIONS 16384
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
#include <stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace animeme::gltf {

std::optional<DecodedPicture> decode_picture(std::span<const std::uint8_t> bytes) {
  constexpr std::int64_t kMostTexels = 64'000'000;
  if (bytes.size() > std::size_t(std::numeric_limits<int>::max())) return std::nullopt;
  const int size = int(bytes.size());
  DecodedPicture picture;
  int channels = 0;
  if (!stbi_info_from_memory(bytes.data(), size, &picture.width, &picture.height, &channels)) {
    return std::nullopt;
  }
  if (picture.width < 1 || picture.height < 1 ||
      std::int64_t(picture.width) * picture.height > kMostTexels) {
    return std::nullopt;
  }
  stbi_uc* texels =
      stbi_load_from_memory(bytes.data(), size, &picture.width, &picture.height, &channels, 4);
  if (texels == nullptr) return std::nullopt;
  const auto count = std::size_t(picture.width) * std::size_t(picture.height) * 4;
  picture.rgba.assign(texels, texels + count);
  stbi_image_free(texels);
  return picture;
}

}  // namespace animeme::gltf

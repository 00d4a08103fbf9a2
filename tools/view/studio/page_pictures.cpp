#include "tools/view/studio/page_pictures.h"

#include <webp/encode.h>

#include <map>

namespace animeme::studio {
namespace {

constexpr int kMostSide = 1024;

// Nothing if it cannot be coded. Colours below transparent places stay: edges would get dark rims.
std::vector<std::uint8_t> coded(const head::Texels& texels, float quality) {
  WebPConfig config;
  WebPPicture picture;
  std::vector<std::uint8_t> out;
  if (!WebPConfigPreset(&config, WEBP_PRESET_PICTURE, quality) || !WebPPictureInit(&picture)) {
    return out;
  }
  config.exact = 1;
  picture.width = texels.width;
  picture.height = texels.height;
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  if (WebPPictureImportRGBA(&picture, texels.rgba.data(), texels.width * 4) &&
      WebPEncode(&config, &picture)) {
    out.assign(writer.mem, writer.mem + writer.size);
  }
  WebPPictureFree(&picture);
  WebPMemoryWriterClear(&writer);
  return out;
}

std::shared_ptr<const head::Picture> smaller(const head::Picture& picture) {
  const head::Texels& texels = picture.within(kMostSide);
  const bool colour = picture.kind() == head::TexelKind::colour;
  std::vector<std::uint8_t> file = coded(texels, colour ? 85.0f : 95.0f);
  if (file.empty() || file.size() >= picture.file().size()) return nullptr;
  return std::make_shared<const head::Picture>(texels, picture.kind(), std::move(file),
                                               "image/webp");
}

}  // namespace

std::size_t shrink_pictures(head::Head& head, std::size_t most_bytes) {
  // The old ones are kept until the end, so that no new one has the place of an old one.
  std::map<std::shared_ptr<const head::Picture>, std::shared_ptr<const head::Picture>> done;
  std::size_t count = 0;
  for (head::Material& material : head.materials) {
    for (head::Texture* texture :
         {&material.base, &material.normal, &material.metal_rough, &material.occlusion,
          &material.emissive, &material.shade_texture}) {
      if (!*texture || texture->picture->file().size() <= most_bytes) continue;
      const auto [place, is_new] = done.try_emplace(texture->picture);
      if (is_new) place->second = smaller(*texture->picture);
      if (is_new && place->second) ++count;
      if (place->second) texture->picture = place->second;
    }
  }
  return count;
}

}  // namespace animeme::studio

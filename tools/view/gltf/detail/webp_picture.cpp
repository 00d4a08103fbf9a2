// WebP by libwebp, which makes pictures smaller itself while it decodes.
#include <webp/decode.h>

#include "tools/view/gltf/detail/picture_formats.h"

namespace animeme::gltf {
namespace {

constexpr int kLossless = 2;

Result<WebPDecoderConfig> webp_config(std::span<const std::uint8_t> bytes) {
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config)) return damaged_picture("another version of libwebp");
  if (WebPGetFeatures(bytes.data(), bytes.size(), &config.input) != VP8_STATUS_OK) {
    return damaged_picture("its header cannot be read");
  }
  if (config.input.has_animation) {
    return make_error(Code::unsupported, "it is an animation; save it as PNG");
  }
  return config;
}

}  // namespace

Result<PictureSize> size_of_webp(std::span<const std::uint8_t> bytes) {
  const Result<WebPDecoderConfig> config = webp_config(bytes);
  if (!config) return config.error();
  return PictureSize{config->input.width, config->input.height};
}

Result<DecodedPicture> decode_webp(std::span<const std::uint8_t> bytes, std::int64_t most_texels) {
  Result<WebPDecoderConfig> found = webp_config(bytes);
  if (!found) return found.error();
  WebPDecoderConfig& config = *found;
  const PictureSize size{config.input.width, config.input.height};
  if (config.input.format == kLossless && size.texels() > kMostTexelsAtOnce) {
    return too_large_at_once("save it as PNG");
  }
  const int divisor = divisor_of(size, most_texels);
  DecodedPicture out;
  out.width = (size.width + divisor - 1) / divisor;
  out.height = (size.height + divisor - 1) / divisor;
  out.rgba.resize(std::size_t(out.width) * std::size_t(out.height) * 4);
  config.options.use_scaling = divisor > 1;
  config.options.scaled_width = out.width;
  config.options.scaled_height = out.height;
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {out.rgba.data(), out.width * 4, out.rgba.size()};
  const VP8StatusCode status = WebPDecode(bytes.data(), bytes.size(), &config);
  WebPFreeDecBuffer(&config.output);
  if (status != VP8_STATUS_OK) {
    return damaged_picture(status == VP8_STATUS_OUT_OF_MEMORY ? "no memory"
                                                              : "its texels cannot be read");
  }
  return out;
}

}  // namespace animeme::gltf

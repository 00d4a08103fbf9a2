#include <webp/encode.h>
#include <webp/mux.h>

#include "tools/view/studio/picture_file.h"

namespace animeme::studio {

struct Animation::Impl {
  int width, height;
  WebPConfig config{};
  WebPAnimEncoder* encoder = nullptr;

  ~Impl() { WebPAnimEncoderDelete(encoder); }
};

Animation::Animation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Animation::Animation(Animation&&) noexcept = default;
Animation& Animation::operator=(Animation&&) noexcept = default;
Animation::~Animation() = default;

Result<Animation> Animation::open(int width, int height, int quality) {
  const auto fits = [](int side) { return side >= 1 && side <= WEBP_MAX_DIMENSION; };
  if (!fits(width) || !fits(height) || quality < 1 || quality > 100) {
    return make_error(Code::invalid_argument, "an animation has 1 to 16383 pixels a side");
  }
  auto impl = std::make_unique<Impl>(Impl{width, height});
  WebPAnimEncoderOptions options;
  if (WebPConfigPreset(&impl->config, WEBP_PRESET_DEFAULT, float(quality)) == 0 ||
      WebPAnimEncoderOptionsInit(&options) == 0) {
    return make_error(Code::unsupported, "this libwebp is another than that of the headers");
  }
  impl->config.method = 2;  // quick: a film of 640 pixels is coded about as fast as it is drawn
  options.kmax = 25;        // a key frame now and then, so that errors end
  impl->encoder = WebPAnimEncoderNew(width, height, &options);
  if (impl->encoder == nullptr) return make_error(Code::out_of_range, "no memory for an animation");
  return Animation(std::move(impl));
}

Result<void> Animation::push(std::span<const std::uint8_t> rgba, int milliseconds) {
  if (rgba.size() != std::size_t(impl_->width) * std::size_t(impl_->height) * 4) {
    return make_error(Code::invalid_argument, "the picture has another size than the animation");
  }
  WebPPicture picture;
  if (WebPPictureInit(&picture) == 0) return make_error(Code::unsupported, "another libwebp");
  picture.width = impl_->width;
  picture.height = impl_->height;
  picture.use_argb = 1;
  const bool good = WebPPictureImportRGBA(&picture, rgba.data(), impl_->width * 4) != 0 &&
                    WebPAnimEncoderAdd(impl_->encoder, &picture, milliseconds, &impl_->config) != 0;
  WebPPictureFree(&picture);
  if (!good) return make_error(Code::out_of_range, WebPAnimEncoderGetError(impl_->encoder));
  return {};
}

Result<std::vector<std::uint8_t>> Animation::finish(int milliseconds) {
  WebPData data{};
  const bool good = WebPAnimEncoderAdd(impl_->encoder, nullptr, milliseconds, nullptr) != 0 &&
                    WebPAnimEncoderAssemble(impl_->encoder, &data) != 0;
  std::vector<std::uint8_t> out(data.bytes, data.bytes + data.size);
  WebPDataClear(&data);
  if (!good) return make_error(Code::out_of_range, WebPAnimEncoderGetError(impl_->encoder));
  return out;
}

}  // namespace animeme::studio

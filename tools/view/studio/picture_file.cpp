#include "tools/view/studio/picture_file.h"

#include <webp/encode.h>

#include "tools/view/render/png.h"
#include "tools/view/studio/jpeg_writer_internal.h"

namespace animeme::studio {
namespace {

constexpr int kLargestJpeg = 65535;

Result<std::vector<std::uint8_t>> webp_of(const render::Image& image, int quality) {
  std::uint8_t* bytes = nullptr;
  const std::size_t size = WebPEncodeRGBA(image.rgba.data(), image.width, image.height,
                                          image.width * 4, float(quality), &bytes);
  std::vector<std::uint8_t> out(bytes, bytes + size);
  WebPFree(bytes);
  if (size == 0) return make_error(Code::out_of_range, "the picture cannot be coded as WebP");
  return out;
}

}  // namespace

bool is_picture(std::string_view extension) {
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".webp";
}

Result<std::vector<std::uint8_t>> picture_of(const render::Image& image, std::string_view extension,
                                             int quality) {
  if (!is_picture(extension)) {
    return make_error(Code::unsupported, "pictures are .png, .jpg, .jpeg or .webp");
  }
  const bool webp = extension == ".webp";
  const int largest = webp ? WEBP_MAX_DIMENSION : kLargestJpeg;
  const auto sides = std::size_t(std::max(image.width, 0)) * std::size_t(std::max(image.height, 0));
  if (sides == 0 || image.width > largest || image.height > largest ||
      image.rgba.size() != sides * 4) {
    return make_error(Code::invalid_argument,
                      "a picture has 1 to " + std::to_string(largest) + " pixels a side");
  }
  if (extension == ".png") return render::png_of(image);
  return webp ? webp_of(image, quality) : jpeg_of(image, quality);
}

}  // namespace animeme::studio

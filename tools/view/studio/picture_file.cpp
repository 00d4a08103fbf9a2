#include "tools/view/studio/picture_file.h"

#include <csetjmp>
#include <cstdlib>

#include <jpeglib.h>
#include <webp/encode.h>

#include "tools/view/render/png.h"

namespace animeme::studio {

namespace {

struct Errors {
  jpeg_error_mgr base;
  std::jmp_buf back;
};

[[noreturn]] void give_up(j_common_ptr common) {
  std::longjmp(reinterpret_cast<Errors*>(common->err)->back, 1);
}

void say_nothing(j_common_ptr) {}

// Nothing in here has a destructor: the library leaves it by longjmp.
bool compress(const render::Image& image, int quality, unsigned char** bytes, unsigned long* size) {
  jpeg_compress_struct writer;
  Errors errors;
  writer.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = give_up;
  errors.base.output_message = say_nothing;
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_compress(&writer);
    return false;
  }
  jpeg_create_compress(&writer);
  jpeg_mem_dest(&writer, bytes, size);
  writer.image_width = JDIMENSION(image.width);
  writer.image_height = JDIMENSION(image.height);
  writer.input_components = 4;
  writer.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&writer);
  jpeg_set_quality(&writer, quality, TRUE);
  writer.optimize_coding = TRUE;
  jpeg_start_compress(&writer, TRUE);
  while (writer.next_scanline < writer.image_height) {
    const std::size_t at = std::size_t(writer.next_scanline) * std::size_t(image.width) * 4;
    auto* row = const_cast<JSAMPLE*>(image.rgba.data() + at);
    jpeg_write_scanlines(&writer, &row, 1);
  }
  jpeg_finish_compress(&writer);
  jpeg_destroy_compress(&writer);
  return true;
}

// Baseline, 4:2:0. The picture is valid, quality 1..100. Errors: out_of_range (memory).
Result<std::vector<std::uint8_t>> jpeg_of(const render::Image& image, int quality) {
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool good = compress(image, quality, &bytes, &size);
  std::vector<std::uint8_t> out;
  if (good) out.assign(bytes, bytes + size);
  std::free(bytes);
  if (!good) return make_error(Code::out_of_range, "the picture cannot be coded as JPEG");
  return out;
}

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

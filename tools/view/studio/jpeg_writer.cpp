#include "tools/view/studio/jpeg_writer_internal.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
//
#include <jpeglib.h>

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

}  // namespace

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

}  // namespace animeme::studio

// PNG by libpng. Its errors come by longjmp(); the functions that call it own nothing.
#include <png.h>

#include <csetjmp>
#include <cstring>

#include "tools/view/gltf/detail/picture_formats.h"

namespace animeme::gltf {
namespace {

constexpr png_alloc_size_t kMostChunk = 1 << 20;

struct PngReader {
  std::span<const std::uint8_t> bytes;
  png_structp png = nullptr;
  png_infop info = nullptr;
  PictureSize size;
  bool interlaced = false;
  char why[100] = "no memory";

  explicit PngReader(std::span<const std::uint8_t> all) : bytes(all) {}
  PngReader(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_png_error(png_structp png, png_const_charp message) {
  auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(reader->why, message, sizeof reader->why - 1);
  png_longjmp(png, 1);
}

void on_png_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void read_png_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader->bytes.size()) png_error(png, "it ends too early");
  std::memcpy(to, reader->bytes.data(), count);
  reader->bytes = reader->bytes.subspan(count);
}

// False: see `why`.
bool read_png_header(PngReader& reader) {
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_png_error, on_png_warning);
  if (reader.png == nullptr) return false;
  reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) return false;
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, &reader, read_png_bytes);
  // Gamma, profiles and texts are not looked at, and so take no memory.
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_chunk_malloc_max(reader.png, kMostChunk);
  png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff);  // size_of_picture() has the limit
  png_read_info(reader.png, reader.info);
  reader.size = {int(png_get_image_width(reader.png, reader.info)),
                 int(png_get_image_height(reader.png, reader.info))};
  reader.interlaced = png_get_interlace_type(reader.png, reader.info) != PNG_INTERLACE_NONE;
  return true;
}

// Rows come as RGBA into `row`, of interlaced pictures into `whole`.
bool read_png_rows(PngReader& reader, std::uint8_t* row, std::uint8_t* whole, Shrinker& out) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_expand(reader.png);
  png_set_scale_16(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 255, PNG_FILLER_AFTER);
  const int passes = png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  const std::size_t width = std::size_t(reader.size.width) * 4;
  if (png_get_rowbytes(reader.png, reader.info) != width) return false;
  for (int pass = 0; pass < passes; ++pass) {
    for (int y = 0; y < reader.size.height; ++y) {
      std::uint8_t* place = whole == nullptr ? row : whole + std::size_t(y) * width;
      png_read_row(reader.png, place, nullptr);
      if (pass + 1 == passes) out.add(place);
    }
  }
  return true;
}

}  // namespace

Result<PictureSize> size_of_png(std::span<const std::uint8_t> bytes) {
  PngReader reader(bytes);
  if (!read_png_header(reader)) return damaged_picture(reader.why);
  return reader.size;
}

Result<DecodedPicture> decode_png(std::span<const std::uint8_t> bytes, std::int64_t most_texels) {
  PngReader reader(bytes);
  if (!read_png_header(reader)) return damaged_picture(reader.why);
  if (reader.interlaced && reader.size.texels() > kMostTexelsAtOnce) {
    return too_large_at_once("save it without interlacing");
  }
  Shrinker out(reader.size, divisor_of(reader.size, most_texels));
  std::vector<std::uint8_t> row(std::size_t(reader.size.width) * 4);
  std::vector<std::uint8_t> whole(reader.interlaced ? row.size() * std::size_t(reader.size.height)
                                                    : 0);
  if (!read_png_rows(reader, row.data(), reader.interlaced ? whole.data() : nullptr, out)) {
    return damaged_picture(reader.why);
  }
  return out.take();
}

}  // namespace animeme::gltf

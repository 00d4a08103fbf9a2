// JPEG by libjpeg-turbo. Its errors come by longjmp(); the functions that call it own nothing.
#include <csetjmp>
#include <cstddef>
#include <cstdio>

#include <jpeglib.h>

#include <jerror.h>

#include "tools/view/gltf/detail/picture_formats.h"

namespace animeme::gltf {
namespace {

// Coefficients of a progressive picture: three planes of 16 bits of what is decoded at once.
constexpr long kMostMemory = long(kMostTexelsAtOnce) * 3 * 2 + (8 << 20);
// Each scan goes through all of the picture: a few bytes could keep the decoder busy for hours.
constexpr int kMostScans = 100;

struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf back{};
  char why[JMSG_LENGTH_MAX] = "no memory";
  bool too_large = false;

  JpegReader() = default;
  JpegReader(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
};

JpegReader& jpeg_reader_of(j_common_ptr jpeg) {
  return *static_cast<JpegReader*>(jpeg->client_data);
}

[[noreturn]] void on_jpeg_error(j_common_ptr jpeg) {
  JpegReader& reader = jpeg_reader_of(jpeg);
  // It would put on disk what is above the limit.
  reader.too_large = jpeg->err->msg_code == JERR_NO_BACKING_STORE;
  (*jpeg->err->format_message)(jpeg, reader.why);
  std::longjmp(reader.back, 1);
}

// Warnings are damage that the library paints over, but for bytes between parts and versions.
void on_jpeg_message(j_common_ptr jpeg, int level) {
  const int code = jpeg->err->msg_code;
  if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM &&
      code != JWRN_JFIF_MAJOR) {
    on_jpeg_error(jpeg);
  }
}

void on_jpeg_progress(j_common_ptr jpeg) {
  JpegReader& reader = jpeg_reader_of(jpeg);
  if (reader.jpeg.input_scan_number <= kMostScans) return;
  std::snprintf(reader.why, sizeof reader.why, "it has more than %d scans", kMostScans);
  std::longjmp(reader.back, 1);
}

// False: see `why`.
bool read_jpeg_header(JpegReader& reader, std::span<const std::uint8_t> bytes) {
  reader.jpeg.err = jpeg_std_error(&reader.errors);
  reader.errors.error_exit = on_jpeg_error;
  reader.errors.emit_message = on_jpeg_message;
  reader.jpeg.client_data = &reader;
  if (setjmp(reader.back) != 0) return false;
  jpeg_create_decompress(&reader.jpeg);
  reader.jpeg.mem->max_memory_to_use = kMostMemory;
  reader.progress.progress_monitor = on_jpeg_progress;
  reader.jpeg.progress = &reader.progress;
  jpeg_mem_src(&reader.jpeg, bytes.data(), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&reader.jpeg, TRUE);
  return true;
}

// Sets what comes out: RGBA, or of pictures for print CMYK, which the library does not turn.
bool start_jpeg(JpegReader& reader) {
  if (setjmp(reader.back) != 0) return false;
  const J_COLOR_SPACE space = reader.jpeg.jpeg_color_space;
  const bool print = space == JCS_CMYK || space == JCS_YCCK;
  reader.jpeg.out_color_space = print ? JCS_CMYK : JCS_EXT_RGBA;
  reader.jpeg.dct_method = JDCT_ISLOW;  // the same values on any machine
  jpeg_start_decompress(&reader.jpeg);
  return true;
}

// Adobe's programs write inks upside down: 255 is none.
void to_rgba(std::uint8_t* row, int width, bool inverted) {
  for (int x = 0; x < width; ++x, row += 4) {
    const int key = inverted ? row[3] : 255 - row[3];
    for (int c = 0; c < 3; ++c) {
      const int ink = inverted ? row[c] : 255 - row[c];
      row[c] = std::uint8_t((ink * key + 127) / 255);
    }
    row[3] = 255;
  }
}

bool read_jpeg_rows(JpegReader& reader, std::uint8_t* row, Shrinker& out) {
  if (setjmp(reader.back) != 0) return false;
  while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
    jpeg_read_scanlines(&reader.jpeg, &row, 1);
    if (reader.jpeg.out_color_space == JCS_CMYK) {
      to_rgba(row, int(reader.jpeg.output_width), reader.jpeg.saw_Adobe_marker != 0);
    }
    out.add(row);
  }
  return true;
}

PictureSize jpeg_size(const JpegReader& reader) {
  return {int(reader.jpeg.image_width), int(reader.jpeg.image_height)};
}

Error jpeg_error(const JpegReader& reader) {
  if (reader.too_large) return too_large_at_once("save it as JPEG that is not progressive");
  return damaged_picture(reader.why);
}

}  // namespace

Result<PictureSize> size_of_jpeg(std::span<const std::uint8_t> bytes) {
  JpegReader reader;
  if (!read_jpeg_header(reader, bytes)) return jpeg_error(reader);
  return jpeg_size(reader);
}

Result<DecodedPicture> decode_jpeg(std::span<const std::uint8_t> bytes, std::int64_t most_texels) {
  JpegReader reader;
  if (!read_jpeg_header(reader, bytes) || !start_jpeg(reader)) return jpeg_error(reader);
  const PictureSize size = jpeg_size(reader);
  Shrinker out(size, divisor_of(size, most_texels));
  std::vector<std::uint8_t> row(std::size_t(size.width) * 4);
  if (!read_jpeg_rows(reader, row.data(), out)) return jpeg_error(reader);
  return out.take();
}

}  // namespace animeme::gltf

// Pictures of every kind for tests, by the encoders of libpng, libjpeg and libwebp; and by hand
// what no encoder writes.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <vector>

#include <jpeglib.h>
#include <png.h>
#include <webp/encode.h>

#include "tests/support/files.h"

namespace animeme::test {

struct PngKind {
  int colour = PNG_COLOR_TYPE_RGBA;  ///< PNG_COLOR_TYPE_...
  int depth = 8;
  bool interlaced = false;
  bool transparent = false;  ///< of palettes: entry 0 is, by tRNS
};

/// `rows`: packed as the kind says, each row in whole bytes. A palette has entries of (i, 255 - i,
/// 7 i mod 256).
inline Bytes png_as(const Bytes& rows, int width, int height, PngKind kind) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp to, png_bytep data, std::size_t size) {
        auto* bytes = static_cast<Bytes*>(png_get_io_ptr(to));
        bytes->insert(bytes->end(), data, data + size);
      },
      nullptr);
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), kind.depth, kind.colour,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
  if (kind.colour == PNG_COLOR_TYPE_PALETTE) {
    std::vector<png_color> palette;
    for (int i = 0; i < 1 << kind.depth; ++i) {
      palette.push_back({png_byte(i), png_byte(255 - i), png_byte(7 * i)});
    }
    png_set_PLTE(png, info, palette.data(), int(palette.size()));
    const png_byte clear = 0;
    if (kind.transparent) png_set_tRNS(png, info, &clear, 1, nullptr);
  }
  png_write_info(png, info);
  if (kind.interlaced) png_set_interlace_handling(png);
  std::vector<png_bytep> places;
  const std::size_t size = rows.size() / std::size_t(height);
  for (int y = 0; y < height; ++y) {
    places.push_back(const_cast<png_bytep>(rows.data()) + std::size_t(y) * size);
  }
  png_write_image(png, places.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

struct JpegKind {
  int components = 3;  ///< 1 grey, 3 RGB, 4 CMYK as Adobe writes it (255: no ink)
  int quality = 100;
  bool progressive = false;
  bool separate = false;    ///< a scan for each of three components
  bool full_colour = true;  ///< colours as fine as light
};

inline Bytes jpeg_as(Bytes rows, int width, int height, JpegKind kind) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = JDIMENSION(width);
  jpeg.image_height = JDIMENSION(height);
  jpeg.input_components = kind.components;
  jpeg.in_color_space = kind.components == 1   ? JCS_GRAYSCALE
                        : kind.components == 3 ? JCS_RGB
                                               : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, kind.quality, TRUE);
  if (kind.progressive) jpeg_simple_progression(&jpeg);
  if (kind.components == 3 && kind.full_colour) {
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
  }
  const jpeg_scan_info scans[] = {
      {1, {0}, 0, 63, 0, 0}, {1, {1}, 0, 63, 0, 0}, {1, {2}, 0, 63, 0, 0}};
  if (kind.separate) {
    jpeg.scan_info = scans;
    jpeg.num_scans = 3;
  }
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < height; ++y) {
    JSAMPROW row = rows.data() + std::size_t(y) * rows.size() / std::size_t(height);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  Bytes out(data, data + size);
  jpeg_destroy_compress(&jpeg);
  std::free(data);
  return out;
}

/// `quality` 0..100, below 0: without loss.
inline Bytes webp_as(const Bytes& rgba, int width, int height, float quality) {
  std::uint8_t* data = nullptr;
  const std::size_t size =
      quality < 0 ? WebPEncodeLosslessRGBA(rgba.data(), width, height, width * 4, &data)
                  : WebPEncodeRGBA(rgba.data(), width, height, width * 4, quality, &data);
  Bytes out(data, data + size);
  WebPFree(data);
  return out;
}

namespace jpeg {

/// A part of a JPEG: marker, length, content.
inline void part(Bytes& file, std::uint8_t marker, const Bytes& content) {
  const std::size_t size = content.size() + 2;
  file.insert(file.end(), {0xFF, marker, std::uint8_t(size >> 8), std::uint8_t(size)});
  file.insert(file.end(), content.begin(), content.end());
}

inline Bytes frame(int width, int height, std::uint8_t table = 0) {
  return {8,
          std::uint8_t(height >> 8),
          std::uint8_t(height),
          std::uint8_t(width >> 8),
          std::uint8_t(width),
          1,
          1,
          0x11,
          table};
}

}  // namespace jpeg

/// A JPEG whose Huffman table counts more than 256 symbols, and gives them all.
inline Bytes jpeg_with_too_many_symbols() {
  Bytes file = {0xFF, 0xD8};
  Bytes quantisation(65, 1);
  quantisation[0] = 0;
  jpeg::part(file, 0xDB, quantisation);
  jpeg::part(file, 0xC0, jpeg::frame(16, 16));
  for (const std::uint8_t table : Bytes{0x00, 0x10}) {
    Bytes huffman = {table};
    for (int i = 0; i < 16; ++i) huffman.push_back(i < 8 ? 0 : 255);
    huffman.resize(huffman.size() + std::size_t(8 * 255), 0xAA);
    jpeg::part(file, 0xC4, huffman);
  }
  jpeg::part(file, 0xDA, {1, 1, 0x00, 0, 63, 0});
  file.resize(file.size() + 200, 0x55);
  file.insert(file.end(), {0xFF, 0xD9});
  return file;
}

/// A JPEG that uses tables which it never sends.
inline Bytes jpeg_without_tables() {
  Bytes file = {0xFF, 0xD8};
  jpeg::part(file, 0xC0, jpeg::frame(16, 16, 3));
  jpeg::part(file, 0xDA, {1, 1, 0x33, 0, 63, 0});
  file.resize(file.size() + 200, 0x55);
  file.insert(file.end(), {0xFF, 0xD9});
  return file;
}

}  // namespace animeme::test

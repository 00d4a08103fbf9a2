#include "tools/view/render/png.h"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace animeme::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_number(Bytes& out, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::uint8_t(v >> shift));
}

void put_chunk(Bytes& out, std::string_view type, const Bytes& data) {
  put_number(out, std::uint32_t(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  put_number(out, std::uint32_t(crc32(0, &out[start], uInt(out.size() - start))));
}

int paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int dl = std::abs(guess - left);
  const int da = std::abs(guess - above);
  const int dc = std::abs(guess - corner);
  if (dl <= da && dl <= dc) return left;
  return da <= dc ? above : corner;
}

// One row by one of the five filters of PNG, its number in front; `step`: bytes of a pixel.
Bytes filtered(int filter, const Bytes& row, const Bytes& above, std::size_t step) {
  Bytes out = {std::uint8_t(filter)};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int left = i >= step ? row[i - step] : 0;
    const int corner = i >= step ? above[i - step] : 0;
    const int guesses[] = {0, left, above[i], (left + above[i]) / 2, paeth(left, above[i], corner)};
    out.push_back(std::uint8_t(row[i] - guesses[filter]));
  }
  return out;
}

// The filter whose bytes, taken as signed, are smallest in sum.
Bytes best_filtered(const Bytes& row, const Bytes& above, std::size_t step) {
  Bytes best;
  long least = 0;
  for (int filter = 0; filter < 5; ++filter) {
    Bytes trial = filtered(filter, row, above, step);
    long sum = 0;
    for (std::size_t i = 1; i < trial.size(); ++i) sum += std::abs(int(std::int8_t(trial[i])));
    if (filter > 0 && sum >= least) continue;
    least = sum;
    best = std::move(trial);
  }
  return best;
}

bool whole(const Image& image) {
  return image.width > 0 && image.height > 0 &&
         image.rgba.size() == std::size_t(image.width) * std::size_t(image.height) * 4;
}

}  // namespace

Result<Bytes> png_of(const Image& image) {
  if (!whole(image)) return make_error(Code::invalid_argument, "the picture has no pixels");
  bool opaque = true;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) opaque = opaque && image.rgba[i] == 255;
  const std::size_t step = opaque ? 3 : 4;
  Bytes rows;
  Bytes above(std::size_t(image.width) * step);
  for (int y = 0; y < image.height; ++y) {
    Bytes row;
    row.reserve(above.size());
    const std::uint8_t* pixel = &image.rgba[std::size_t(y) * std::size_t(image.width) * 4];
    for (int x = 0; x < image.width; ++x, pixel += 4) row.insert(row.end(), pixel, pixel + step);
    const Bytes best = best_filtered(row, above, step);
    rows.insert(rows.end(), best.begin(), best.end());
    above = std::move(row);
  }
  uLongf size = compressBound(uLong(rows.size()));
  Bytes packed(size);
  // The highest level would take five times as long for the last few percent.
  if (compress2(packed.data(), &size, rows.data(), uLong(rows.size()), 6) != Z_OK) {
    return make_error(Code::out_of_range, "there is not enough memory to compress the picture");
  }
  packed.resize(size);
  Bytes header;
  put_number(header, std::uint32_t(image.width));
  put_number(header, std::uint32_t(image.height));
  // 8 bits, RGB or RGBA, no interlacing
  header.insert(header.end(), {8, std::uint8_t(opaque ? 2 : 6), 0, 0, 0});
  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  put_chunk(png, "IHDR", header);
  put_chunk(png, "IDAT", packed);
  put_chunk(png, "IEND", {});
  return png;
}

Result<Image> contact_sheet(const std::vector<Image>& pictures, int columns, int gap) {
  if (pictures.empty() || columns < 1 || gap < 0) {
    return make_error(Code::invalid_argument, "a contact sheet needs pictures and columns");
  }
  const int width = pictures[0].width;
  const int height = pictures[0].height;
  const int rows = (int(pictures.size()) + columns - 1) / columns;
  Image sheet{width * columns + gap * (columns - 1), height * rows + gap * (rows - 1), {}};
  sheet.rgba.assign(std::size_t(sheet.width) * std::size_t(sheet.height) * 4, 20);
  for (std::size_t i = 3; i < sheet.rgba.size(); i += 4) sheet.rgba[i] = 255;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    const Image& picture = pictures[k];
    if (!whole(picture) || picture.width != width || picture.height != height) {
      return make_error(Code::invalid_argument,
                        "the pictures of a contact sheet have to be of one size");
    }
    const auto left = std::size_t(int(k) % columns * (width + gap));
    const auto top = std::size_t(int(k) / columns * (height + gap));
    for (std::size_t y = 0; y < std::size_t(height); ++y) {
      std::copy_n(&picture.rgba[y * std::size_t(width) * 4], width * 4,
                  &sheet.rgba[((top + y) * std::size_t(sheet.width) + left) * 4]);
    }
  }
  return sheet;
}

}  // namespace animeme::render

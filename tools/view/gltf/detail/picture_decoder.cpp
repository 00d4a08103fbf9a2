#include "tools/view/gltf/detail/picture_decoder.h"

#include <algorithm>
#include <string_view>

#include "tools/view/gltf/detail/picture_formats.h"

namespace animeme::gltf {
namespace {

struct PictureFormat {
  const char* type;
  Result<PictureSize> (*size)(std::span<const std::uint8_t>);
  Result<DecodedPicture> (*decode)(std::span<const std::uint8_t>, std::int64_t);
};

Result<PictureFormat> format_of(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG\r\n\x1A\n"))
    return PictureFormat{"image/png", size_of_png, decode_png};
  if (text.starts_with("\xFF\xD8\xFF")) {
    return PictureFormat{"image/jpeg", size_of_jpeg, decode_jpeg};
  }
  if (text.starts_with("RIFF") && text.substr(8 < text.size() ? 8 : 0).starts_with("WEBP")) {
    return PictureFormat{"image/webp", size_of_webp, decode_webp};
  }
  if (text.starts_with("\xABKTX 20\xBB")) {
    return make_error(Code::unsupported,
                      "it is KTX2, which is not read; export it as PNG, JPEG or WebP");
  }
  return make_error(Code::unsupported, "it is neither PNG nor JPEG nor WebP; save it as PNG");
}

}  // namespace

Error damaged_picture(const std::string& why) {
  return make_error(Code::syntax, "it is damaged (" + why + "); save it again");
}

Error too_large_at_once(const std::string& remedy) {
  return make_error(Code::out_of_range,
                    "it cannot be decoded row by row and has more than 4096 x 4096 texels; " +
                        remedy + ", or make it smaller");
}

int divisor_of(PictureSize size, std::int64_t most_texels) {
  int divisor = 1;
  const auto side = [&](int length) { return std::int64_t((length + divisor - 1) / divisor); };
  while (divisor < kLongestSide && side(size.width) * side(size.height) > most_texels) divisor *= 2;
  return divisor;
}

Shrinker::Shrinker(PictureSize size, int divisor) : size_(size), divisor_(divisor) {
  out_.width = (size.width + divisor - 1) / divisor;
  out_.height = (size.height + divisor - 1) / divisor;
  out_.rgba.resize(std::size_t(out_.width) * std::size_t(out_.height) * 4);
  if (divisor > 1) sums_.resize(std::size_t(out_.width) * 4);
}

void Shrinker::add(const std::uint8_t* row) {
  if (done_ == out_.height) return;
  const std::size_t width = std::size_t(out_.width) * 4;
  if (divisor_ == 1) {
    std::copy_n(row, width, out_.rgba.data() + std::size_t(done_++) * width);
    return;
  }
  for (int x = 0; x < size_.width; ++x) {
    std::uint32_t* sum = sums_.data() + std::size_t(x / divisor_) * 4;
    for (std::size_t c = 0; c < 4; ++c) sum[c] += row[std::size_t(x) * 4 + c];
  }
  ++in_sums_;
  if (in_sums_ == divisor_ || done_ * divisor_ + in_sums_ == size_.height) finish_row();
}

void Shrinker::finish_row() {
  std::uint8_t* to = out_.rgba.data() + std::size_t(done_) * std::size_t(out_.width) * 4;
  for (int x = 0; x < out_.width; ++x) {
    const int columns = std::min(divisor_, size_.width - x * divisor_);
    const auto count = std::uint32_t(columns * in_sums_);
    for (std::size_t c = 0; c < 4; ++c) {
      std::uint32_t& sum = sums_[std::size_t(x) * 4 + c];
      *to++ = std::uint8_t((sum + count / 2) / count);
      sum = 0;
    }
  }
  in_sums_ = 0;
  ++done_;
}

Result<PictureSize> size_of_picture(std::span<const std::uint8_t> bytes) {
  const Result<PictureFormat> format = format_of(bytes);
  if (!format) return format.error();
  Result<PictureSize> size = format->size(bytes);
  if (!size) return size;
  if (size->width < 1 || size->height < 1) return damaged_picture("it has no texels");
  if (size->width > kLongestSide || size->height > kLongestSide || size->texels() > kMostTexels) {
    return make_error(Code::out_of_range, "it has " + std::to_string(size->width) + " x " +
                                              std::to_string(size->height) +
                                              " texels, more than 8192 x 8192 or 16384 on a "
                                              "side; make it smaller");
  }
  return size;
}

std::string type_of_picture(std::span<const std::uint8_t> bytes) {
  const Result<PictureFormat> format = format_of(bytes);
  return format ? format->type : "";
}

Result<DecodedPicture> decode_picture(std::span<const std::uint8_t> bytes,
                                      std::int64_t most_texels) {
  if (auto size = size_of_picture(bytes); !size) return size.error();
  return format_of(bytes)->decode(bytes, most_texels);
}

}  // namespace animeme::gltf

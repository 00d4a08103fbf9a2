#include "fap/xml/detail/tga.h"

#include <cmath>

#include "fap/head/srgb.h"

namespace animeme::head::detail {
namespace {

constexpr std::size_t kHeader = 18;
constexpr std::size_t kMostTexels = 16'000'000;
constexpr int kXfaceMostSide = 512;
enum Type : std::uint8_t { kColour = 2, kGrey = 3, kRuns = 8 };

std::uint8_t byte_at(std::string_view bytes, std::size_t i) { return std::uint8_t(bytes[i]); }
int short_at(std::string_view bytes, std::size_t i) {
  return byte_at(bytes, i) + 256 * byte_at(bytes, i + 1);
}

Error cut_off() {
  return make_error(Code::truncated, "the image ends before its last row; save it again");
}

// The texels of a file one after the other as its bytes, runs unpacked.
Result<std::string> unpacked(std::string_view bytes, std::size_t depth, std::size_t texels) {
  std::string out;
  out.reserve((texels + 128) * depth);
  while (out.size() < texels * depth) {
    if (bytes.empty()) return cut_off();
    const std::size_t count = std::size_t(byte_at(bytes, 0) & 127) + 1;
    const bool run = byte_at(bytes, 0) >= 128;
    const std::size_t length = run ? depth : count * depth;
    if (bytes.size() < 1 + length) return cut_off();
    for (std::size_t i = 0; i < (run ? count : 1); ++i) out += bytes.substr(1, length);
    bytes.remove_prefix(1 + length);
  }
  return out;
}

bool power_of_two(int n) { return n >= 2 && (n & (n - 1)) == 0; }

}  // namespace

Result<TgaPicture> read_tga(std::string_view bytes) {
  if (bytes.size() < kHeader) {
    return make_error(Code::truncated, "the image ends within its header; save it again");
  }
  const int type = byte_at(bytes, 2) & ~kRuns;
  const std::size_t depth = byte_at(bytes, 16) / 8;
  const bool grey = type == kGrey && depth == 1;
  const bool good_type = (byte_at(bytes, 2) & ~15) == 0 && byte_at(bytes, 1) == 0;
  if (!good_type || byte_at(bytes, 16) % 8 != 0 ||
      !(grey || (type == kColour && (depth == 3 || depth == 4)))) {
    return make_error(Code::unsupported,
                      "the image is not a TGA of 24 or 32 bits; save it as uncompressed TGA");
  }
  TgaPicture picture;
  picture.width = short_at(bytes, 12);
  picture.height = short_at(bytes, 14);
  const std::size_t texels = std::size_t(picture.width) * std::size_t(picture.height);
  if (texels == 0 || texels > kMostTexels) {
    return make_error(Code::out_of_range, "the picture has " + std::to_string(picture.width) +
                                              " x " + std::to_string(picture.height) +
                                              " texels, not 1 to 16 million; make it 512 x 512");
  }
  const std::size_t begin = kHeader + byte_at(bytes, 0);
  std::string_view content = bytes.substr(std::min(begin, bytes.size()));
  std::string plain;
  const bool runs = (byte_at(bytes, 2) & kRuns) != 0;
  if (runs) {
    auto unpack = unpacked(content, depth, texels);
    if (!unpack) return unpack.error();
    plain = std::move(*unpack);
    content = plain;
  }
  if (content.size() < texels * depth) return cut_off();
  const bool from_top = (byte_at(bytes, 17) & 0x20) != 0;
  const bool from_right = (byte_at(bytes, 17) & 0x10) != 0;
  picture.rgb.reserve(texels * 3);
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int row = from_top ? picture.height - 1 - y : y;
      const int column = from_right ? picture.width - 1 - x : x;
      const std::size_t at =
          (std::size_t(row) * std::size_t(picture.width) + std::size_t(column)) * depth;
      for (const std::size_t channel : {2, 1, 0}) {  // blue comes first in the file
        picture.rgb.push_back(byte_at(content, at + (grey ? 0 : channel)));
      }
    }
  }
  if (!power_of_two(picture.width) || !power_of_two(picture.height) ||
      std::max(picture.width, picture.height) > kXfaceMostSide) {
    picture.trouble = "its sides are not powers of two up to 512";
  } else if (runs) {
    picture.trouble = "it is compressed";
  } else if (begin != kHeader) {
    picture.trouble = "it has a comment in its header";
  } else if (from_top || from_right) {
    picture.trouble = "its first texel is not the lower left one, so Xface shows it upside down";
  }
  return picture;
}

std::string write_tga(const TgaPicture& picture) {
  std::string out(kHeader, '\0');
  out[2] = char(kColour);
  out[12] = char(picture.width & 255);
  out[13] = char(picture.width >> 8);
  out[14] = char(picture.height & 255);
  out[15] = char(picture.height >> 8);
  out[16] = 24;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    for (const std::size_t channel : {2, 1, 0}) out += char(picture.rgb[i + channel]);
  }
  return out;
}

Vec3 colour_at(const TgaPicture& picture, TexturePlace place) {
  // The texel before a place, the one behind, and how far it is from the one to the other.
  struct Pair {
    int first, second;
    float share;
  };
  const auto pair = [](float place01, int size) {
    const double at = (double(place01) - std::floor(double(place01))) * size - 0.5;
    const int first = int(std::floor(at));
    return Pair{(first + size) % size, (first + 1) % size, float(at - first)};
  };
  const Pair x = pair(place.u, picture.width);
  const Pair y = pair(place.v, picture.height);
  const auto colour = [&](int column, int row) {
    const std::uint8_t* t = picture.texel(column, row);
    return Vec3{float(t[0]), float(t[1]), float(t[2])};
  };
  const Vec3 below = mix(colour(x.first, y.first), colour(x.second, y.first), x.share);
  const Vec3 above = mix(colour(x.first, y.second), colour(x.second, y.second), x.share);
  return linear_of_srgb(mix(below, above, y.share) * (1 / 255.0f));
}

}  // namespace animeme::head::detail

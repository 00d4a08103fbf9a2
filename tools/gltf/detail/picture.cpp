#include "tools/gltf/detail/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fap/head/srgb.h"

namespace animeme::gltf {
namespace {

float linear(std::uint8_t value) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = float(head::linear_of_srgb(double(i) / 255));
    }
    return all;
  }();
  return table[value];
}

int wrapped(int at, int size, Picture::Wrap wrap) {
  if (wrap == Picture::Wrap::clamp) return std::clamp(at, 0, size - 1);
  const int period = wrap == Picture::Wrap::mirror ? 2 * size : size;
  const int within = (at % period + period) % period;
  return within < size ? within : period - 1 - within;
}

// Far away places are the same as near ones; it keeps them within the range of int.
double near_zero(double place, Picture::Wrap wrap) {
  if (wrap == Picture::Wrap::clamp) return std::clamp(place, -1.0, 2.0);
  return place - 2 * std::floor(place / 2);
}

const std::uint8_t* texel_at(const DecodedPicture& level, int x, int y) {
  return &level.rgba[(std::size_t(y) * std::size_t(level.width) + std::size_t(x)) * 4];
}

DecodedPicture half_of(const DecodedPicture& from) {
  DecodedPicture to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
  to.rgba.reserve(std::size_t(to.width) * std::size_t(to.height) * 4);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      for (std::size_t c = 0; c < 4; ++c) {
        int sum = 2;
        for (int k = 0; k < 4; ++k) {
          sum += texel_at(from, std::min(2 * x + k % 2, from.width - 1),
                          std::min(2 * y + k / 2, from.height - 1))[c];
        }
        to.rgba.push_back(std::uint8_t(sum / 4));
      }
    }
  }
  return to;
}

}  // namespace

Picture::Picture(DecodedPicture decoded) {
  levels_.push_back(std::move(decoded));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    levels_.push_back(half_of(levels_.back()));
  }
}

Colour Picture::at(Uv place, Wrap wrap_u, Wrap wrap_v, double footprint) const {
  std::size_t number = 0;
  for (; number + 1 < levels_.size() && footprint >= 2; footprint /= 2) ++number;
  const DecodedPicture& level = levels_[number];
  const double x = near_zero(double(place.u), wrap_u) * level.width - 0.5;
  const double y = near_zero(double(place.v), wrap_v) * level.height - 0.5;
  const int left = int(std::floor(x)), top = int(std::floor(y));
  Colour sum{{0, 0, 0}, 0};
  for (int k = 0; k < 4; ++k) {
    const double share =
        (k % 2 == 0 ? 1 - (x - left) : x - left) * (k / 2 == 0 ? 1 - (y - top) : y - top);
    const std::uint8_t* texel = texel_at(level, wrapped(left + k % 2, level.width, wrap_u),
                                         wrapped(top + k / 2, level.height, wrap_v));
    sum.rgb += head::Vec3{linear(texel[0]), linear(texel[1]), linear(texel[2])} * float(share);
    sum.alpha += float(texel[3]) / 255 * float(share);
  }
  return sum;
}

}  // namespace animeme::gltf

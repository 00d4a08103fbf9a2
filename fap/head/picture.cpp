#include "fap/head/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fap/head/srgb.h"

namespace animeme::head {
namespace {

using ByteTable = std::array<float, 256>;

const ByteTable& table_of(TexelKind kind) {
  static const std::array<ByteTable, 2> tables = [] {
    std::array<ByteTable, 2> all;
    for (std::size_t i = 0; i < 256; ++i) {
      all[0][i] = float(linear_of_srgb(double(i) / 255));
      all[1][i] = float(double(i) / 255);
    }
    return all;
  }();
  return tables[kind == TexelKind::colour ? 0 : 1];
}

// sRGB byte of linear light in steps of 1/4096, rounded.
const std::vector<std::uint8_t>& byte_table() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> all;
    for (int i = 0; i <= 4096; ++i) {
      all.push_back(std::uint8_t(std::lround(255 * srgb_of_linear(double(i) / 4096))));
    }
    return all;
  }();
  return table;
}

int wrapped(int at, int size, Wrap wrap) {
  if (at >= 0 && at < size) return at;
  if (wrap == Wrap::clamp) return std::clamp(at, 0, size - 1);
  const int period = wrap == Wrap::mirror ? 2 * size : size;
  const int within = (at % period + period) % period;
  return within < size ? within : period - 1 - within;
}

// Far away places are the same as near ones; it keeps them within the range of int.
float near_zero(float place, Wrap wrap) {
  if (place >= 0 && place < 1) return place;
  if (!std::isfinite(place)) return 0;
  if (wrap == Wrap::clamp) return std::clamp(place, -1.0f, 2.0f);
  return place - 2 * std::floor(place / 2);
}

// std::floor() is a call where processors of any age have to do.
int whole_below(float value) {
  const int whole = int(value);
  return float(whole) > value ? whole - 1 : whole;
}

const std::uint8_t* texel_at(const Texels& level, int x, int y) {
  return &level.rgba[(std::size_t(y) * std::size_t(level.width) + std::size_t(x)) * 4];
}

// Means of light, not of bytes: dark hairs on skin would become too dark.
Texels half_of(const Texels& from, TexelKind kind) {
  const ByteTable& light = table_of(kind);
  Texels to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
  to.rgba.reserve(std::size_t(to.width) * std::size_t(to.height) * 4);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const std::uint8_t* four[4];
      for (int k = 0; k < 4; ++k) {
        four[k] = texel_at(from, std::min(2 * x + k % 2, from.width - 1),
                           std::min(2 * y + k / 2, from.height - 1));
      }
      for (std::size_t c = 0; c < 4; ++c) {
        const bool is_light = c < 3 && kind == TexelKind::colour;
        if (is_light) {
          const float sum =
              light[four[0][c]] + light[four[1][c]] + light[four[2][c]] + light[four[3][c]];
          to.rgba.push_back(byte_table()[std::size_t(sum * 1024 + 0.5f)]);
        } else {
          to.rgba.push_back(
              std::uint8_t((four[0][c] + four[1][c] + four[2][c] + four[3][c] + 2) / 4));
        }
      }
    }
  }
  return to;
}

}  // namespace

Picture::Picture(Texels texels, TexelKind kind, std::vector<std::uint8_t> file, std::string type)
    : kind_(kind), light_(table_of(kind).data()), file_(std::move(file)), type_(std::move(type)) {
  levels_.push_back(std::move(texels));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    levels_.push_back(half_of(levels_.back(), kind));
  }
}

const Texels& Picture::within(int side) const {
  std::size_t number = 0;
  while (std::max(levels_[number].width, levels_[number].height) > side) ++number;
  return levels_[number];
}

Colour Picture::sample(std::size_t number, Uv place, Wrap wrap_u, Wrap wrap_v) const {
  const Texels& level = levels_[number];
  const float* light = light_;
  const float x = near_zero(place.u, wrap_u) * float(level.width) - 0.5f;
  const float y = near_zero(place.v, wrap_v) * float(level.height) - 0.5f;
  const int left = whole_below(x), top = whole_below(y);
  const float right_share = x - float(left), low_share = y - float(top);
  const int x0 = wrapped(left, level.width, wrap_u);
  const int x1 = wrapped(left + 1, level.width, wrap_u);
  const int y0 = wrapped(top, level.height, wrap_v);
  const int y1 = wrapped(top + 1, level.height, wrap_v);
  const std::uint8_t* texels[] = {texel_at(level, x0, y0), texel_at(level, x1, y0),
                                  texel_at(level, x0, y1), texel_at(level, x1, y1)};
  const float shares[] = {(1 - right_share) * (1 - low_share), right_share * (1 - low_share),
                          (1 - right_share) * low_share, right_share * low_share};
  Colour sum{{0, 0, 0}, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint8_t* texel = texels[k];
    sum.rgb += Vec3{light[texel[0]], light[texel[1]], light[texel[2]]} * shares[k];
    sum.alpha += float(texel[3]) * shares[k];
  }
  sum.alpha /= 255;
  return sum;
}

Colour Picture::at(Uv place, Wrap wrap_u, Wrap wrap_v, double footprint) const {
  std::size_t number = 0;
  for (; number + 1 < levels_.size() && footprint >= 2; footprint /= 2) ++number;
  return sample(number, place, wrap_u, wrap_v);
}

Colour Picture::between(Uv place, Wrap wrap_u, Wrap wrap_v, float level) const {
  const float last = float(levels_.size() - 1);
  const float at = level > 0 ? std::min(level, last) : 0;  // not a number: 0
  const auto first = std::size_t(at);
  const float share = at - float(first);
  const Colour a = sample(first, place, wrap_u, wrap_v);
  if (share == 0) return a;
  const Colour b = sample(first + 1, place, wrap_u, wrap_v);
  return {mix(a.rgb, b.rgb, share), a.alpha + (b.alpha - a.alpha) * share};
}

}  // namespace animeme::head

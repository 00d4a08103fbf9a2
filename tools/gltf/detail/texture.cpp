#include "tools/gltf/detail/texture.h"

#include <algorithm>

#include "fap/head/srgb.h"
#include "tools/gltf/detail/picture_decoder.h"

namespace animeme::gltf {
namespace {

using head::Vec3;

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

Picture::Wrap wrap_of(const Json& value) {
  switch (whole_or(value, 10497)) {
    case 33071:
      return Picture::Wrap::clamp;
    case 33648:
      return Picture::Wrap::mirror;
    default:
      return Picture::Wrap::repeat;
  }
}

Colour factor_of(const Json& value) {
  const auto rgba = numbers(value, 4);
  if (!rgba) return {};
  const auto part = [&](std::size_t i) { return float(std::clamp((*rgba)[i], 0.0, 1.0)); };
  return {{part(0), part(1), part(2)}, part(3)};
}

std::array<std::array<float, 3>, 2> move_of(const Json& transform) {
  const auto offset = numbers(member(transform, "offset"), 2);
  const auto scale = numbers(member(transform, "scale"), 2);
  const double angle = number_or(member(transform, "rotation"), 0);
  const double c = std::cos(angle), s = std::sin(angle);
  const double x = scale ? (*scale)[0] : 1, y = scale ? (*scale)[1] : 1;
  return {{{float(c * x), float(s * y), offset ? float((*offset)[0]) : 0},
           {float(-s * x), float(c * y), offset ? float((*offset)[1]) : 0}}};
}

}  // namespace

std::shared_ptr<const Picture> Picture::decode(std::span<const std::uint8_t> bytes) {
  auto decoded = decode_picture(bytes);
  if (!decoded) return nullptr;
  auto picture = std::make_shared<Picture>();
  picture->levels_.push_back({decoded->width, decoded->height, std::move(decoded->rgba)});
  while (picture->levels_.back().width > 1 || picture->levels_.back().height > 1) {
    const Level& from = picture->levels_.back();
    Level to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
    to.rgba.resize(std::size_t(to.width) * std::size_t(to.height) * 4);
    for (int y = 0; y < to.height; ++y) {
      for (int x = 0; x < to.width; ++x) {
        for (int c = 0; c < 4; ++c) {
          int sum = 2;
          for (int k = 0; k < 4; ++k) {
            const int px = std::min(2 * x + k % 2, from.width - 1);
            const int py = std::min(2 * y + k / 2, from.height - 1);
            sum += from.rgba[(std::size_t(py) * std::size_t(from.width) + std::size_t(px)) * 4 +
                             std::size_t(c)];
          }
          to.rgba[(std::size_t(y) * std::size_t(to.width) + std::size_t(x)) * 4 + std::size_t(c)] =
              std::uint8_t(sum / 4);
        }
      }
    }
    picture->levels_.push_back(std::move(to));
  }
  return picture;
}

Colour Picture::at(Uv place, Wrap wrap_u, Wrap wrap_v, double footprint) const {
  std::size_t number = 0;
  for (; number + 1 < levels_.size() && footprint >= 2; footprint /= 2) ++number;
  const Level& level = levels_[number];
  const double x = near_zero(double(place.u), wrap_u) * level.width - 0.5;
  const double y = near_zero(double(place.v), wrap_v) * level.height - 0.5;
  const int left = int(std::floor(x)), top = int(std::floor(y));
  Colour sum{{0, 0, 0}, 0};
  for (int k = 0; k < 4; ++k) {
    const double share =
        (k % 2 == 0 ? 1 - (x - left) : x - left) * (k / 2 == 0 ? 1 - (y - top) : y - top);
    const int px = wrapped(left + k % 2, level.width, wrap_u);
    const int py = wrapped(top + k / 2, level.height, wrap_v);
    const std::uint8_t* texel =
        &level.rgba[(std::size_t(py) * std::size_t(level.width) + std::size_t(px)) * 4];
    sum.rgb += Vec3{linear(texel[0]), linear(texel[1]), linear(texel[2])} * float(share);
    sum.alpha += float(texel[3]) / 255 * float(share);
  }
  return sum;
}

Colour Paint::at(Uv place, double footprint) const {
  Colour colour = factor;
  if (picture) {
    const Uv moved{move[0][0] * place.u + move[0][1] * place.v + move[0][2],
                   move[1][0] * place.u + move[1][1] * place.v + move[1][2]};
    const bool finite = std::isfinite(moved.u) && std::isfinite(moved.v);
    const Colour texel = picture->at(finite ? moved : Uv{}, wrap_u, wrap_v, footprint);
    colour = {colour.rgb * texel.rgb, colour.alpha * texel.alpha};
  }
  if (alpha == AlphaMode::opaque) colour.alpha = 1;
  return colour;
}

double Paint::texels(Uv a, Uv b) const {
  if (!picture) return 0;
  const double du = double(b.u) - double(a.u), dv = double(b.v) - double(a.v);
  const double x = (double(move[0][0]) * du + double(move[0][1]) * dv) * picture->width();
  const double y = (double(move[1][0]) * du + double(move[1][1]) * dv) * picture->height();
  return std::sqrt(x * x + y * y);
}

const Paint& Paints::of(std::optional<std::size_t> material) {
  if (!material) return white_;
  for (const auto& [number, paint] : paints_) {
    if (number == *material) return *paint;
  }
  paints_.emplace_back(*material, std::make_unique<Paint>(make(*material)));
  return *paints_.back().second;
}

Paint Paints::make(std::size_t material) {
  const Json& entry = file_.entry("materials", material);
  const Json& base = member(entry, "pbrMetallicRoughness");
  const Json& old = member(entry, "extensions", "KHR_materials_pbrSpecularGlossiness");
  const bool use_old = base.is_null() && !old.is_null();
  Paint paint;
  paint.name = text_or(member(entry, "name"));
  paint.factor =
      factor_of(member(use_old ? old : base, use_old ? "diffuseFactor" : "baseColorFactor"));
  const std::string mode = text_or(member(entry, "alphaMode"));
  if (mode == "MASK") paint.alpha = AlphaMode::mask;
  if (mode == "BLEND") paint.alpha = AlphaMode::blend;
  if (paint.alpha == AlphaMode::mask) {
    paint.cutoff = float(number_or(member(entry, "alphaCutoff"), 0.5));
  }
  const Json& glass = member(entry, "extensions", "KHR_materials_transmission");
  paint.see_through = number_or(member(glass, "transmissionFactor"), 0) > 0.5;
  add_texture(member(use_old ? old : base, use_old ? "diffuseTexture" : "baseColorTexture"), paint);
  return paint;
}

void Paints::add_texture(const Json& info, Paint& paint) {
  const std::optional<std::size_t> index = whole(member(info, "index"));
  if (!index) return;
  const Json& texture = file_.entry("textures", *index);
  const Json& transform = member(info, "extensions", "KHR_texture_transform");
  const Json& sampler =
      file_.entry("samplers", whole_or(member(texture, "sampler"), ~std::size_t(0)));
  paint.wrap_u = wrap_of(member(sampler, "wrapS"));
  paint.wrap_v = wrap_of(member(sampler, "wrapT"));
  paint.move = move_of(transform);
  paint.uv_set = whole_or(member(transform, "texCoord"), whole_or(member(info, "texCoord"), 0));
  if (const auto image = whole(member(texture, "source"))) {
    paint.picture = picture(*image);
  } else {
    notes_.push_back("the texture of material \"" + paint.name +
                     "\" is neither PNG nor JPEG and is left out: export it as PNG");
  }
}

std::shared_ptr<const Picture> Paints::picture(std::size_t image) {
  for (const auto& [number, known] : pictures_) {
    if (number == image) return known;
  }
  const Json& entry = file_.entry("images", image);
  std::shared_ptr<const Picture> found;
  std::string why = "it is neither PNG nor JPEG, or larger than 64 million texels";
  if (const auto view = whole(member(entry, "bufferView"))) {
    if (auto bytes = view_of(file_, *view)) found = Picture::decode(*bytes);
  } else if (auto bytes = resolve(text_or(member(entry, "uri")), load_)) {
    found = Picture::decode(*bytes);
  } else {
    why = bytes.error().message;
  }
  if (!found) {
    const std::string name = text_or(member(entry, "name"), text_or(member(entry, "uri")));
    notes_.push_back("texture " + std::to_string(image) + " \"" + name.substr(0, 60) +
                     "\" is left out: " + why);
  }
  pictures_.emplace_back(image, found);
  return found;
}

}  // namespace animeme::gltf

#include "tools/view/gltf/detail/paint.h"

#include <algorithm>
#include <cmath>

#include "fap/head/own_head.h"

namespace animeme::gltf {
namespace {

using head::Triangle;
using head::Vec3;

// Length of the edges at each vertex in texels: their mean.
std::vector<double> footprints(const RawPiece& piece) {
  std::vector<double> sums(piece.positions.size(), 0);
  std::vector<int> counts(piece.positions.size(), 0);
  for (const Triangle& t : piece.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      const double texels = piece.paint->texels(piece.uvs[a], piece.uvs[b]);
      sums[a] += texels;
      sums[b] += texels;
      ++counts[a];
      ++counts[b];
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] /= std::max(counts[v], 1);
  return sums;
}

// Mean and largest opacity of a triangle: corners, middles of edges, centre.
struct Opacity {
  float mean = 0;
  float most = 0;
};

Opacity opacity(const RawPiece& piece, const Triangle& t, bool textured) {
  float sum = 0;
  float most = 0;
  int count = 0;
  const auto add = [&](float a, float b, float c) {
    float alpha = 1;
    if (textured) {
      const Uv x = piece.uvs[t[0]], y = piece.uvs[t[1]], z = piece.uvs[t[2]];
      const double texels = piece.paint->texels(x, y);
      alpha =
          piece.paint->at({x.u * a + y.u * b + z.u * c, x.v * a + y.v * b + z.v * c}, texels / 4)
              .alpha;
    } else {
      alpha = piece.paint->factor.alpha;
    }
    if (!piece.colours.empty()) {
      alpha *= piece.colours[t[0]].alpha * a + piece.colours[t[1]].alpha * b +
               piece.colours[t[2]].alpha * c;
    }
    sum += alpha;
    most = std::max(most, alpha);
    ++count;
  };
  add(1, 0, 0);
  add(0, 1, 0);
  add(0, 0, 1);
  add(0.5f, 0.5f, 0);
  add(0, 0.5f, 0.5f);
  add(0.5f, 0, 0.5f);
  add(1 / 3.0f, 1 / 3.0f, 1 / 3.0f);
  return {sum / float(count), most};
}

std::uint8_t byte_of(float share) {
  return std::uint8_t(std::lround(255 * std::clamp(share, 0.0f, 1.0f)));
}

}  // namespace

bool has_texture(const RawPiece& piece) {
  return piece.paint->picture && piece.uvs.size() == piece.positions.size();
}

void add_corners(RawPiece& piece) {
  const bool has_uvs = piece.uvs.size() == piece.positions.size();
  const bool has_colours = piece.colours.size() == piece.positions.size();
  for (std::uint32_t v = 0; v < piece.positions.size(); ++v) {
    head::Corner& corner = piece.corners.emplace_back();
    corner.vertex = v;
    if (v < piece.normals.size()) corner.normal = piece.normals[v];
    if (has_uvs) corner.uv = piece.paint->moved(piece.uvs[v]);
    if (!has_colours) continue;
    const Colour& c = piece.colours[v];
    corner.tint = {byte_of(c.rgb.x), byte_of(c.rgb.y), byte_of(c.rgb.z), byte_of(c.alpha)};
  }
  piece.materials.assign(piece.triangles.size(), std::uint16_t(piece.paint->material));
}

void paint(RawPiece& piece) {
  const bool textured = has_texture(piece);
  const Paint& paint = *piece.paint;
  const bool with_materials = !piece.corners.empty();
  if (paint.alpha != AlphaMode::opaque) {
    std::erase_if(piece.triangles, [&](const Triangle& t) {
      const Opacity found = opacity(piece, t, textured);
      if (found.mean >= paint.cutoff) return false;
      const float nothing = paint.alpha == AlphaMode::mask ? paint.cutoff : 1 / 255.0f;
      if (with_materials && found.most >= nothing) piece.transparent.push_back(t);
      return true;
    });
  }
  if (with_materials && paint.see_through) {
    piece.transparent.insert(piece.transparent.end(), piece.triangles.begin(),
                             piece.triangles.end());
    piece.triangles.clear();
  }
  piece.materials.resize(with_materials ? piece.triangles.size() + piece.transparent.size() : 0,
                         std::uint16_t(paint.material));
  if (!textured && piece.colours.empty() && paint.factor.rgb == Vec3{1, 1, 1}) {
    piece.colours.assign(piece.positions.size(), {head::kNoColour, 1});
    return;
  }
  const std::vector<double> widths = textured ? footprints(piece) : std::vector<double>{};
  piece.colours.resize(piece.positions.size());
  for (std::size_t v = 0; v < piece.colours.size(); ++v) {
    Vec3& rgb = piece.colours[v].rgb;
    rgb = rgb * (textured ? paint.at(piece.uvs[v], widths[v] / 2).rgb : paint.factor.rgb);
    rgb = {std::clamp(rgb.x, 0.0f, 1.0f), std::clamp(rgb.y, 0.0f, 1.0f),
           std::clamp(rgb.z, 0.0f, 1.0f)};
  }
}

}  // namespace animeme::gltf

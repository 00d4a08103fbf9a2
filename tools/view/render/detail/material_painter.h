// A facet with a material, pixel by pixel: textures in perspective, then light.
#pragma once

#include <array>

#include "tools/view/render/detail/material_light.h"
#include "tools/view/render/detail/side.h"

namespace animeme::render::detail {

struct MaterialFacet {
  Corners screen;          ///< counterclockwise as the camera sees them
  head::Triangle corners;  ///< of the surface, in the same order
  const Surface& surface;
  const head::Material& material;
  bool back;  ///< the camera sees its back
};

class MaterialPainter {
 public:
  MaterialPainter(const MaterialFacet& facet, const ScreenFrame& frame, const View& view)
      : facet_(facet), frame_(frame), view_(view) {}

  static constexpr bool kDraws = true;
  /// Draws where something is as near: itself, or what it lies on, as painted brows do.
  bool over() const { return facet_.material.alpha_mode != head::AlphaMode::mask; }
  bool blends() const { return facet_.material.alpha_mode == head::AlphaMode::blend; }

  /// The colour (0..255, as shown) at a place in pixels from the first corner, and its opacity; 0:
  /// nothing is there.
  float paint(float x, float y, F4& shown);

 private:
  using Shares = std::array<float, 3>;
  void make();
  Shares shares_at(float x, float y) const;
  head::Uv uv_at(float x, float y) const;
  head::Vec3 normal_at(const Shares& shares, const head::Vec3& texel) const;
  head::Vec3 place_at(float x, float y, const Shares& shares) const;

  const MaterialFacet& facet_;
  const ScreenFrame& frame_;
  const View& view_;
  bool ready_ = false;
  std::array<const head::Corner*, 3> corners_{};
  std::array<const ScreenVertex*, 3> screen_{};
  std::array<head::Vec3, 2> edges_;  // from the first corner, for normal textures
};

}  // namespace animeme::render::detail

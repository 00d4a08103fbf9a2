/// @file
/// A software renderer for heads: no GPU, the same pixels with any number of threads.
///
///     animeme::render::Renderer renderer({.width = 640, .height = 640});
///     const animeme::render::Image& image = renderer.render(scene, camera);
///
/// Four coverage samples and one colour sample per pixel; lighting is per vertex, but per pixel for
/// eye highlights and for surfaces with materials. Pores and the lines of lips are drawn per pixel.
/// These blend as in browsers: in sRGB, back to front. The lights are fixed to the camera: a warm
/// key from the upper right with a red terminator (light inside of skin), a cool fill from the
/// left, a weak rim from behind.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fap/head/model.h"
#include "tools/view/render/image.h"

/// A software renderer for heads.
namespace animeme::render {

/// A perspective camera. Right-handed: the picture's right is cross(target - eye, up).
struct Camera {
  head::Vec3 eye = {0, 0, 100};   ///< position, cm
  head::Vec3 target = {0, 0, 0};  ///< target, cm
  head::Vec3 up = {0, 1, 0};      ///< not parallel to the view
  float view_angle = 0.45f;       ///< from the bottom of the picture to its top, rad
};

/// A mesh to draw. All spans are borrowed; those of vertices have the same length. Back faces
/// (clockwise as seen by the camera) are not drawn.
struct Surface {
  std::span<const head::Vec3> positions;             ///< cm
  std::span<const head::Vec3> normals;               ///< length 1
  std::span<const head::Vec3> colours;               ///< linear RGB
  std::span<const float> occlusion;                  ///< 0..1
  std::span<const head::Triangle> triangles;         ///< indices of the vertices
  head::SurfaceKind kind = head::SurfaceKind::skin;  ///< material for vertex lighting
  head::Transform transform;                         ///< applied to positions and normals
  /// Drawn instead of `triangles` if not empty: see head::Mesh. Facets with an invalid index or
  /// material are not drawn.
  std::span<const head::Triangle> facets;
  std::span<const head::Corner> corners;           ///< of facets
  std::span<const std::uint16_t> facet_materials;  ///< of each facet, index of `materials`
  std::span<const head::Material> materials;       ///< see head::Head
  std::span<const head::Vec3> normals_at_rest;     ///< of vertices; corner normals rotate with them
  std::span<const head::Grain> grain;              ///< of vertices, see head::Mesh; may be empty
  std::span<const head::Vec3> positions_at_rest;   ///< of vertices, if they have grain
};

/// Surfaces to draw, with depth test.
struct Scene {
  std::vector<Surface> surfaces;  ///< in any order
};

/// Size and effort; the pixels do not depend on `threads`.
struct RenderOptions {
  int width = 640;                             ///< pixels, 1..8192
  int height = 640;                            ///< pixels, 1..8192
  int threads = 0;                             ///< 0: as many as the machine has
  std::uint32_t background_top = 0x51606E;     ///< sRGB
  std::uint32_t background_bottom = 0x262B33;  ///< sRGB
  /// Behind the head instead of the colours: width x height pixels, whose alpha is not used;
  /// another size: the colours. Empty: the colours.
  std::shared_ptr<const Image> background = {};
  bool transparent = false;  ///< no background at all: pixels have alpha
};

/// Renders pictures and reuses its memory.
class Renderer {
 public:
  /// Sizes outside their range are clamped.
  explicit Renderer(const RenderOptions& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;  ///< movable
  Renderer& operator=(Renderer&&) noexcept;

  /// The picture is valid until the next call. Triangles nearer to the camera than 1 or with an
  /// index beyond the vertices are not drawn.
  const Image& render(const Scene& scene, const Camera& camera);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// One picture.
Image render(const Scene& scene, const Camera& camera, const RenderOptions& options = {});

}  // namespace animeme::render

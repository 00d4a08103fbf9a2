#include "tools/view/render/raster.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <exception>
#include <mutex>
#include <thread>

#include "tools/view/render/detail/tile.h"

namespace animeme::render {
namespace {

using detail::kSubpixels;
using detail::kTile;
using detail::ScreenVertex;

struct Stretch {
  std::size_t first, last;
};
Stretch stretch_of(std::size_t count, int thread, int threads) {
  return {count * std::size_t(thread) / std::size_t(threads),
          count * std::size_t(thread + 1) / std::size_t(threads)};
}

// Twice the area on the screen; negative: seen from its front.
std::int64_t screen_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  return std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(b.y - a.y) * (c.x - a.x);
}

std::span<const head::Triangle> triangles_of(const Surface& surface) {
  return surface.facets.empty() ? surface.triangles : surface.facets;
}

// Null: it has none.
const head::Material* material_of(const Surface& surface, std::size_t facet) {
  if (facet >= surface.facet_materials.size()) return nullptr;
  const std::uint16_t material = surface.facet_materials[facet];
  return material < surface.materials.size() ? &surface.materials[material] : nullptr;
}

}  // namespace

struct Renderer::State {
  // A triangle of a tile: which surface, which triangle.
  struct Entry {
    std::uint32_t surface;
    std::uint32_t triangle;  // or facet
  };
  // One that blends, and how near it is.
  struct Transparent {
    Entry entry;
    float nearness;
  };
  // What one thread found for each tile. Threads take neighbouring stretches of all triangles, so
  // their lists one after the other are in the order of the scene.
  struct Bin {
    std::vector<Entry> solid;
    std::vector<Transparent> transparent;
  };
  using Bins = std::vector<Bin>;

  RenderOptions options;
  Image image;
  int threads = 1;
  int tiles_x = 0;
  int tiles_y = 0;
  std::vector<std::vector<ScreenVertex>> vertices;  // by surface
  std::vector<Bins> bins;                           // by thread
  std::vector<detail::Tile> tiles;                  // by thread
  detail::GrainTable grain;                         // as sharp as the last picture shows it
  std::atomic<int> next_tile = 0;                   // that no thread has taken yet

  void shade_part(const Scene& scene, const detail::View& view, int thread);
  void bin_part(const Scene& scene, int thread);
  void bin_triangle(const Surface& surface, Entry entry, Bins& out);
  detail::MaterialFacet facet_of(const Scene& scene, Entry entry) const;
  void cover_facets(const Scene& scene, int index, detail::Tile& tile) const;
  void draw_transparent(const Scene& scene, const detail::View& view, int index,
                        detail::Tile& tile);
  void draw_part(const Scene& scene, const detail::View& view, int thread);
};

void Renderer::State::shade_part(const Scene& scene, const detail::View& view, int thread) {
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Stretch part = stretch_of(vertices[s].size(), thread, threads);
    const auto work = scene.surfaces[s].facets.empty() ? detail::shade : detail::place_corners;
    work(scene.surfaces[s], view, part.first, part.last, vertices[s].data());
  }
}

void Renderer::State::bin_part(const Scene& scene, int thread) {
  Bins& out = bins[std::size_t(thread)];
  for (Bin& bin : out) {
    bin.solid.clear();
    bin.transparent.clear();
  }
  std::size_t total = 0;
  for (const Surface& surface : scene.surfaces) total += triangles_of(surface).size();
  const Stretch part = stretch_of(total, thread, threads);
  std::size_t begin = 0;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const std::size_t count = triangles_of(scene.surfaces[s]).size();
    const std::size_t first = std::max(part.first, begin) - begin;
    const std::size_t last = std::max(std::min(part.last, begin + count), begin) - begin;
    for (std::size_t t = first; t < last; ++t) {
      bin_triangle(scene.surfaces[s], {std::uint32_t(s), std::uint32_t(t)}, out);
    }
    begin += count;
  }
}

void Renderer::State::bin_triangle(const Surface& surface, Entry entry, Bins& out) {
  const auto& screen = vertices[entry.surface];
  const head::Triangle& t = triangles_of(surface)[entry.triangle];
  if (t[0] >= screen.size() || t[1] >= screen.size() || t[2] >= screen.size()) return;
  const head::Material* material = material_of(surface, entry.triangle);
  if (material == nullptr && !surface.facets.empty()) return;
  const ScreenVertex& a = screen[t[0]];
  const ScreenVertex& b = screen[t[1]];
  const ScreenVertex& c = screen[t[2]];
  if (a.nearness <= 0 || b.nearness <= 0 || c.nearness <= 0) return;
  const std::int64_t area = screen_area(a, b, c);
  if (area == 0 || (area > 0 && (material == nullptr || !material->double_sided))) return;
  constexpr int kStep = kTile * kSubpixels;
  const auto tile = [](std::int32_t v) { return v >= 0 ? v / kStep : -1; };
  const int x0 = std::max(tile(std::min({a.x, b.x, c.x})), 0);
  const int y0 = std::max(tile(std::min({a.y, b.y, c.y})), 0);
  const int x1 = std::min(tile(std::max({a.x, b.x, c.x})), tiles_x - 1);
  const int y1 = std::min(tile(std::max({a.y, b.y, c.y})), tiles_y - 1);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      Bin& bin = out[std::size_t(y * tiles_x + x)];
      if (material != nullptr && material->alpha_mode == head::AlphaMode::blend) {
        bin.transparent.push_back({entry, a.nearness + b.nearness + c.nearness});
      } else {
        bin.solid.push_back(entry);
      }
    }
  }
}

detail::MaterialFacet Renderer::State::facet_of(const Scene& scene, Entry entry) const {
  const Surface& surface = scene.surfaces[entry.surface];
  const ScreenVertex* v = vertices[entry.surface].data();
  head::Triangle t = surface.facets[entry.triangle];
  const bool back = screen_area(v[t[0]], v[t[1]], v[t[2]]) > 0;
  if (back) std::swap(t[1], t[2]);
  return {{v + t[0], v + t[1], v + t[2]}, t, surface, *material_of(surface, entry.triangle), back};
}

// Textures and light cost more than to find out first what is seen.
void Renderer::State::cover_facets(const Scene& scene, int index, detail::Tile& tile) const {
  for (const Bins& found : bins) {
    for (const Entry& entry : found[std::size_t(index)].solid) {
      if (scene.surfaces[entry.surface].facets.empty()) continue;
      const detail::MaterialFacet facet = facet_of(scene, entry);
      if (facet.material.alpha_mode == head::AlphaMode::opaque) tile.cover(facet);
    }
  }
}

// What is farther away goes first.
void Renderer::State::draw_transparent(const Scene& scene, const detail::View& view, int index,
                                       detail::Tile& tile) {
  std::vector<Transparent> transparent;
  for (const Bins& found : bins) {
    const auto& more = found[std::size_t(index)].transparent;
    transparent.insert(transparent.end(), more.begin(), more.end());
  }
  std::stable_sort(
      transparent.begin(), transparent.end(),
      [](const Transparent& a, const Transparent& b) { return a.nearness < b.nearness; });
  for (const Transparent& facet : transparent) tile.draw(facet_of(scene, facet.entry), view);
}

void Renderer::State::draw_part(const Scene& scene, const detail::View& view, int thread) {
  detail::Tile& tile = tiles[std::size_t(thread)];
  for (int index = next_tile++; index < tiles_x * tiles_y; index = next_tile++) {
    tile.start(index % tiles_x * kTile, index / tiles_x * kTile, options);
    cover_facets(scene, index, tile);
    for (const Bins& found : bins) {
      for (const Entry& entry : found[std::size_t(index)].solid) {
        const Surface& surface = scene.surfaces[entry.surface];
        if (!surface.facets.empty()) {
          tile.draw(facet_of(scene, entry), view);
          continue;
        }
        const head::Triangle& t = surface.triangles[entry.triangle];
        const ScreenVertex* v = vertices[entry.surface].data();
        tile.draw({v + t[0], v + t[1], v + t[2]}, surface.kind == head::SurfaceKind::eye, view);
      }
    }
    draw_transparent(scene, view, index, tile);
    tile.finish(image);
  }
}

Renderer::Renderer(const RenderOptions& options) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.options = options;
  s.options.width = std::clamp(options.width, 1, 8192);
  s.options.height = std::clamp(options.height, 1, 8192);
  s.image.width = s.options.width;
  s.image.height = s.options.height;
  s.image.rgba.resize(std::size_t(s.image.width) * std::size_t(s.image.height) * 4);
  const int machine = std::max(int(std::thread::hardware_concurrency()), 1);
  s.threads = std::clamp(options.threads > 0 ? options.threads : machine, 1, 64);
  s.tiles_x = (s.options.width + kTile - 1) / kTile;
  s.tiles_y = (s.options.height + kTile - 1) / kTile;
  s.bins.resize(std::size_t(s.threads));
  for (State::Bins& b : s.bins) b.resize(std::size_t(s.tiles_x * s.tiles_y));
  s.tiles.resize(std::size_t(s.threads));
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Image& Renderer::render(const Scene& scene, const Camera& camera) {
  State& s = *state_;
  detail::View view(camera, s.options.width, s.options.height);
  s.grain.set(view.focus * detail::kGrainTexel / length(camera.eye - camera.target));
  view.grain = &s.grain;
  s.vertices.resize(scene.surfaces.size());
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& surface = scene.surfaces[i];
    s.vertices[i].resize(surface.facets.empty() ? surface.positions.size()
                                                : surface.corners.size());
  }
  s.next_tile = 0;
  std::barrier step(s.threads);
  std::atomic<int> next_shade = 0, next_bin = 0;  // part that no thread has taken yet
  std::mutex mutex;
  std::exception_ptr failure;  // the first one; no memory, most likely
  const auto guarded = [&](const auto& phase) {
    try {
      phase();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  const auto work = [&](int thread) {
    guarded([&] {
      for (int i = next_shade++; i < s.threads; i = next_shade++) s.shade_part(scene, view, i);
    });
    step.arrive_and_wait();
    guarded([&] {
      for (int i = next_bin++; i < s.threads; i = next_bin++) s.bin_part(scene, i);
    });
    step.arrive_and_wait();
    guarded([&] { s.draw_part(scene, view, thread); });
  };
  std::vector<std::thread> others;
  others.reserve(std::size_t(s.threads));
  for (int t = 1; t < s.threads; ++t) {
    try {
      others.emplace_back(work, t);
    } catch (const std::exception&) {
      step.arrive_and_drop();  // no more threads to be had: the others do the work
    }
  }
  work(0);
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
  return s.image;
}

Image render(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  return Renderer(options).render(scene, camera);
}

}  // namespace animeme::render

#include "tools/view/gltf/detail/glb_buffer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "tools/view/gltf/detail/container.h"

namespace animeme::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// Codes of OpenGL.
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

struct Bounds {
  std::array<float, 3> low = {INFINITY, INFINITY, INFINITY};
  std::array<float, 3> high = {-INFINITY, -INFINITY, -INFINITY};

  void add(head::Vec3 v) {
    const std::array<float, 3> parts = {v.x, v.y, v.z};
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], parts[c]);
      high[c] = std::max(high[c], parts[c]);
    }
  }
};

}  // namespace

int GlbBuffer::view(const void* data, std::size_t size, BufferUse use, int stride) {
  while (bytes_.size() % 4 != 0) bytes_.push_back(0);
  Json entry = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
  if (use == BufferUse::vertices) entry["target"] = kVertexTarget;
  if (use == BufferUse::indices) entry["target"] = kIndexTarget;
  if (stride > 0) entry["byteStride"] = stride;
  views.push_back(std::move(entry));
  const auto* first = static_cast<const std::uint8_t*>(data);
  bytes_.insert(bytes_.end(), first, first + size);
  return int(views.size()) - 1;
}

int GlbBuffer::accessor(int view, int type, std::size_t count, const char* shape) {
  accessors.push_back(
      {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
  return int(accessors.size()) - 1;
}

int GlbBuffer::vectors(std::span<const head::Vec3> values, BufferUse use, bool bounds) {
  static_assert(sizeof(head::Vec3) == 12);
  const int number =
      accessor(view(values.data(), values.size_bytes(), use), kFloat, values.size(), "VEC3");
  if (bounds) {
    Bounds box;
    for (const head::Vec3& v : values) box.add(v);
    accessors.back()["min"] = box.low;
    accessors.back()["max"] = box.high;
  }
  return number;
}

int GlbBuffer::floats(std::span<const float> values, int components, BufferUse use, bool bounds) {
  const char* shape = components == 1 ? "SCALAR" : components == 4 ? "VEC4" : "MAT4";
  const int number = accessor(view(values.data(), values.size_bytes(), use), kFloat,
                              values.size() / std::size_t(components), shape);
  if (bounds) {
    accessors.back()["min"] = {*std::min_element(values.begin(), values.end())};
    accessors.back()["max"] = {*std::max_element(values.begin(), values.end())};
  }
  return number;
}

int GlbBuffer::triangles(std::span<const std::uint32_t> indices) {
  const std::uint32_t largest = *std::max_element(indices.begin(), indices.end());
  if (largest >= 65535) {
    return accessor(view(indices.data(), indices.size_bytes(), BufferUse::indices), kUnsignedInt,
                    indices.size(), "SCALAR");
  }
  const std::vector<std::uint16_t> shorts(indices.begin(), indices.end());
  return accessor(view(shorts.data(), shorts.size() * 2, BufferUse::indices), kUnsignedShort,
                  indices.size(), "SCALAR");
}

int GlbBuffer::colours(std::span<const head::Vec3> values) {
  std::vector<std::uint16_t> shorts;
  const auto add = [&](float value) {
    shorts.push_back(std::uint16_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 65535)));
  };
  for (const head::Vec3& v : values) {
    add(v.x);
    add(v.y);
    add(v.z);
    shorts.push_back(65535);  // a vertex has to begin at a multiple of four bytes
  }
  const int number = accessor(view(shorts.data(), shorts.size() * 2, BufferUse::vertices, 8),
                              kUnsignedShort, values.size(), "VEC4");
  accessors.back()["normalized"] = true;
  return number;
}

int GlbBuffer::joints(std::span<const std::uint8_t> values) {
  return accessor(view(values.data(), values.size(), BufferUse::vertices, 4), kUnsignedByte,
                  values.size() / 4, "VEC4");
}

int GlbBuffer::sparse(std::size_t count, std::span<const std::uint32_t> vertices,
                      std::span<const head::Vec3> values) {
  Bounds box;
  for (const head::Vec3& v : values) box.add(v);
  if (values.size() < count) box.add({0, 0, 0});
  Json indices = {{"componentType", kUnsignedInt}};
  if (vertices.back() < 65535) {
    const std::vector<std::uint16_t> shorts(vertices.begin(), vertices.end());
    indices["componentType"] = kUnsignedShort;
    indices["bufferView"] = view(shorts.data(), shorts.size() * 2, BufferUse::other);
  } else {
    indices["bufferView"] = view(vertices.data(), vertices.size_bytes(), BufferUse::other);
  }
  const int data = view(values.data(), values.size_bytes(), BufferUse::other);
  accessors.push_back({{"componentType", kFloat},
                       {"count", count},
                       {"type", "VEC3"},
                       {"min", box.low},
                       {"max", box.high},
                       {"sparse",
                        {{"count", vertices.size()},
                         {"indices", std::move(indices)},
                         {"values", {{"bufferView", data}}}}}});
  return int(accessors.size()) - 1;
}

Result<std::vector<std::uint8_t>> GlbBuffer::file(Json root) {
  while (bytes_.size() % 4 != 0) bytes_.push_back(0);
  root["buffers"] = {{{"byteLength", bytes_.size()}}};
  const std::string text = sorted_text(std::move(root));
  Result<std::vector<std::uint8_t>> file = glb_front(text, bytes_.size());
  if (file) file->insert(file->end(), bytes_.begin(), bytes_.end());
  return file;
}

}  // namespace animeme::gltf

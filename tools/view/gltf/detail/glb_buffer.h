// The binary part of a GLB file and the accessors that describe it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/head/vector.h"
#include "fap/result.h"
#include "tools/view/gltf/detail/json_access.h"

namespace animeme::gltf {

/// What bytes are for; players want vertex data and indices apart from the rest.
enum class BufferUse : std::uint8_t { vertices, indices, other };

/// Collects the data. Each function appends an accessor and returns its number.
class GlbBuffer {
 public:
  /// Three floats each. `bounds`: with min and max, as positions and key times need.
  int vectors(std::span<const head::Vec3> values, BufferUse use, bool bounds);
  /// `components` floats each: 1 scalar, 4 quaternion or weights' scalars (1), 16 matrix.
  int floats(std::span<const float> values, int components, BufferUse use, bool bounds = false);
  int triangles(std::span<const std::uint32_t> indices);
  /// RGB of 16 bits each, 0..1.
  int colours(std::span<const head::Vec3> values);
  /// Four bytes a vertex: numbers of joints.
  int joints(std::span<const std::uint8_t> values);
  /// `count` vectors that are 0 but at `vertices` (ascending, at least one).
  int sparse(std::size_t count, std::span<const std::uint32_t> vertices,
             std::span<const head::Vec3> values);

  /// The binary form of glTF, a header, the JSON and the data; `root` gets its buffer. Error:
  /// out_of_range (larger than 4 GB).
  Result<std::vector<std::uint8_t>> file(Json root);

  Json accessors = Json::array();
  Json views = Json::array();

 private:
  int view(const void* data, std::size_t size, BufferUse use, int stride = 0);
  int accessor(int view, int type, std::size_t count, const char* shape);

  std::vector<std::uint8_t> bytes_;
};

}  // namespace animeme::gltf

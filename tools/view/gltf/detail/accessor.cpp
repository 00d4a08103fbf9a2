#include "tools/view/gltf/detail/accessor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <string_view>

namespace animeme::gltf {
namespace {

enum class Component : std::uint16_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126,
};

struct ComponentInfo {
  std::size_t size;  // bytes
  double largest;    // what normalised numbers are divided by
};

ComponentInfo info_of(Component type) {
  constexpr ComponentInfo kInfos[] = {{1, 127}, {1, 255},          {2, 32767}, {2, 65535},
                                      {},       {4, 4294967295.0}, {4, 1}};
  return kInfos[std::size_t(type) - std::size_t(Component::int8)];
}

// `count` elements in bytes, `stride` bytes apart.
struct Block {
  std::span<const std::uint8_t> bytes;
  std::size_t stride = 0;
  Component type = Component::float32;
};

struct Layout {
  std::size_t count = 0;
  std::size_t components = 0;
  Component type = Component::float32;
  bool normalised = false;
  std::optional<Block> dense;
  std::size_t sparse_count = 0;
  Block sparse_indices;
  Block sparse_values;
};

template <class T>
T value_at(const std::uint8_t* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

double number_at(const std::uint8_t* place, Component type) {
  static_assert(std::endian::native == std::endian::little, "glTF is little-endian");
  switch (type) {
    case Component::int8:
      return value_at<std::int8_t>(place);
    case Component::uint8:
      return *place;
    case Component::int16:
      return value_at<std::int16_t>(place);
    case Component::uint16:
      return value_at<std::uint16_t>(place);
    case Component::uint32:
      return value_at<std::uint32_t>(place);
    case Component::float32:
      return double(value_at<float>(place));
  }
  return 0;
}

Error bad(std::size_t accessor, std::string_view what) {
  return make_error(Code::syntax, "accessor " + std::to_string(accessor) + " " + std::string(what) +
                                      ": export the file again");
}

std::optional<Component> component_of(const Json& value) {
  const std::size_t code = whole_or(value, 0);
  if (code < 5120 || code > 5126 || code == 5124) return std::nullopt;
  return Component(code);
}

std::size_t components_of(const std::string& type) {
  static const std::map<std::string, std::size_t> known = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  const auto found = known.find(type);
  return found == known.end() ? 0 : found->second;
}

Result<Block> block_of(const File& file, std::size_t accessor, const Json& where, Component type,
                       std::size_t components, std::size_t count) {
  const std::optional<std::size_t> view = whole(member(where, "bufferView"));
  if (!view) return bad(accessor, "has no buffer view");
  auto bytes = view_of(file, *view);
  if (!bytes) return bytes.error();
  const std::size_t element = info_of(type).size * components;
  const std::size_t stride =
      whole_or(member(file.entry("bufferViews", *view), "byteStride"), element);
  const std::size_t offset = whole_or(member(where, "byteOffset"), 0);
  // Strides beyond 252 are not allowed; 0 would be all in one place.
  if (stride < element || stride > 1000) return bad(accessor, "has a stride that cannot be");
  if (count > 0 && (offset > bytes->size() || bytes->size() - offset < element ||
                    (bytes->size() - offset - element) / stride < count - 1)) {
    return bad(accessor, "is outside its buffer view");
  }
  return Block{count > 0 ? bytes->subspan(offset) : bytes->first(0), stride, type};
}

Result<Layout> layout_of(const File& file, std::size_t accessor, std::size_t components) {
  const Json& entry = file.entry("accessors", accessor);
  const auto type = component_of(member(entry, "componentType"));
  auto count = count_of(file, accessor);
  if (!count) return count.error();
  if (!type) return bad(accessor, "has a component type that is unknown");
  Layout layout{*count, components_of(text_or(member(entry, "type"))),
                *type,  is_true(member(entry, "normalized")),
                {},     0,
                {},     {}};
  if (layout.components != components) {
    return bad(accessor, "is of type " + text_or(member(entry, "type"), "?") + ", not of " +
                             std::to_string(components) + " components");
  }
  if (!member(entry, "bufferView").is_null()) {
    auto block = block_of(file, accessor, entry, *type, components, layout.count);
    if (!block) return block.error();
    layout.dense = *block;
  }
  const Json& sparse = member(entry, "sparse");
  if (sparse.is_null()) return layout;
  layout.sparse_count = whole_or(member(sparse, "count"), 0);
  const auto index_type = component_of(member(sparse, "indices", "componentType"));
  if (!index_type || layout.sparse_count > layout.count)
    return bad(accessor, "has a bad sparse part");
  auto indices =
      block_of(file, accessor, member(sparse, "indices"), *index_type, 1, layout.sparse_count);
  if (!indices) return indices.error();
  auto values =
      block_of(file, accessor, member(sparse, "values"), *type, components, layout.sparse_count);
  if (!values) return values.error();
  layout.sparse_indices = *indices;
  layout.sparse_values = *values;
  return layout;
}

// Calls put(element, component, value) for what is given of the first `most`; the rest stays 0.
template <class Put>
Result<void> read(const File& file, std::size_t accessor, const Layout& layout, std::size_t most,
                  Put put) {
  const std::size_t dense = layout.dense ? std::min(layout.count, most) : 0;
  if (auto fine = file.budget->take_elements(dense + layout.sparse_count + 10); !fine) return fine;
  const double scale = layout.normalised ? 1 / info_of(layout.type).largest : 1;
  bool finite = true;
  const auto element = [&](const Block& block, std::size_t from, std::size_t to) {
    const std::uint8_t* place = block.bytes.data() + from * block.stride;
    for (std::size_t c = 0; c < layout.components; ++c, place += info_of(block.type).size) {
      const double value = number_at(place, block.type) * scale;
      finite = finite && std::isfinite(value);
      put(to, c, layout.normalised ? std::max(value, -1.0) : value);
    }
  };
  for (std::size_t i = 0; i < dense; ++i) element(*layout.dense, i, i);
  for (std::size_t k = 0; k < layout.sparse_count; ++k) {
    const Block& indices = layout.sparse_indices;
    const double to = number_at(indices.bytes.data() + k * indices.stride, indices.type);
    if (!(to >= 0 && to < double(layout.count))) return bad(accessor, "has a bad sparse index");
    if (to < double(most)) element(layout.sparse_values, k, std::size_t(to));
  }
  if (!finite) return bad(accessor, "has a number that is not finite");
  return {};
}

}  // namespace

Result<std::size_t> count_of(const File& file, std::size_t accessor) {
  const Json& entry = file.entry("accessors", accessor);
  if (!entry.is_object()) return bad(accessor, "does not exist");
  const std::optional<std::size_t> count = whole(member(entry, "count"));
  if (!count) return bad(accessor, "has no count");
  return *count;
}

Result<std::vector<float>> read_floats(const File& file, std::size_t accessor,
                                       std::size_t components, std::size_t most) {
  auto layout = layout_of(file, accessor, components);
  if (!layout) return layout.error();
  std::vector<float> values(std::min(layout->count, most) * components);
  auto done =
      read(file, accessor, *layout, most, [&](std::size_t element, std::size_t c, double value) {
        values[element * components + c] = float(value);
      });
  if (!done) return done.error();
  return values;
}

Result<std::vector<std::uint32_t>> read_wholes(const File& file, std::size_t accessor,
                                               std::size_t components, std::size_t most) {
  auto layout = layout_of(file, accessor, components);
  if (!layout) return layout.error();
  if (layout->type == Component::float32) return bad(accessor, "must have integers");
  std::vector<std::uint32_t> values(std::min(layout->count, most) * components);
  bool fine = true;
  auto done =
      read(file, accessor, *layout, most, [&](std::size_t element, std::size_t c, double value) {
        fine = fine && value >= 0;
        values[element * components + c] = fine ? std::uint32_t(value) : 0;
      });
  if (!done) return done.error();
  if (!fine) return bad(accessor, "has a negative index");
  return values;
}

Result<Moves> read_moves(const File& file, std::size_t accessor, std::size_t vertices) {
  auto layout = layout_of(file, accessor, 3);
  if (!layout) return layout.error();
  if (layout->count != vertices) return bad(accessor, "does not have a move for each vertex");
  const bool listed = !layout->dense;
  std::map<std::size_t, head::Vec3> few;
  std::vector<head::Vec3> all(listed ? 0 : vertices);
  auto done =
      read(file, accessor, *layout, vertices, [&](std::size_t vertex, std::size_t c, double value) {
        head::Vec3& move = listed ? few[vertex] : all[vertex];
        (c == 0 ? move.x : c == 1 ? move.y : move.z) = float(value);
      });
  if (!done) return done.error();
  const auto is_move = [](head::Vec3 move) { return !(move == head::Vec3{}); };
  const std::size_t count =
      listed ? few.size() : std::size_t(std::count_if(all.begin(), all.end(), is_move));
  if (auto fine = file.budget->take_moves(count); !fine) return fine.error();
  Moves moves;
  moves.vertices.reserve(count);
  moves.deltas.reserve(count);
  const auto add = [&](std::size_t vertex, head::Vec3 move) {
    if (!is_move(move)) return;
    moves.vertices.push_back(std::uint32_t(vertex));
    moves.deltas.push_back(move);
  };
  for (const auto& [vertex, move] : few) add(vertex, move);
  for (std::size_t v = 0; v < all.size(); ++v) add(v, all[v]);
  return moves;
}

}  // namespace animeme::gltf

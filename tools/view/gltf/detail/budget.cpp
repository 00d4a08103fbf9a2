#include "tools/view/gltf/detail/budget.h"

#include <algorithm>

namespace animeme::gltf {
namespace {

constexpr std::size_t kLeast = 100;
constexpr std::size_t kTrianglesOfVertex = 4;
constexpr std::size_t kElementsOfVertex = 400;
constexpr std::size_t kMostValues = 1'000'000;

Result<void> take_from(std::size_t& left, std::size_t count, std::size_t limit, const char* things,
                       const char* remedy) {
  if (count <= left) {
    left -= count;
    return {};
  }
  return make_error(Code::out_of_range, "the file has more than " + million_text(limit) + " " +
                                            things + ", the most that are read: " + remedy);
}

}  // namespace

std::string million_text(std::size_t count) {
  constexpr std::size_t kMillion = 1'000'000;
  if (count < kMillion || count % (kMillion / 10) != 0) return std::to_string(count);
  const std::size_t tenths = count / (kMillion / 10) % 10;
  return std::to_string(count / kMillion) + (tenths > 0 ? "." + std::to_string(tenths) : "") +
         " million";
}

Budget::Budget(const ReadLimits& limits)
    : limits_(limits),
      left_(limits),
      triangles_(limits.vertices * kTrianglesOfVertex),
      elements_(limits.vertices * kElementsOfVertex) {}

Result<void> Budget::take_bytes(std::size_t count) {
  return take_from(left_.bytes, count, limits_.bytes, "bytes in its referenced files",
                   "leave out what is not the head");
}

Result<void> Budget::take_vertices(std::size_t count) {
  return take_from(left_.vertices, std::max(count, kLeast), limits_.vertices,
                   "vertices (as often as they are shown, and 100 a mesh at least)",
                   "reduce the meshes");
}

Result<void> Budget::take_triangles(std::size_t count) {
  return take_from(triangles_, count, limits_.vertices * kTrianglesOfVertex, "triangles",
                   "reduce the meshes");
}

Result<void> Budget::take_moves(std::size_t count) {
  return take_from(left_.moves, std::max(count, kLeast), limits_.moves,
                   "moves of vertices by morph targets",
                   "reduce the meshes, or leave out shapes that the face does not need");
}

Result<void> Budget::take_texels(std::size_t count) {
  return take_from(left_.texels, count, limits_.texels, "texels in all its pictures",
                   "make them smaller");
}

Result<void> Budget::take_elements(std::size_t count) {
  return take_from(elements_, count, limits_.vertices * kElementsOfVertex,
                   "numbers in its accessors (as often as they are used)", "reduce the meshes");
}

Result<void> check_values(std::string_view json) {
  std::size_t count = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') in_text = !in_text;
    if (in_text) {
      i += c == '\\' ? 1 : 0;
    } else {
      count += c == ',' || c == '[' || c == '{' ? 1 : 0;
    }
  }
  if (count <= kMostValues) return {};
  return make_error(Code::out_of_range, "the JSON of the file has more than " +
                                            million_text(kMostValues) +
                                            " values, the most that are read: leave out what is "
                                            "not the head, and lists of numbers in \"extras\"");
}

}  // namespace animeme::gltf

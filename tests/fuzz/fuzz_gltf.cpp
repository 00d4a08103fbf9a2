// Any bytes as a glTF file; what is accepted must be whole, and a head or an error. What has a zero
// byte and does not begin as .glb is cut there into JSON and buffer and tried as a .glb whose
// lengths are right, else hardly any would get beyond these.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "fap/head/own_head.h"
#include "fap/head/rig.h"
#include "tests/fuzz/require.h"
#include "tools/view/gltf/detail/file_edit.h"
#include "tools/view/gltf/read_head.h"

using animeme::test::require;

namespace {

using animeme::head::Source;
using animeme::head::Vec3;

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check(const Source& source) {
  for (const auto& piece : source.pieces) {
    const std::size_t count = piece.mesh.positions.size();
    for (const Vec3& p : piece.mesh.positions) require(finite(p));
    for (const auto& t : piece.mesh.triangles) {
      for (const std::uint32_t v : t) require(v < count);
    }
    require(piece.mesh.colours.empty() || piece.mesh.colours.size() == count);
    require(piece.neck_weights.empty() || piece.neck_weights.size() == count);
    const animeme::head::Mesh& mesh = piece.mesh;
    require(source.materials.empty() ? mesh.facets.empty()
                                     : mesh.facets.size() >= mesh.triangles.size());
    require(mesh.materials.size() == mesh.facets.size());
    for (const std::uint16_t material : mesh.materials) require(material < source.materials.size());
    for (const auto& t : mesh.facets) {
      for (const std::uint32_t corner : t) require(corner < mesh.corners.size());
    }
    for (const auto& corner : mesh.corners) {
      require(corner.vertex < count && finite(corner.normal));
      require(std::abs(corner.uv.u) < 1e7f && std::abs(corner.uv.v) < 1e7f);
    }
  }
  for (const auto& point : source.points) {
    require(point.piece < source.pieces.size());
    require(point.vertex < source.pieces[point.piece].mesh.positions.size());
  }
  for (const auto& target : source.targets) {
    require(target.piece < source.pieces.size());
    require(target.vertices.size() == target.deltas.size());
    require(target.control >= animeme::head::kFirstShape);
    require(std::size_t(target.control - animeme::head::kFirstShape) < source.shapes.size());
    for (std::size_t i = 0; i < target.vertices.size(); ++i) {
      require(target.vertices[i] < source.pieces[target.piece].mesh.positions.size());
      require(i == 0 || target.vertices[i] > target.vertices[i - 1]);
      require(finite(target.deltas[i]));
    }
  }
}

// One in a thousand inputs, always the same ones, becomes a head: that takes as long as reading
// some hundred.
bool becomes_a_head(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 2166136261u;
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 16777619u;
  return sum % 1000 == 0;
}

// What grows can be read again, and is longer by what was added.
void write_back(std::span<const std::uint8_t> bytes) {
  using animeme::gltf::FileEdit;
  using animeme::gltf::Json;
  auto edit = FileEdit::open(bytes, {});
  if (!edit) return;
  const std::vector<float> values = {1, 2, 3};
  const std::size_t accessor = edit->floats(values, "SCALAR", true);
  const std::size_t animation = edit->add("animations", {{"name", "x"}});
  edit->add_to_extension("X", "list", 1);
  if (!animeme::gltf::list(edit->file().root, "scenes").empty()) {
    edit->add_to_scene(0, "X", "list", 1);
  }
  edit->replace_matrix(0, "\"scale\":[1,1,1]");
  edit->use("X");
  const auto file = edit->finish();
  if (!file) return;
  std::vector<std::uint8_t> whole = file->front;
  whole.insert(whole.end(), file->middle.begin(), file->middle.end());
  whole.insert(whole.end(), file->back.begin(), file->back.end());
  const auto again = FileEdit::open(whole, {});
  require(again || again.error().code == animeme::Code::out_of_range);
  if (!again) return;
  const Json& root = again->file().root;
  require(animeme::gltf::list(root, "accessors").size() == accessor + 1);
  require(animeme::gltf::list(root, "animations").size() == animation + 1);
  require(animeme::gltf::list(root, "animations").back() == Json{{"name", "x"}});
  require(again->file().uses("X"));
}

// With colours at `vertices`, or with materials (0).
void read_as(std::span<const std::uint8_t> bytes, std::size_t vertices, bool assembled) {
  auto source = animeme::gltf::read_head(
      bytes, {.vertices = vertices,
              .limits = {.bytes = 1'000'000, .texels = 10'000, .vertices = 5000, .moves = 20'000}});
  if (!source) return;
  check(*source);
  if (!assembled) return;
  for (auto& piece : source->pieces) {
    // Looking for shadows would take most of the time.
    piece.mesh.occlusion.assign(piece.mesh.positions.size(), 1);
  }
  const bool shapes = !source->shapes.empty();
  const auto head = animeme::head::assemble(std::move(*source));
  if (!head || !shapes) return;
  animeme::fap::Frame frame;
  frame.set(3, 500);
  (void)animeme::head::pose(animeme::head::make_rig(*head), frame);
}

void try_file(std::span<const std::uint8_t> bytes) {
  write_back(bytes);
  const bool assembled = becomes_a_head(bytes);
  for (const std::size_t vertices : {100, 0}) read_as(bytes, vertices, assembled);
}

void put(std::vector<std::uint8_t>& file, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) file.push_back(std::uint8_t(word >> (8 * i)));
}

std::vector<std::uint8_t> sealed(std::span<const std::uint8_t> bytes) {
  std::size_t end = 0;
  while (end < bytes.size() && bytes[end] != 0) ++end;
  const auto json = bytes.first(end);
  const auto binary = bytes.subspan(std::min(end + 1, bytes.size()));
  std::vector<std::uint8_t> file;
  put(file, 0x46546C67);
  put(file, 2);
  put(file, std::uint32_t(28 + json.size() + binary.size()));
  put(file, std::uint32_t(json.size()));
  put(file, 0x4E4F534A);
  file.insert(file.end(), json.begin(), json.end());
  put(file, std::uint32_t(binary.size()));
  put(file, 0x004E4942);
  file.insert(file.end(), binary.begin(), binary.end());
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const bool on_disk = size >= 4 && std::memcmp(data, "glTF", 4) == 0;
  if (on_disk || std::find(bytes.begin(), bytes.end(), 0) == bytes.end()) {
    try_file(bytes);
  } else {
    try_file(sealed(bytes));
  }
  return 0;
}

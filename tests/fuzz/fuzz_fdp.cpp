// Any bytes as a face definition file or as a mesh: an answer without a crash, and what was read
// holds together. The first byte chooses: VRML97, XMT-A, or an .fdp, after a zero byte with its
// mesh (VRML97 or OBJ), after another one with all its textures (TGA).
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "fap/head/wrl.h"
#include "fap/xml/fdp.h"
#include "fap/xml/xmt.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;

void check(const std::vector<head::Piece>& pieces) {
  require(!pieces.empty());
  for (const head::Piece& piece : pieces) {
    const std::size_t count = piece.mesh.positions.size();
    require(piece.mesh.colours.empty() || piece.mesh.colours.size() == count);
    for (const head::Triangle& t : piece.mesh.triangles) {
      for (const std::uint32_t v : t) require(v < count);
    }
  }
}

void check(const head::Source& source) {
  check(source.pieces);
  for (const head::PiecePoint& point : source.points) {
    require(point.piece < source.pieces.size());
    require(point.vertex < source.pieces[point.piece].mesh.positions.size());
  }
  for (const head::PieceTarget& target : source.targets) {
    require(target.control >= fap::kFirstLowLevel && target.control <= fap::kFapCount);
    require(target.piece < source.pieces.size());
    require(target.vertices.size() == target.deltas.size());
    require(std::is_sorted(target.vertices.begin(), target.vertices.end()));
    require(target.vertices.back() < source.pieces[target.piece].mesh.positions.size());
  }
  const auto head = head::assemble(source);
  require(head.has_value() || !head.error().message.empty());
}

void run_wrl(std::string_view text) {
  std::vector<std::string> notes;
  const auto pieces = head::read_wrl(text, &notes);
  if (!pieces) return require(!pieces.error().message.empty());
  check(*pieces);
  const auto again = head::read_wrl(head::write_wrl(*pieces));
  require(again.has_value() || again.error().code == Code::out_of_range);  // beyond float
  if (again) require(again->size() == pieces->size());
}

void run_xmt(std::string_view text) {
  const auto source = head::read_xmt(text);
  if (!source) return require(!source.error().message.empty());
  check(*source);
}

void run_fdp(std::string_view text) {
  const std::size_t end = std::min(text.find('\0'), text.size());
  const std::string_view rest = text.substr(std::min(end + 1, text.size()));
  const std::size_t mesh_end = std::min(rest.find('\0'), rest.size());
  const auto load = [&](const std::string& name) -> Result<std::string> {
    if (!name.ends_with(".tga")) return std::string(rest.substr(0, mesh_end));
    return std::string(rest.substr(std::min(mesh_end + 1, rest.size())));
  };
  const auto source = head::read_fdp(text.substr(0, end), load);
  if (!source) return require(!source.error().message.empty());
  check(*source);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      run_wrl(text);
      break;
    case 1:
      run_xmt(text);
      break;
    default:
      run_fdp(text);
  }
  return 0;
}

#include "tools/view/gltf/detail/vertex_keys.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace animeme::gltf {
namespace {

// 128 bits stand for all that has to agree.
struct Key {
  std::uint64_t a = 0x9E3779B97F4A7C15;
  std::uint64_t b = 0xC2B2AE3D27D4EB4F;

  void add(std::uint32_t word) {
    a = std::rotl((a ^ word) * 0xFF51AFD7ED558CCD, 29);
    b = std::rotl((b + word) * 0x9FB21C651E98DF25, 31) ^ (b >> 7);
  }
  // 0 and -0 are the same place.
  void add(float value) { add(std::bit_cast<std::uint32_t>(value + 0.0f)); }
  void add(head::Vec3 v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  friend auto operator<=>(const Key&, const Key&) = default;
};

std::vector<Key> keys_of(const RawPiece& piece) {
  std::vector<Key> keys(piece.positions.size());
  for (std::size_t v = 0; v < keys.size(); ++v) {
    keys[v].add(piece.positions[v]);
    if (!piece.neck_weights.empty()) keys[v].add(piece.neck_weights[v]);
  }
  for (const PieceMorph& morph : piece.morphs) {
    for (std::size_t i = 0; i < morph.moves.vertices.size(); ++i) {
      Key& key = keys[morph.moves.vertices[i]];
      key.add(std::uint32_t(morph.shape));
      key.add(morph.moves.deltas[i]);
    }
  }
  return keys;
}

// New numbers of the vertices that stay; ~0 for the others.
std::vector<std::uint32_t> numbers_of(const RawPiece& piece,
                                      const std::vector<std::uint32_t>& first) {
  std::vector<std::uint32_t> numbers(first.size(), ~0u);
  for (const auto* triangles : {&piece.triangles, &piece.transparent}) {
    for (const head::Triangle& t : *triangles) {
      for (const std::uint32_t v : t) numbers[first[v]] = 0;
    }
  }
  std::uint32_t next = 0;
  for (std::uint32_t& number : numbers) {
    if (number == 0) number = next++;
  }
  return numbers;
}

// Triangles as they are drawn: each vertex of the file is a corner.
class Facets {
 public:
  explicit Facets(const RawPiece& from) : from_(from), numbers_(from.corners.size(), ~0u) {}

  /// `t`: in the piece as it was; `to`: in `out`.
  void add(const head::Triangle& t, const head::Triangle& to, std::uint16_t material,
           RawPiece& out) {
    head::Triangle facet{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& number = numbers_[t[k]];
      if (number == ~0u) {
        number = std::uint32_t(out.corners.size());
        out.corners.push_back(from_.corners[t[k]]);
        out.corners.back().vertex = to[k];
      }
      facet[k] = number;
    }
    out.facets.push_back(facet);
    out.materials.push_back(material);
  }

 private:
  const RawPiece& from_;
  std::vector<std::uint32_t> numbers_;  // of corners in what is made
};

void renumber(Moves& moves, const std::vector<std::uint32_t>& first,
              const std::vector<std::uint32_t>& numbers) {
  Moves kept;
  for (std::size_t i = 0; i < moves.vertices.size(); ++i) {
    const std::uint32_t v = moves.vertices[i];
    if (first[v] != v || numbers[v] == ~0u) continue;
    kept.vertices.push_back(numbers[v]);
    kept.deltas.push_back(moves.deltas[i]);
  }
  moves = std::move(kept);
}

}  // namespace

std::vector<std::uint32_t> first_alike(const RawPiece& piece) {
  const std::vector<Key> keys = keys_of(piece);
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    return keys[x] != keys[y] ? keys[x] < keys[y] : x < y;
  });
  std::vector<std::uint32_t> first(keys.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool again = i > 0 && keys[order[i]] == keys[order[i - 1]];
    first[order[i]] = again ? first[order[i - 1]] : order[i];
  }
  return first;
}

void weld(RawPiece& piece) {
  const std::vector<std::uint32_t> first = first_alike(piece);
  const std::vector<std::uint32_t> numbers = numbers_of(piece, first);
  RawPiece out;
  out.face = piece.face;
  out.node = piece.node;
  out.name = std::move(piece.name);
  out.paint = piece.paint;
  std::vector<float> counts;
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (first[v] != v || numbers[v] == ~0u) continue;
    out.positions.push_back(piece.positions[v]);
    if (!piece.neck_weights.empty()) out.neck_weights.push_back(piece.neck_weights[v]);
  }
  if (!piece.colours.empty()) {
    out.colours.assign(out.positions.size(), {{0, 0, 0}, 0});
    counts.assign(out.positions.size(), 0);
    for (std::size_t v = 0; v < first.size(); ++v) {
      const std::uint32_t to = numbers[first[v]];
      if (to == ~0u) continue;
      out.colours[to].rgb += piece.colours[v].rgb;
      out.colours[to].alpha += piece.colours[v].alpha;
      counts[to] += 1;
    }
    for (std::size_t v = 0; v < counts.size(); ++v) {
      out.colours[v].rgb *= 1 / counts[v];
      out.colours[v].alpha /= counts[v];
    }
  }
  Facets facets(piece);
  for (std::size_t i = 0; i < piece.triangles.size() + piece.transparent.size(); ++i) {
    const bool solid = i < piece.triangles.size();
    const head::Triangle& t =
        solid ? piece.triangles[i] : piece.transparent[i - piece.triangles.size()];
    const head::Triangle to = {numbers[first[t[0]]], numbers[first[t[1]]], numbers[first[t[2]]]};
    if (to[0] == to[1] || to[1] == to[2] || to[2] == to[0]) continue;
    if (solid) out.triangles.push_back(to);
    if (!piece.materials.empty()) facets.add(t, to, piece.materials[i], out);
  }
  for (std::size_t v = 0; v < piece.numbers.size(); ++v) {
    const std::uint32_t to = numbers[first[v]];
    if (piece.numbers[v] != kNewVertex && to != ~0u) {
      out.file_vertices.push_back({piece.numbers[v], to});
    }
  }
  std::sort(out.file_vertices.begin(), out.file_vertices.end(),
            [](const FileVertex& a, const FileVertex& b) { return a.number < b.number; });
  out.morphs = std::move(piece.morphs);
  for (PieceMorph& morph : out.morphs) renumber(morph.moves, first, numbers);
  std::erase_if(out.morphs, [](const PieceMorph& morph) { return morph.moves.vertices.empty(); });
  piece = std::move(out);
}

}  // namespace animeme::gltf

#include "tools/view/gltf/detail/refine.h"

#include <algorithm>
#include <limits>
#include <map>

#include "tools/view/gltf/detail/paint.h"
#include "tools/view/gltf/detail/vertex_keys.h"

namespace animeme::gltf {
namespace {

using head::Triangle;
using head::Vec3;

constexpr int kMostPasses = 6;
// Differences of colour that are not seen, on a scale that is about as the eye sees (root of the
// linear value).
constexpr float kSeen = 0.03f;
// Edges shorter than this share of the height of the face stay: about half a millimetre.
constexpr float kShortest = 0.0025f;
constexpr double kFewTexels = 1.5;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(std::uint32_t a, std::uint32_t b) { return a < b ? Edge{a, b} : Edge{b, a}; }

struct Box {
  Vec3 low = Vec3{1, 1, 1} * std::numeric_limits<float>::infinity();
  Vec3 high = Vec3{1, 1, 1} * -std::numeric_limits<float>::infinity();

  void add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool empty() const { return !(low.x <= high.x); }
  bool holds(Vec3 p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
  float size() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

Box face_of(const std::vector<RawPiece>& pieces) {
  Box box;
  for (const RawPiece& piece : pieces) {
    for (const PieceMorph& morph : piece.morphs) {
      for (const std::uint32_t v : morph.moves.vertices) box.add(piece.positions[v]);
    }
  }
  if (!box.empty()) return box;
  for (const RawPiece& piece : pieces) {
    for (const Vec3& p : piece.positions) box.add(p);
  }
  return box;
}

Vec3 seen(Vec3 rgb) { return {std::sqrt(rgb.x), std::sqrt(rgb.y), std::sqrt(rgb.z)}; }

// How far a straight line between the colours of two vertices is from the texture.
float error_of(const RawPiece& piece, std::uint32_t a, std::uint32_t b) {
  const Paint& paint = *piece.paint;
  const Uv from = piece.uvs[a], to = piece.uvs[b];
  const double texels = paint.texels(from, to);
  if (texels < kFewTexels) return 0;
  const auto at = [&](float t) {
    return paint.at({from.u + (to.u - from.u) * t, from.v + (to.v - from.v) * t}, texels / 4);
  };
  const Colour first = at(0), last = at(1);
  float worst = 0;
  for (const float t : {0.25f, 0.5f, 0.75f}) {
    const Colour is = at(t);
    const Vec3 off = seen(is.rgb) - seen(head::mix(first.rgb, last.rgb, t));
    const float alpha = is.alpha - (first.alpha + (last.alpha - first.alpha) * t);
    worst = std::max({worst, std::abs(off.x), std::abs(off.y), std::abs(off.z), std::abs(alpha)});
  }
  return worst;
}

struct Candidate {
  float worth;
  std::size_t piece;
  Edge edge;  // of vertices that stand for all alike
};

// Edges that are to be divided.
class Marks {
 public:
  explicit Marks(const RawPiece& piece) : piece_(piece), first_(first_alike(piece)) {}

  Edge key(std::uint32_t a, std::uint32_t b) const { return edge_of(first_[a], first_[b]); }
  bool has(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(edges_.begin(), edges_.end(), key(a, b));
  }
  void add(std::vector<Edge> edges) {
    edges_.insert(edges_.end(), edges.begin(), edges.end());
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  }
  bool empty() const { return edges_.empty(); }

  // A triangle that is divided is divided along its longest edge, too: else slivers come.
  void add_longest() {
    for (int round = 0; round < 8; ++round) {
      std::vector<Edge> more;
      for (const Triangle& t : piece_.triangles) {
        if (!has(t[0], t[1]) && !has(t[1], t[2]) && !has(t[2], t[0])) continue;
        std::size_t longest = 0;
        for (std::size_t i = 1; i < 3; ++i) {
          if (square(t, i) > square(t, longest) * 1.001f) longest = i;
        }
        const std::uint32_t a = t[longest], b = t[(longest + 1) % 3];
        if (!has(a, b)) more.push_back(key(a, b));
      }
      if (more.empty()) return;
      add(std::move(more));
    }
  }

 private:
  float square(const Triangle& t, std::size_t side) const {
    const Vec3 d = piece_.positions[t[side]] - piece_.positions[t[(side + 1) % 3]];
    return head::dot(d, d);
  }

  const RawPiece& piece_;
  std::vector<std::uint32_t> first_;
  std::vector<Edge> edges_;  // sorted
};

std::vector<Candidate> candidates_of(const RawPiece& piece, std::size_t number, const Marks& marks,
                                     const Box& face) {
  std::map<Edge, float> worth;
  const float shortest = face.size() * kShortest;
  for (const Triangle& t : piece.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      const Vec3 middle = (piece.positions[a] + piece.positions[b]) * 0.5f;
      const float length = head::length(piece.positions[a] - piece.positions[b]);
      if (length < shortest || !face.holds(middle)) continue;
      const float error = error_of(piece, std::min(a, b), std::max(a, b));
      if (error < kSeen) continue;
      float& known = worth[marks.key(a, b)];
      known = std::max(known, error * length);
    }
  }
  std::vector<Candidate> out;
  for (const auto& [edge, value] : worth) out.push_back({value, number, edge});
  return out;
}

// The middles of divided edges, by the vertices of the file: each side of a seam has its own.
class Divider {
 public:
  Divider(RawPiece& piece, const Marks& marks) : piece_(piece), marks_(marks) {}

  void divide() {
    std::vector<Triangle> triangles;
    for (const Triangle& t : piece_.triangles) split(t, triangles);
    piece_.triangles = std::move(triangles);
    for (PieceMorph& morph : piece_.morphs) extend(morph.moves);
  }

 private:
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const Edge edge = edge_of(a, b);
    const auto [place, is_new] = middles_.try_emplace(edge, std::uint32_t(piece_.positions.size()));
    if (!is_new) return place->second;
    const auto [low, high] = edge;
    piece_.positions.push_back((piece_.positions[low] + piece_.positions[high]) * 0.5f);
    const Uv u = piece_.uvs[low], v = piece_.uvs[high];
    piece_.uvs.push_back({(u.u + v.u) / 2, (u.v + v.v) / 2});
    if (!piece_.colours.empty()) {
      const Colour c = piece_.colours[low], d = piece_.colours[high];
      piece_.colours.push_back({(c.rgb + d.rgb) * 0.5f, (c.alpha + d.alpha) / 2});
    }
    if (!piece_.neck_weights.empty()) {
      piece_.neck_weights.push_back((piece_.neck_weights[low] + piece_.neck_weights[high]) / 2);
    }
    piece_.numbers.push_back(kNewVertex);
    made_.push_back(edge);
    return place->second;
  }

  void split(Triangle t, std::vector<Triangle>& out) {
    const auto marked = [&](std::size_t i) { return marks_.has(t[i % 3], t[(i + 1) % 3]); };
    const int count = int(marked(0)) + int(marked(1)) + int(marked(2));
    if (count == 0) return out.push_back(t);
    // Turned so that the first edge is divided, and of two the first and the second.
    while (!(marked(0) && (count != 2 || marked(1)))) t = {t[1], t[2], t[0]};
    const std::uint32_t m = middle(t[0], t[1]);
    if (count == 1) {
      out.insert(out.end(), {Triangle{t[0], m, t[2]}, Triangle{m, t[1], t[2]}});
      return;
    }
    const std::uint32_t n = middle(t[1], t[2]);
    out.push_back({m, t[1], n});
    if (count == 2) {
      out.insert(out.end(), {Triangle{t[0], m, n}, Triangle{t[0], n, t[2]}});
      return;
    }
    const std::uint32_t o = middle(t[2], t[0]);
    out.insert(out.end(), {Triangle{t[0], m, o}, Triangle{o, n, t[2]}, Triangle{m, n, o}});
  }

  // Moves of the middles: their numbers are the largest, so the list stays sorted.
  void extend(Moves& moves) const {
    const std::size_t old = piece_.positions.size() - made_.size();
    std::vector<std::uint32_t> at(old, ~0u);
    for (std::size_t i = 0; i < moves.vertices.size(); ++i) {
      at[moves.vertices[i]] = std::uint32_t(i);
    }
    const auto move = [&](std::uint32_t v) { return at[v] == ~0u ? Vec3{} : moves.deltas[at[v]]; };
    for (std::size_t i = 0; i < made_.size(); ++i) {
      const Vec3 delta = (move(made_[i].first) + move(made_[i].second)) * 0.5f;
      if (delta == Vec3{}) continue;
      moves.vertices.push_back(std::uint32_t(old + i));
      moves.deltas.push_back(delta);
    }
  }

  RawPiece& piece_;
  const Marks& marks_;
  std::map<Edge, std::uint32_t> middles_;
  std::vector<Edge> made_;
};

}  // namespace

void refine(std::vector<RawPiece>& pieces, std::size_t vertices) {
  const Box face = face_of(pieces);
  if (face.empty()) return;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    std::size_t count = 0;
    for (const RawPiece& piece : pieces) {
      for (const Vec3& p : piece.positions) count += face.holds(p);
    }
    if (count >= vertices) return;
    std::vector<Marks> marks;
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      marks.emplace_back(pieces[i]);
      if (!has_texture(pieces[i])) continue;
      const auto more = candidates_of(pieces[i], i, marks.back(), face);
      candidates.insert(candidates.end(), more.begin(), more.end());
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
    candidates.resize(std::min(candidates.size(), (vertices - count) / 2 + 1));
    std::vector<std::vector<Edge>> chosen(pieces.size());
    for (const Candidate& c : candidates) chosen[c.piece].push_back(c.edge);
    bool any = false;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (chosen[i].empty()) continue;
      marks[i].add(std::move(chosen[i]));
      marks[i].add_longest();
      Divider(pieces[i], marks[i]).divide();
      any = true;
    }
    if (!any) return;
  }
}

}  // namespace animeme::gltf

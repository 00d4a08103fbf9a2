#include "tools/view/gltf/detail/brow_clearance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace animeme::gltf {
namespace {

using head::Triangle;
using head::Vec3;

constexpr double kBrowHidden = 0.05;  // share of the brows that is told of

// Shares of the distance between the eyes.
constexpr float kBrowUpon = 0.1f;       // what is nearer to the skin lies upon it
constexpr float kBrowEnough = 0.02f;    // in front of the skin
constexpr float kBrowFarthest = 0.15f;  // a move forwards
constexpr float kBrowMargin = 0.6f;     // around brows, for skin that they may come to lie upon
constexpr float kBrowSeen = 1e-4f;      // a smaller change is none

constexpr std::size_t kBrowManyTriangles = 4000;  // brows of single hairs: fewer samples of each

/// A place on a triangle of a brow, by shares of its corners.
struct BrowSample {
  Triangle corners;
  std::array<float, 3> share;
  float wanted;  // distance to the skin
};

/// Skin below a region that is looked at along -Z, in cells.
class SkinBelow {
 public:
  static constexpr int kCells = 48;

  SkinBelow(Vec3 low, Vec3 high) : low_(low) {
    const float width = std::max(high.x - low.x, 1e-6f), height = std::max(high.y - low.y, 1e-6f);
    per_x_ = kCells / width;
    per_y_ = kCells / height;
    cells_.resize(std::size_t(kCells) * kCells);
  }

  void add(const std::array<Vec3, 3>& triangle) {
    const auto [a, b, c] = triangle;
    const int x0 = column(std::min({a.x, b.x, c.x})), x1 = column(std::max({a.x, b.x, c.x}));
    const int y0 = row(std::min({a.y, b.y, c.y})), y1 = row(std::max({a.y, b.y, c.y}));
    for (int y = std::max(y0, 0); y <= std::min(y1, kCells - 1); ++y) {
      for (int x = std::max(x0, 0); x <= std::min(x1, kCells - 1); ++x)
        cells_[std::size_t(y * kCells + x)].push_back(triangle);
    }
  }

  /// How far a place is in front of the foremost skin within `reach` of it; nothing: there is none.
  std::optional<float> clearance(Vec3 p, float reach) const {
    const int x = column(p.x), y = row(p.y);
    if (x < 0 || y < 0 || x >= kCells || y >= kCells) return std::nullopt;
    std::optional<float> found;
    for (const auto& [a, b, c] : cells_[std::size_t(y * kCells + x)]) {
      const float all = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
      if (!(std::abs(all) > 0)) continue;
      const float second = ((p.x - a.x) * (c.y - a.y) - (c.x - a.x) * (p.y - a.y)) / all;
      const float third = ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y)) / all;
      constexpr float kEdge = -1e-4f;
      if (second < kEdge || third < kEdge || second + third > 1 - kEdge) continue;
      const float front = p.z - (a.z + second * (b.z - a.z) + third * (c.z - a.z));
      if (std::abs(front) <= reach && (!found || front < *found)) found = front;
    }
    return found;
  }

 private:
  int column(float x) const {
    return int(std::floor(std::clamp((x - low_.x) * per_x_, -1e6f, 1e6f)));
  }
  int row(float y) const { return int(std::floor(std::clamp((y - low_.y) * per_y_, -1e6f, 1e6f))); }

  Vec3 low_;
  float per_x_ = 0, per_y_ = 0;
  std::vector<std::vector<std::array<Vec3, 3>>> cells_;
};

/// Keeps one piece of brows in front of the skin.
class BrowKeeper {
 public:
  BrowKeeper(RawPiece& brows, const FaceShapes& face, float eye_distance)
      : brows_(brows), face_(face), unit_(eye_distance) {
    low_ = high_ = brows.positions.front();
    for (const Vec3& p : brows.positions) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
    }
    const Vec3 around = Vec3{1, 1, 1} * (kBrowMargin * unit_);
    low_ -= around;
    high_ += around;
    for (const RawPiece& piece : face.pieces) {
      if (part_of(piece) != head::Part::skin) continue;
      for (const Triangle& t : piece.triangles) {
        if (within(piece.positions[t[0]]) || within(piece.positions[t[1]]) ||
            within(piece.positions[t[2]])) {
          skin_.push_back({&piece, t});
        }
      }
    }
    take_samples();
  }

  /// Changes the shapes; their indices.
  std::set<std::size_t> keep() {
    std::set<std::size_t> changed;
    if (samples_.empty()) return changed;
    for (PieceMorph& morph : brows_.morphs) {
      const std::size_t shape = face_.shape_of_name[morph.shape];
      if (shape != kNone && lift(morph, shape)) changed.insert(shape);
    }
    return changed;
  }

 private:
  struct SkinTriangle {
    const RawPiece* piece;
    Triangle corners;
  };

  bool within(Vec3 p) const {
    return p.x >= low_.x && p.x <= high_.x && p.y >= low_.y && p.y <= high_.y && p.z >= low_.z &&
           p.z <= high_.z;
  }

  // With a shape at weight 1; kNone: at rest.
  SkinBelow skin_with(std::size_t shape) const {
    std::map<const RawPiece*, std::map<std::uint32_t, Vec3>> moved;
    for (const RawPiece& piece : face_.pieces) {
      if (shape == kNone || part_of(piece) != head::Part::skin) continue;
      for (const PieceMorph& morph : piece.morphs) {
        if (face_.shape_of_name[morph.shape] != shape) continue;
        for (std::size_t i = 0; i < morph.moves.vertices.size(); ++i) {
          const std::uint32_t v = morph.moves.vertices[i];
          if (within(piece.positions[v])) moved[&piece][v] += morph.moves.deltas[i];
        }
      }
    }
    SkinBelow below(low_, high_);
    for (const SkinTriangle& one : skin_) {
      const auto moves = moved.find(one.piece);
      std::array<Vec3, 3> places;
      for (std::size_t k = 0; k < 3; ++k) {
        places[k] = one.piece->positions[one.corners[k]];
        if (moves == moved.end()) continue;
        const auto move = moves->second.find(one.corners[k]);
        if (move != moves->second.end()) places[k] += move->second;
      }
      below.add(places);
    }
    return below;
  }

  void take_samples() {
    std::vector<Triangle> triangles = brows_.triangles;
    if (!brows_.facets.empty()) {
      triangles.clear();
      for (const Triangle& t : brows_.facets) {
        triangles.push_back({brows_.corners[t[0]].vertex, brows_.corners[t[1]].vertex,
                             brows_.corners[t[2]].vertex});
      }
    }
    const SkinBelow skin = skin_with(kNone);
    const int steps = triangles.size() > kBrowManyTriangles ? 1 : 4;
    for (const Triangle& t : triangles) {
      for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) {
          const float a = float(i) / float(steps), b = float(j) / float(steps);
          const BrowSample sample{t, {a, b, 1 - a - b}, 0};
          const auto front = skin.clearance(place(sample, brows_.positions), kBrowUpon * unit_);
          if (!front || *front <= 0) continue;
          samples_.push_back({t, sample.share, std::min(*front, kBrowEnough * unit_)});
        }
      }
    }
  }

  static Vec3 place(const BrowSample& sample, const std::vector<Vec3>& positions) {
    Vec3 p;
    for (std::size_t k = 0; k < 3; ++k) p += positions[sample.corners[k]] * sample.share[k];
    return p;
  }

  // True: the shape had hidden some of the brows.
  bool lift(PieceMorph& morph, std::size_t shape) const {
    const SkinBelow skin = skin_with(shape);
    std::vector<Vec3> shown = brows_.positions;
    for (std::size_t i = 0; i < morph.moves.vertices.size(); ++i)
      shown[morph.moves.vertices[i]] += morph.moves.deltas[i];
    std::map<std::uint32_t, float> lifts;
    std::size_t hidden_samples = 0;
    for (const BrowSample& sample : samples_) {
      const auto front = skin.clearance(place(sample, shown), kBrowFarthest * unit_);
      if (!front || *front >= sample.wanted - kBrowSeen * unit_) continue;
      hidden_samples += *front <= 0 ? 1 : 0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (sample.share[k] <= 0) continue;
        float& most = lifts[sample.corners[k]];
        most = std::max(most, std::min(sample.wanted - *front, kBrowFarthest * unit_));
      }
    }
    const bool hidden = double(hidden_samples) > kBrowHidden * double(samples_.size());
    for (std::size_t i = 0; i < morph.moves.vertices.size(); ++i) {
      const auto found = lifts.find(morph.moves.vertices[i]);
      if (found == lifts.end()) continue;
      morph.moves.deltas[i].z += found->second;
      lifts.erase(found);
    }
    if (lifts.empty()) return hidden;
    // Vertices that the shape did not move; their numbers have to ascend.
    std::map<std::uint32_t, Vec3> all;
    for (std::size_t i = 0; i < morph.moves.vertices.size(); ++i)
      all[morph.moves.vertices[i]] += morph.moves.deltas[i];
    for (const auto& [vertex, far] : lifts) all[vertex].z += far;
    morph.moves = {};
    for (const auto& [vertex, delta] : all) {
      morph.moves.vertices.push_back(vertex);
      morph.moves.deltas.push_back(delta);
    }
    return hidden;
  }

  RawPiece& brows_;
  const FaceShapes& face_;
  float unit_;
  Vec3 low_, high_;
  std::vector<SkinTriangle> skin_;
  std::vector<BrowSample> samples_;
};

}  // namespace

std::size_t keep_brows_in_front(std::vector<RawPiece>& pieces, const FaceShapes& face,
                                float eye_distance) {
  std::set<std::size_t> changed;
  for (RawPiece& piece : pieces) {
    if (part_of(piece) != head::Part::brows || piece.positions.empty()) continue;
    changed.merge(BrowKeeper(piece, face, eye_distance).keep());
  }
  return changed.size();
}

}  // namespace animeme::gltf

#include "fap/head/detail/weights.h"

#include <limits>
#include <tuple>
#include <utility>

#include "fap/head/detail/diffuse.h"

namespace animeme::head::detail {
namespace {

constexpr std::array kControls = {
    ControlInfo{"2.1", 5.5f, 0.7f, ""},    ControlInfo{"2.10", 4.2f, 0.7f, ""},
    ControlInfo{"2.2", 3.0f, 0.7f, "2.3"}, ControlInfo{"2.3", 3.0f, 0.7f, "2.2"},
    ControlInfo{"2.4", 3.4f, 0.5f, "2.4"}, ControlInfo{"2.5", 3.4f, 0.5f, "2.5"},
    ControlInfo{"2.6", 3.0f, 0.7f, "2.8"}, ControlInfo{"2.7", 3.0f, 0.7f, "2.9"},
    ControlInfo{"2.8", 3.0f, 0.7f, "2.6"}, ControlInfo{"2.9", 3.0f, 0.7f, "2.7"},
    ControlInfo{"8.1", 3.4f, 0.7f, "8.2"}, ControlInfo{"8.2", 3.4f, 0.7f, "8.1"},
    ControlInfo{"8.3", 4.2f, 0.5f, "8.3"}, ControlInfo{"8.4", 4.2f, 0.5f, "8.4"},
    ControlInfo{"8.5", 3.4f, 0.7f, "8.7"}, ControlInfo{"8.6", 3.4f, 0.7f, "8.8"},
    ControlInfo{"8.7", 3.4f, 0.7f, "8.5"}, ControlInfo{"8.8", 3.4f, 0.7f, "8.6"},
    ControlInfo{"3.1", 1.9f, 0.4f, ""},    ControlInfo{"3.2", 1.9f, 0.4f, ""},
    ControlInfo{"3.3", 1.9f, 0.4f, ""},    ControlInfo{"3.4", 1.9f, 0.4f, ""},
    ControlInfo{"4.1", 4.2f, 1.1f, ""},    ControlInfo{"4.2", 4.2f, 1.1f, ""},
    ControlInfo{"4.3", 4.2f, 1.1f, ""},    ControlInfo{"4.4", 4.2f, 1.1f, ""},
    ControlInfo{"4.5", 3.8f, 1.1f, ""},    ControlInfo{"4.6", 3.8f, 1.1f, ""},
    ControlInfo{"5.1", 5.0f, 1.7f, ""},    ControlInfo{"5.2", 5.0f, 1.7f, ""},
    ControlInfo{"5.3", 3.8f, 1.0f, ""},    ControlInfo{"5.4", 3.8f, 1.0f, ""},
    ControlInfo{"9.1", 2.3f, 0.45f, ""},   ControlInfo{"9.2", 2.3f, 0.45f, ""},
    ControlInfo{"9.3", 2.6f, 0.45f, ""},   ControlInfo{"10.1", 3.0f, 0.5f, ""},
    ControlInfo{"10.2", 3.0f, 0.5f, ""},   ControlInfo{"10.3", 3.0f, 0.5f, ""},
    ControlInfo{"10.4", 3.0f, 0.5f, ""},
};

// What holds still. Lists of landmarks seldom have these points: where they are on usual heads, in
// distances of the pupils from between the eyes. No place: such a list has it, or it is not missed.
constexpr struct {
  std::string_view id;
  float reach;
  Vec3 usual = {};
} kAnchors[] = {{"3.7", 2.5f},
                {"3.8", 2.5f},
                {"3.11", 2.5f},
                {"3.12", 2.5f},
                {"9.6", 2.5f},
                {"9.7", 2.5f},
                {"9.12", 2.5f, {0, -0.20f, 1.45f}},
                {"9.13", 2.5f, {0.16f, -0.23f, 1.39f}},
                {"9.14", 2.5f, {-0.16f, -0.23f, 1.39f}},
                {"9.15", 2.0f},
                {"10.7", 3.0f, {0.94f, -0.48f, 0.10f}},
                {"10.8", 3.0f, {-0.94f, -0.48f, 0.10f}},
                {"10.9", 3.0f, {1.00f, 0.21f, 0}},
                {"10.10", 3.0f, {-1.00f, 0.21f, 0}},
                {"11.1", 4.0f, {0, 1.35f, 1.0f}},
                {"11.2", 4.0f, {-0.75f, 1.15f, 0.8f}},
                {"11.3", 4.0f, {0.75f, 1.15f, 0.8f}}};

constexpr float kBackground = 0.02f;
constexpr float kCore = 0.3f;  // of anchors
constexpr int kSmoothings = 2;
constexpr float kSmoothCorners = 0.12f;  // cm, of what rounds the corners of the mouth
constexpr float kRoundness = 0.85f;      // of open mouths: 1 is an ellipse
constexpr float kDip = 0.06f;            // of the contact line of lips, against the opening
constexpr float kBorderReach = 3.8f;     // cm: skin that follows a border of the lips
// Halves of the borders of the lips, from the middle to the corner; see round_corners().
struct RoundedHalf {
  int fap;  // that opens it
  std::string_view middle, half, corner, inner_half;
  bool upper;

  bool outer() const { return half != inner_half; }
  // Of what the contact line lacks, so far from it (cm): the contact line goes along with the inner
  // border, the contour with the outer one.
  float share(float away) const {
    const float near = smooth_step(1.5f, 0.1f, away);
    return outer() ? smooth_step(kBorderReach, upper ? 0.9f : 1.2f, away) - near : near;
  }
};
constexpr std::array<RoundedHalf, 8> kRounded = {{{8, "2.2", "2.6", "2.4", "2.6", true},
                                                  {9, "2.2", "2.7", "2.5", "2.7", true},
                                                  {10, "2.3", "2.8", "2.4", "2.8", false},
                                                  {11, "2.3", "2.9", "2.5", "2.9", false},
                                                  {55, "8.1", "8.5", "8.3", "2.6", true},
                                                  {56, "8.1", "8.6", "8.4", "2.7", true},
                                                  {57, "8.2", "8.7", "8.3", "2.8", false},
                                                  {58, "8.2", "8.8", "8.4", "2.9", false}}};
constexpr float kSmoothLips = 0.2f;   // cm: as far as values run into each other at the lips ...
constexpr float kSmoothSkin = 0.42f;  // ... and away from them

class Builder {
 public:
  explicit Builder(const Head& head)
      : mesh_(head.part(Part::skin)),
        head_(head),
        neighbours_(neighbours_of(mesh_.positions.size(), mesh_.triangles)),
        scale_(head.fapu.es > 0 ? float(head.fapu.es) / 6.3f : 1.0f),
        weights_(mesh_.positions.size(), kControls.size()),
        sum_(mesh_.positions.size(), kBackground) {}

  Weights build() {
    for (std::size_t c = 0; c < kControls.size(); ++c) {
      add(vertex_of(kControls[c].id), kControls[c].reach, kControls[c].core, int(c), 1);
    }
    for (const auto& anchor : kAnchors) {
      std::uint32_t vertex = vertex_of(anchor.id);
      if (vertex == kMissing && anchor.usual != Vec3{}) {
        vertex = nearest(anchor.usual * float(head_.fapu.es));
      }
      add(vertex, anchor.reach, kCore, -1, 1);
    }
    add_jaw_line();
    add_brow_line();
    for (std::size_t v = 0; v < weights_.vertices(); ++v) {
      for (float& w : weights_.row(v)) w /= sum_[v];
    }
    const std::vector<float> radii = smooth_radii();
    for (int i = 0; i < kSmoothings; ++i) diffuse(mesh_.positions, neighbours_, radii, weights_);
    hold_lids();
    make_exact();
    match_lips();
    round_corners();
    return std::move(weights_);
  }

 private:
  std::uint32_t vertex_of(std::string_view id) const {
    const FeaturePoint point = head_.point(id);
    return point.part == Part::skin ? point.vertex : kMissing;
  }

  // A share of the point's pull goes into a column, the rest holds still; -1: all of it.
  void add(std::uint32_t vertex, float reach, float core, int column, float share) {
    if (vertex == kMissing) return;
    reach *= scale_;
    core *= scale_;
    for (const Reached& r : walk(mesh_.positions, neighbours_, vertex, reach)) {
      const float near = (reach - r.distance) / reach;
      const float ratio = r.distance / core;
      const float pull = near * near / (ratio * ratio + 1);
      sum_[r.vertex] += pull;
      if (column >= 0) weights_.row(r.vertex)[std::size_t(column)] += share * pull;
    }
  }

  std::uint32_t nearest(Vec3 place) const {
    std::uint32_t best = kMissing;
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) {
      const Vec3 d = mesh_.positions[v] - place;
      if (dot(d, d) < least) {
        least = dot(d, d);
        best = v;
      }
    }
    return best;
  }

  Vec3 place_of(std::string_view id, Vec3 usual) const {
    return vertex_of(id) == kMissing ? usual : head_.at(id);
  }

  // The jaw is wider than its point: helpers along the bone go along, less and less to the back.
  void add_jaw_line() {
    if (vertex_of("2.1") == kMissing) return;
    const Vec3 chin = head_.at("2.1");
    const float es = float(head_.fapu.es);
    for (const auto& [near, corner, side] :
         {std::tuple("2.11", "2.13", 1.0f), std::tuple("2.12", "2.14", -1.0f)}) {
      // Lists of landmarks seldom have the jaw line: it is where it is on usual heads then.
      const Vec3 a = place_of(near, chin + Vec3{0.34f * side, 0.14f, -0.02f} * es);
      const Vec3 b = place_of(corner, chin + Vec3{0.82f * side, 0.52f, -0.88f} * es);
      add(nearest(a), 4.5f, 0.7f, 0, 0.92f);
      add(nearest(mix(a, b, 0.33f)), 4.5f, 0.7f, 0, 0.74f);
      add(nearest(mix(a, b, 0.66f)), 4.5f, 0.7f, 0, 0.42f);
      add(nearest(b), 4.5f, 0.7f, 0, 0.10f);
    }
    const float depth = chin.z - head_.neck_pivot.z;
    add(nearest(chin + Vec3{0, 0, -0.28f * depth}), 4.0f, 0.7f, 0, 0.72f);
    add(nearest(chin + Vec3{0, -0.05f * depth, -0.5f * depth}), 4.0f, 0.7f, 0, 0.25f);
  }

  // Between the points of a brow its line goes along with both neighbours.
  void add_brow_line() {
    for (const auto& [a, b] : {std::pair("4.1", "4.3"), std::pair("4.3", "4.5"),
                               std::pair("4.2", "4.4"), std::pair("4.4", "4.6")}) {
      if (vertex_of(a) == kMissing || vertex_of(b) == kMissing) continue;
      const std::uint32_t middle = nearest(mix(head_.at(a), head_.at(b), 0.5f));
      for (const char* id : {a, b}) add(middle, 4.0f, 1.0f, control_index(id), 1);
    }
  }

  // The rims of the lids and what is near go along with nothing but their own FAPs.
  void hold_lids() {
    std::vector<float> held(weights_.vertices(), 1);
    const float reach = 1.5f * scale_;
    std::vector<std::uint32_t> rims;
    for (const auto& lids : head_.seams.lids) {
      for (const ContactPair& pair : lids) rims.insert(rims.end(), {pair.upper, pair.lower});
    }
    for (const Reached& r : walk(mesh_.positions, neighbours_, rims, reach)) {
      const float t = r.distance / reach;
      held[r.vertex] = 0.65f * t + 0.35f * smooth_step(0.0f, 1.0f, t);
    }
    for (std::size_t v = 0; v < weights_.vertices(); ++v) {
      for (std::size_t c = 0; c < kControls.size(); ++c) {
        if (!kControls[c].id.starts_with("3.")) weights_.row(v)[c] *= held[v];
      }
    }
  }

  // How far weights run into each other, cm: little at lips and lids, much where points are far
  // apart.
  std::vector<float> smooth_radii() const {
    std::vector<std::uint32_t> seams;
    for (const ContactPair& pair : head_.seams.lips)
      seams.insert(seams.end(), {pair.upper, pair.lower});
    for (const auto& lids : head_.seams.lids) {
      for (const ContactPair& pair : lids) seams.insert(seams.end(), {pair.upper, pair.lower});
    }
    std::vector<float> radii(weights_.vertices(), kSmoothSkin * scale_);
    const float reach = 2.6f * scale_;
    for (const Reached& r : walk(mesh_.positions, neighbours_, seams, reach)) {
      const float far = smooth_step(0.5f * scale_, reach, r.distance);
      radii[r.vertex] = (kSmoothLips + (kSmoothSkin - kSmoothLips) * far) * scale_;
    }
    return radii;
  }

  // Multiplies the table by the inverse of its rows at the controls.
  void make_exact() {
    std::vector<std::size_t> present;
    for (std::size_t c = 0; c < kControls.size(); ++c) {
      if (vertex_of(kControls[c].id) != kMissing) present.push_back(c);
    }
    const std::size_t n = present.size();
    // [own rows | identity] by Gauss and Jordan with pivots.
    std::vector<std::vector<double>> m(n, std::vector<double>(2 * n, 0));
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = weights_.row(vertex_of(kControls[present[i]].id));
      for (std::size_t j = 0; j < n; ++j) m[i][j] = row[present[j]];
      m[i][n + i] = 1;
    }
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i) {
        if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
      }
      if (std::abs(m[pivot][k]) < 1e-6) return;  // two points are one: stay with what there is
      std::swap(m[k], m[pivot]);
      const double scale = 1 / m[k][k];
      for (double& x : m[k]) x *= scale;
      for (std::size_t i = 0; i < n; ++i) {
        if (i == k || m[i][k] == 0) continue;
        const double factor = m[i][k];
        for (std::size_t j = 0; j < 2 * n; ++j) m[i][j] -= factor * m[k][j];
      }
    }
    std::vector<float> exact(n);
    for (std::size_t v = 0; v < weights_.vertices(); ++v) {
      const std::span<float> row = weights_.row(v);
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += row[present[i]] * m[i][n + j];
        exact[j] = float(sum);
      }
      for (std::size_t j = 0; j < n; ++j) row[present[j]] = exact[j];
    }
  }

  // Vertices that meet in the closed mouth move alike, so that closed lips stay closed when both
  // are moved alike.
  void match_lips() {
    for (const ContactPair& pair : head_.seams.lips) {
      const std::span<float> upper = weights_.row(pair.upper);
      const std::span<float> lower = weights_.row(pair.lower);
      for (std::size_t c = 0; c < kControls.size(); ++c) {
        const int dual = control_index(kControls[c].dual);
        if (dual < 0) {
          upper[c] = lower[c] =
              kControls[c].id.starts_with("2.") ? 0 : 0.5f * (upper[c] + lower[c]);
        } else {
          upper[c] = lower[std::size_t(dual)] = 0.5f * (upper[c] + lower[std::size_t(dual)]);
        }
      }
    }
  }

  // Between the middles of its halves and its corners and middle, the border of an open mouth is an
  // arc of an ellipse. What weights lack there is in columns of their own: it opens the mouth, but
  // does not narrow or push it.
  void round_corners() {
    Weights wider(weights_.vertices(), kControls.size() + kRounded.size());
    for (std::size_t v = 0; v < weights_.vertices(); ++v) {
      const std::span<const float> row = std::as_const(weights_).row(v);
      std::copy(row.begin(), row.end(), wider.row(v).begin());
    }
    weights_ = std::move(wider);
    std::array<std::vector<std::uint32_t>, 2> seams;
    for (const ContactPair& pair : head_.seams.lips) {
      seams[0].push_back(pair.upper);
      seams[1].push_back(pair.lower);
    }
    if (seams[0].empty()) return;
    const std::array<std::vector<float>, 2> away = {distances(seams[0]), distances(seams[1])};
    Weights corners(weights_.vertices(), kRounded.size());
    for (std::size_t k = 0; k < kRounded.size(); ++k) {
      const std::size_t lip = kRounded[k].upper ? 0 : 1;
      round_corner(kRounded[k], k, corners, seams[lip], away[lip], away[1 - lip]);
    }
    const std::vector<float> radii(weights_.vertices(), kSmoothCorners * scale_);
    diffuse(mesh_.positions, neighbours_, radii, corners);
    keep_points(corners);
    // Closed lips stay closed.
    for (const ContactPair& pair : head_.seams.lips) {
      for (std::size_t k = 0; k < kRounded.size(); ++k) {
        if (!kRounded[k].upper) continue;
        float &upper = corners.row(pair.upper)[k], &lower = corners.row(pair.lower)[k + 2];
        upper = lower = 0.5f * (upper + lower);
      }
    }
    for (std::size_t v = 0; v < weights_.vertices(); ++v) {
      const std::span<const float> row = std::as_const(corners).row(v);
      std::copy(row.begin(), row.end(), weights_.row(v).begin() + kControls.size());
    }
  }

  std::vector<float> distances(const std::vector<std::uint32_t>& from) const {
    std::vector<float> all(mesh_.positions.size(), std::numeric_limits<float>::max());
    for (const Reached& r : walk(mesh_.positions, neighbours_, from, kBorderReach * scale_)) {
      all[r.vertex] = r.distance;
    }
    return all;
  }

  // `here`: distances from the lip whose contact line is `seam`; `there`: from the other one, which
  // stays.
  void round_corner(const RoundedHalf& lip, std::size_t column, Weights& corners,
                    const std::vector<std::uint32_t>& seam, const std::vector<float>& here,
                    const std::vector<float>& there) {
    const std::uint32_t at_corner = vertex_of(lip.corner), at_half = vertex_of(lip.half);
    if (at_corner == kMissing || at_half == kMissing) return;
    const auto inner = std::size_t(control_index(lip.inner_half));
    const auto centre = std::size_t(control_index(lip.upper ? "2.2" : "2.3"));
    const float middle = head_.at(lip.middle).x;
    const float width = mesh_.positions[at_corner].x - middle;
    const auto along = [&](std::uint32_t v) { return (mesh_.positions[v].x - middle) / width; };
    const float start = along(at_half);
    if (!(start > 0.2f && start < 0.8f)) return;
    // What the contact line lacks, towards the corner.
    struct Lack {
      float t, lack;
    };
    std::vector<Lack> lacks = {{start, 0}, {1, 0}};
    for (const std::uint32_t v : seam) {
      const float t = along(v);
      if (t <= start || t >= 1) continue;
      const float arc = std::sqrt((1 - t * t) / (1 - start * start));
      const float lack = kRoundness * (arc - weights_.row(v)[inner]);
      lacks.push_back({t, std::max(lack, 0.0f)});
    }
    const float most =
        std::max_element(lacks.begin(), lacks.end(), [](const Lack& a, const Lack& b) {
          return a.lack < b.lack;
        })->lack;
    // The same towards the middle, when both of them open as the ellipse does, and what fills the
    // dip that the contact line has there.
    const float at_start = std::sqrt(1 - start * start);
    for (const std::uint32_t v : seam) {
      const float t = along(v);
      if (t < 0 || t >= start) continue;
      const auto row = std::as_const(weights_).row(v);
      const float lack = (std::sqrt(1 - t * t) - row[centre]) / at_start - row[inner];
      const float dip = kDip * smooth_step(0.0f, 0.16f, t) * smooth_step(0.5f, 0.2f, t);
      lacks.push_back({t, std::max(lack, 0.0f) + dip});
    }
    std::sort(lacks.begin(), lacks.end(), [](const Lack& a, const Lack& b) { return a.t < b.t; });
    for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) {
      const float away = here[v] / scale_;
      const float t = along(v);
      if (away > kBorderReach || t <= 0) continue;
      // Past the corner skin belongs to both lips.
      const float own =
          smooth_step(-0.5f, 0.5f, (there[v] - here[v]) / std::max(there[v] + here[v], 1e-6f));
      float near = 0;
      for (std::size_t i = 0; i + 1 < lacks.size(); ++i) {
        const Lack &a = lacks[i], &b = lacks[i + 1];
        if (t < a.t || t > b.t || b.t <= a.t) continue;
        near = a.lack + (b.lack - a.lack) * (t - a.t) / (b.t - a.t);
      }
      // The skin around the corner moves more gently than the edge of the lip.
      const float far = 0.8f * most * smooth_step(start, 0.85f, t) * smooth_step(1.5f, 0.85f, t);
      const float lack = t < start ? near : near + (far - near) * smooth_step(0.1f, 0.9f, away);
      corners.row(v)[column] = lack * own * lip.share(away);
    }
  }

  // No feature point moves by columns that are none of its own.
  void keep_points(Weights& corners) const {
    std::vector<float> column(corners.vertices());
    for (std::size_t k = 0; k < corners.controls(); ++k) {
      for (std::size_t v = 0; v < column.size(); ++v) column[v] = corners.row(v)[k];
      hold_points(head_, weights_, column);
      for (std::size_t v = 0; v < column.size(); ++v) corners.row(v)[k] = column[v];
    }
  }

  const Mesh& mesh_;
  const Head& head_;
  Neighbours neighbours_;
  float scale_;
  Weights weights_;
  std::vector<float> sum_;
};

}  // namespace

std::span<const ControlInfo> controls() { return kControls; }

int control_index(std::string_view id) {
  for (std::size_t c = 0; c < kControls.size(); ++c) {
    if (!id.empty() && kControls[c].id == id) return int(c);
  }
  return -1;
}

int rounding_column(int fap) {
  for (std::size_t k = 0; k < kRounded.size(); ++k) {
    if (kRounded[k].fap == fap) return int(kControls.size() + k);
  }
  return -1;
}

Weights skin_weights(const Head& head) { return Builder(head).build(); }

void hold_points(const Head& head, const Weights& weights, std::vector<float>& values) {
  std::vector<std::pair<std::size_t, float>> pinned;  // columns of points, and their values
  for (std::size_t c = 0; c < kControls.size(); ++c) {
    const FeaturePoint point = head.point(kControls[c].id);
    if (!point.exists() || point.part != Part::skin) continue;
    pinned.emplace_back(c, values[point.vertex]);
  }
  for (std::size_t v = 0; v < values.size(); ++v) {
    for (const auto& [column, value] : pinned) values[v] -= value * weights.row(v)[column];
  }
}

}  // namespace animeme::head::detail

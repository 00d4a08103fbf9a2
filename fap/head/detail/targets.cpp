#include "fap/head/detail/targets.h"

#include <limits>

#include "fap/head/detail/slide.h"
#include "fap/head/detail/smile.h"
#include "fap/head/detail/weights.h"

namespace animeme::head::detail {
namespace {

constexpr float kLeast = 0.002f;    // smaller weights are nothing
constexpr float kChinBack = 0.42f;  // the chin goes back by this share of its drop
constexpr float kJawShare = 0.8f;   // drop of the teeth against that of the chin
constexpr float kJawLength = 9.5f;  // from the joint to the teeth, cm on a face with ES 6.3

Vec3 axis_of(int fap) {
  const fap::Point a = fap::move_of(fap).axis;
  return Vec3(Vec3d{a[0], a[1], a[2]});
}

struct Share {
  std::string_view id;
  float factor;
};

// Which points go along with a FAP besides its own; the factors were chosen by eye.
std::vector<Share> shares_of(int fap, bool back) {
  // A lip that is drawn in rolls over the teeth, and the skin beside it stays before them.
  const float border = back ? 0.3f : 0.85f, sides = back ? 0.2f : 0.65f;
  switch (fap) {
    case 3:
    case 15:
      return {{"2.1", 1}, {"2.10", 0.97f}};
    case 14:
      // Forward, the border of the lip bridges the step from the chin to the lip, which stays.
      if (back) return {{"2.1", 1}, {"2.10", 0.97f}};
      return {{"2.1", 1}, {"2.10", 0.97f}, {"8.2", 0.45f}, {"8.7", 0.35f}, {"8.8", 0.35f}};
    case 6:
      return {{"2.4", 1}, {"2.6", 0.5f}, {"2.8", 0.5f}};
    case 7:
      return {{"2.5", 1}, {"2.7", 0.5f}, {"2.9", 0.5f}};
    case 53:
      return {{"8.3", 1}, {"8.5", 0.5f}, {"8.7", 0.5f}, {"5.3", 0.16f}};
    case 54:
      return {{"8.4", 1}, {"8.6", 0.5f}, {"8.8", 0.5f}, {"5.4", 0.16f}};
    case 12:
      return {{"2.4", 1}, {"5.1", 0.16f}};
    case 13:
      return {{"2.5", 1}, {"5.2", 0.16f}};
    case 59:
      return {{"8.3", 1}, {"5.1", 0.27f}};
    case 60:
      return {{"8.4", 1}, {"5.2", 0.27f}};
    case 16:
      return {{"2.3", 1},     {"8.2", border}, {"2.8", 0.75f}, {"2.9", 0.75f},
              {"8.7", sides}, {"8.8", sides},  {"2.4", 0.2f},  {"2.5", 0.2f}};
    case 17:
      return {{"2.2", 1},     {"8.1", border}, {"2.6", 0.75f}, {"2.7", 0.75f},
              {"8.5", sides}, {"8.6", sides},  {"2.4", 0.2f},  {"2.5", 0.2f}};
    case 37:
      return {{"4.1", 1}, {"4.3", 0.5f}, {"4.5", 0.15f}};
    case 38:
      return {{"4.2", 1}, {"4.4", 0.5f}, {"4.6", 0.15f}};
    case 63:
    case 64:
      return {{"9.3", 1}, {"9.1", 0.45f}, {"9.2", 0.45f}};
    default:
      return {{fap::info(fap).feature_point, 1}};
  }
}

class Maker {
 public:
  explicit Maker(const Head& head)
      : head_(head),
        weights_(skin_weights(head)),
        column_(head.part(Part::skin).positions.size()),
        slide_(head) {
    find_ears();
    bind(Part::brows);
  }

  std::vector<Target> make() {
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (fap != 14 && fap != 16 && fap != 17) {
        add_fap(fap, false);
        continue;
      }
      // Back is not forward the other way round.
      const std::size_t first = targets_.size();
      add_fap(fap, false);
      const std::size_t second = targets_.size();
      add_fap(fap, true);
      for (std::size_t i = first; i < targets_.size(); ++i) {
        (i < second ? targets_[i].low : targets_[i].high) = 0;
      }
    }
    add_tongue();
    add_pupils();
    for (Target& target : cheek_targets(head_, weights_)) targets_.push_back(std::move(target));
    std::stable_sort(targets_.begin(), targets_.end(), [](const Target& a, const Target& b) {
      return std::pair(a.control, a.part) < std::pair(b.control, b.part);
    });
    return std::move(targets_);
  }

 private:
  // `back`: where its values are negative.
  void add_fap(int fap, bool back) {
    if (!fill_column(fap, back)) return;
    const Vec3 step = axis_of(fap) * float(fap::step_size(fap, head_.fapu));
    std::vector<Vec3> deltas(column_.size());
    for (std::size_t v = 0; v < column_.size(); ++v) {
      deltas[v] = step * column_[v];
      if (fap == 3) deltas[v].z += step.y * kChinBack * column_[v];
    }
    if (fap >= 31 && fap <= 36) slide_.on_bone(deltas);
    if (fap < 65) slide_.below_hair(deltas);
    add_mouth_floor(fap, step, deltas);
    add(fap, Part::skin, deltas);
    add_bound(fap, deltas);
  }

  // How far each vertex of the skin goes along with a FAP; false: not at all.
  bool fill_column(int fap, bool back) {
    const bool lid = fap >= 19 && fap <= 22;
    if (fap::move_of(fap).kind != fap::MoveKind::translate) return false;
    if (lid && fill_lid(fap)) return true;
    if (fap >= 65 && fill_ear(fap)) return true;
    bool any = false;
    std::fill(column_.begin(), column_.end(), 0.0f);
    for (const Share& share : shares_of(fap, back)) {
      const int control = control_index(share.id);
      if (control < 0 || !head_.point(share.id).exists()) continue;
      any = true;
      for (std::size_t v = 0; v < column_.size(); ++v) {
        column_[v] += share.factor * weights_.row(v)[std::size_t(control)];
      }
    }
    if (const int rounding = rounding_column(fap); rounding >= 0 && any) {
      for (std::size_t v = 0; v < column_.size(); ++v) {
        column_[v] += weights_.row(v)[std::size_t(rounding)];
      }
    }
    return any;
  }

  bool fill_lid(int fap) {
    constexpr std::size_t kOrder[] = {0, 2, 1, 3};  // 19 upper left, 20 upper right ...
    const auto& weights = head_.seams.lid_weights[kOrder[fap - 19]];
    if (weights.size() != column_.size()) return false;
    column_ = weights;
    return true;
  }

  // An ear that is a mesh of its own moves as a whole.
  bool fill_ear(int fap) {
    const auto& part = ears_[std::size_t((fap - 65) % 2)];
    if (part.empty()) return false;
    std::fill(column_.begin(), column_.end(), 0.0f);
    for (const std::uint32_t v : part) column_[v] = 1;
    return true;
  }

  void find_ears() {
    const Mesh& skin = head_.part(Part::skin);
    const Neighbours neighbours = neighbours_of(skin.positions.size(), skin.triangles);
    const std::string_view ids[] = {"10.1", "10.2"};
    for (std::size_t side = 0; side < 2; ++side) {
      const FeaturePoint point = head_.point(ids[side]);
      if (!point.exists()) continue;
      std::vector<std::uint32_t> part;
      for (const Reached& r :
           walk(skin.positions, neighbours, point.vertex, std::numeric_limits<float>::max())) {
        part.push_back(r.vertex);
      }
      if (part.size() < skin.positions.size() / 3) ears_[side] = std::move(part);
    }
  }

  // Inside of the mouth the floor turns with the jaw.
  void add_mouth_floor(int fap, Vec3 step, std::vector<Vec3>& deltas) const {
    const auto& weights = head_.seams.jaw_weights;
    if (fap != 3 && fap != 14 && fap != 15) return;
    const float angle = kJawShare * -step.y / (kJawLength * float(head_.fapu.es) / 6.3f);
    for (std::size_t v = 0; v < weights.size() && v < deltas.size(); ++v) {
      const Vec3 r = head_.part(Part::skin).positions[v] - head_.jaw_axis;
      const Vec3 turned = fap == 3 ? Vec3{0, -r.z * angle, r.y * angle} : step;
      deltas[v] = mix(deltas[v], turned, weights[v]);
    }
  }

  void add(int fap, Part part, const std::vector<Vec3>& deltas) {
    const float least = kLeast * float(fap::step_size(fap, head_.fapu));
    Target target{.control = fap, .part = part, .vertices = {}, .deltas = {}};
    for (std::size_t v = 0; v < deltas.size(); ++v) {
      if (dot(deltas[v], deltas[v]) <= least * least) continue;
      target.vertices.push_back(std::uint32_t(v));
      target.deltas.push_back(deltas[v]);
    }
    if (!target.vertices.empty()) targets_.push_back(std::move(target));
  }

  // Vertices of a part that lies on the skin follow the skin below.
  struct Binding {
    std::array<std::uint32_t, 3> skin;
    std::array<float, 3> weights;
  };
  void bind(Part part) {
    const auto& skin = head_.part(Part::skin).positions;
    for (const Vec3& p : head_.part(part).positions) {
      std::array<std::pair<float, std::uint32_t>, 3> best;
      best.fill({std::numeric_limits<float>::max(), 0});
      for (std::uint32_t v = 0; v < skin.size(); ++v) {
        const Vec3 d = skin[v] - p;
        const float square = dot(d, d);
        if (square >= best[2].first) continue;
        best[2] = {square, v};
        if (best[2] < best[1]) std::swap(best[2], best[1]);
        if (best[1] < best[0]) std::swap(best[1], best[0]);
      }
      Binding b{};
      float sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        b.skin[k] = best[k].second;
        b.weights[k] = 1 / (best[k].first + 1e-3f);
        sum += b.weights[k];
      }
      for (float& w : b.weights) w /= sum;
      bound_.push_back(b);
    }
  }
  void add_bound(int fap, const std::vector<Vec3>& skin) {
    std::vector<Vec3> deltas;
    for (const Binding& b : bound_) {
      Vec3 sum;
      for (std::size_t k = 0; k < 3; ++k) sum += skin[b.skin[k]] * b.weights[k];
      deltas.push_back(sum);
    }
    add(fap, Part::brows, deltas);
  }

  void add_tongue() {
    const auto& places = head_.part(Part::tongue).positions;
    const FeaturePoint tip = head_.point("6.1");
    const FeaturePoint body = head_.point("6.2");
    if (places.empty() || tip.part != Part::tongue || body.part != Part::tongue) return;
    float root = std::numeric_limits<float>::max();
    float half = 0;
    for (const Vec3& p : places) {
      root = std::min(root, p.z);
      half = std::max(half, std::abs(p.x));
    }
    const float front = head_.at("6.1").z;
    const float middle = head_.at("6.2").z;
    for (int fap = 43; fap <= 47; ++fap) {
      const float unit = float(fap::step_size(fap, head_.fapu));
      std::vector<Vec3> deltas;
      for (const Vec3& p : places) {
        const float at_tip = smooth_step(middle, front, p.z);
        const float at_body = p.z < middle ? smooth_step(root, middle, p.z) : 1 - at_tip;
        const float aside = p.x * p.x / half;
        if (fap == 47) {
          deltas.push_back(Vec3{0, aside * unit * smooth_step(root, middle, p.z), 0});
        } else {
          deltas.push_back(axis_of(fap) * (unit * (fap == 46 ? at_body : at_tip)));
        }
      }
      add(fap, Part::tongue, deltas);
    }
  }

  // The edge of the pupil moves out or in, the iris shrinks or grows in between.
  void add_pupils() {
    for (const int fap : {29, 30}) {
      const Eye& eye = head_.eyes[std::size_t(fap - 29)];
      const Part part = fap == 29 ? Part::left_eye : Part::right_eye;
      const float unit = 0.5f * float(fap::step_size(fap, head_.fapu));
      std::vector<Vec3> deltas;
      for (const Vec3& p : head_.part(part).positions) {
        const Vec3 q = p - eye.centre;
        const float r = std::hypot(q.x, q.y);
        const bool moved = q.z > 0 && r > 0 && r < eye.iris_radius && eye.pupil_radius > 0;
        const float share = r <= eye.pupil_radius
                                ? r / eye.pupil_radius
                                : (eye.iris_radius - r) / (eye.iris_radius - eye.pupil_radius);
        deltas.push_back(moved ? Vec3{q.x / r, q.y / r, -r / q.z} * (share * unit) : Vec3{});
      }
      add(fap, part, deltas);
    }
  }

  const Head& head_;
  Weights weights_;
  std::vector<float> column_;
  Slide slide_;
  std::array<std::vector<std::uint32_t>, 2> ears_;
  std::vector<Binding> bound_;
  std::vector<Target> targets_;
};

}  // namespace

std::vector<Target> make_targets(const Head& head) { return Maker(head).make(); }

Transform jaw_transform(const Rig& rig, float open, float thrust, float shift) {
  const float scale = float(rig.fapu.es) / 6.3f;
  const float drop = std::max(open, kBite) * float(rig.fapu.mns) / 1024;
  const float sine = std::clamp(kJawShare * drop / (kJawLength * scale), -0.6f, 0.6f);
  Transform jaw = rotation_about(rig.jaw_axis, std::asin(sine), 0, 0);
  jaw.shift.z += thrust * float(rig.fapu.mns) / 1024;
  jaw.shift.x -= shift * float(rig.fapu.mw) / 1024;
  return jaw;
}

}  // namespace animeme::head::detail

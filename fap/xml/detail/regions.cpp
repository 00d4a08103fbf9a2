#include "fap/xml/detail/regions.h"

#include <algorithm>
#include <cmath>

namespace animeme::head::detail {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGoodEnough = 0.01;  // error of a factor
constexpr int kWidths = 40;           // tried for each band

// Vertices of like factors, and the cosine that fits them best.
struct Band {
  std::vector<Wanted> wanted;  // by factor, ascending
  double weight = 0;
  std::uint32_t far = 0;  // sets the width
  double worst = 0;
};

class Fitter {
 public:
  Fitter(const RegionMesh& mesh, const RegionTask& task) : mesh_(mesh), task_(task) {
    const Vec3 pivot = mesh.positions[task.pivot];
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      distance_.push_back(xface_distance(Reach::sphere, pivot, mesh.positions[v]));
      by_distance_.push_back(v);
    }
    std::stable_sort(by_distance_.begin(), by_distance_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return distance_[a] < distance_[b]; });
  }

  std::vector<Band> run() {
    std::vector<Band> bands;
    // Vertices that go the other way are bands of their own.
    for (const bool negative : {false, true}) {
      Band band;
      for (const Wanted& w : task_.wanted) {
        if (w.factor != 0 && (w.factor < 0) == negative) band.wanted.push_back(w);
      }
      std::stable_sort(band.wanted.begin(), band.wanted.end(),
                       [](const Wanted& a, const Wanted& b) { return a.factor < b.factor; });
      if (negative && task_.most == 1 && !bands.empty()) break;
      if (!band.wanted.empty()) bands.push_back(fitted(std::move(band)));
    }
    while (int(bands.size()) < task_.most) {
      std::size_t worst = bands.size();
      for (std::size_t i = 0; i < bands.size(); ++i) {
        if (bands[i].worst <= kGoodEnough || bands[i].wanted.size() < 2) continue;
        if (worst == bands.size() || bands[i].worst > bands[worst].worst) worst = i;
      }
      if (worst == bands.size()) break;
      cut(bands, worst);
    }
    return bands;
  }

 private:
  bool holds_pivot(const Band& band) const {
    return std::any_of(band.wanted.begin(), band.wanted.end(),
                       [&](const Wanted& w) { return w.vertex == task_.pivot; });
  }

  // The cosine without its weight; nothing beyond the width.
  double bell(std::uint32_t vertex, double width) const {
    const double d = distance_[vertex];
    return d < width ? std::cos(kPi * d / width) + 1 : 0;
  }

  // Weight and error for one width.
  void try_width(Band& band, double width, bool fixed, double& least, std::uint32_t far) const {
    double weight = 0;
    double above = 0;
    double below = 0;
    for (const Wanted& w : band.wanted) {
      const double b = bell(w.vertex, width);
      above += b * w.factor;
      below += b * b;
      if (fixed && w.vertex == task_.pivot) weight = w.factor / 2;
    }
    if (!fixed) weight = below > 0 ? above / below : 0;
    double worst = 0;
    double squares = 0;
    for (const Wanted& w : band.wanted) {
      const double error = std::abs(weight * bell(w.vertex, width) - w.factor);
      worst = std::max(worst, error);
      squares += error * error;
    }
    if (squares >= least) return;
    least = squares;
    band.weight = weight;
    band.far = far;
    band.worst = worst;
  }

  // The best width: from that of the vertex nearest to the pivot to the far end of the mesh. What
  // lies beyond it stays.
  Band fitted(Band band) const {
    const bool fixed = task_.exact_at_pivot && holds_pivot(band);
    double least = std::numeric_limits<double>::infinity();
    float near = std::numeric_limits<float>::max();
    for (const Wanted& w : band.wanted) {
      if (distance_[w.vertex] > 0) near = std::min(near, distance_[w.vertex]);
    }
    const float end = distance_[by_distance_.back()];
    near = std::clamp(near, 0.01f * end, end);
    for (int i = 1; i <= kWidths; ++i) {
      const float width = near * std::pow(end / near, float(i) / kWidths);
      const auto at = std::lower_bound(by_distance_.begin(), by_distance_.end() - 1, width,
                                       [&](std::uint32_t v, float w) { return distance_[v] < w; });
      if (distance_[*at] > 0) try_width(band, distance_[*at], fixed, least, *at);
    }
    return band;
  }

  // Where the halves differ most from each other: at the middle of the factors.
  void cut(std::vector<Band>& bands, std::size_t i) const {
    Band lower = std::move(bands[i]);
    Band upper;
    const float middle = (lower.wanted.front().factor + lower.wanted.back().factor) / 2;
    auto at = std::upper_bound(lower.wanted.begin(), lower.wanted.end(), middle,
                               [](float m, const Wanted& w) { return m < w.factor; });
    if (at == lower.wanted.begin() || at == lower.wanted.end()) {
      at = lower.wanted.begin() + std::ptrdiff_t(lower.wanted.size() / 2);
    }
    upper.wanted.assign(at, lower.wanted.end());
    lower.wanted.erase(at, lower.wanted.end());
    bands[i] = fitted(std::move(lower));
    bands.push_back(fitted(std::move(upper)));
  }

  const RegionMesh& mesh_;
  const RegionTask& task_;
  std::vector<float> distance_;
  std::vector<std::uint32_t> by_distance_;
};

XfaceItem item_of(const RegionTask& task, const std::vector<Wanted>& wanted, std::uint32_t pivot,
                  XfaceInfluence influence) {
  XfaceItem item;
  item.pivot = pivot;
  influence.fap = task.fap;
  item.influences.push_back(influence);
  for (const Wanted& w : wanted) item.region.push_back(w.vertex);
  return item;
}

void add_to_region(XfaceItem& item, std::uint32_t vertex) {
  item.region.push_back(vertex);
  std::sort(item.region.begin(), item.region.end());
  item.region.erase(std::unique(item.region.begin(), item.region.end()), item.region.end());
}

float part_of(Vec3 v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

}  // namespace

RegionMesh region_mesh(std::span<const Vec3> positions) {
  RegionMesh mesh{positions, {}, {}};
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float x = part_of(positions[v], axis);
      if (x < part_of(positions[mesh.lowest[axis]], axis)) mesh.lowest[axis] = v;
      if (x > part_of(positions[mesh.highest[axis]], axis)) mesh.highest[axis] = v;
    }
  }
  return mesh;
}

std::vector<XfaceItem> fit_regions(const RegionMesh& mesh, const RegionTask& task) {
  std::vector<XfaceItem> items;
  for (const Band& band : Fitter(mesh, task).run()) {
    if (band.weight == 0) continue;
    XfaceItem item = item_of(task, band.wanted, task.pivot,
                             {.reach = Reach::sphere, .weight = float(band.weight)});
    const Vec3 pivot = mesh.positions[task.pivot];
    const float width = xface_distance(Reach::sphere, pivot, mesh.positions[band.far]);
    std::erase_if(item.region, [&](std::uint32_t v) {
      return xface_distance(Reach::sphere, pivot, mesh.positions[v]) >= width;
    });
    add_to_region(item, band.far);
    items.push_back(std::move(item));
  }
  return items;
}

// From one end w (1 + cos(pi s / l)), from the other w (1 - cos(pi s / l)): 2 w together.
std::vector<XfaceItem> fit_waves(const RegionMesh& mesh, const RegionTask& task) {
  std::size_t axis = 0;
  const auto extent = [&](std::size_t a) {
    return part_of(mesh.positions[mesh.highest[a]], a) - part_of(mesh.positions[mesh.lowest[a]], a);
  };
  for (std::size_t a = 1; a < 3; ++a) axis = extent(a) > extent(axis) ? a : axis;
  std::vector<Wanted> sorted = task.wanted;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Wanted& a, const Wanted& b) { return a.factor < b.factor; });
  std::vector<XfaceItem> items;
  if (sorted.empty() || extent(axis) <= 0) return items;
  const float least = sorted.front().factor;
  const float range = sorted.back().factor - least;
  const int bands = range <= 2 * float(kGoodEnough) ? 1 : std::max(1, task.most);
  auto at = sorted.begin();
  for (int b = 0; b < bands; ++b) {
    const float border = least + range * float(b + 1) / float(bands);
    const auto end =
        b + 1 == bands
            ? sorted.end()
            : std::find_if(at, sorted.end(), [&](const Wanted& w) { return w.factor > border; });
    if (at == end) continue;
    double sum = 0;
    for (auto w = at; w != end; ++w) sum += w->factor;
    const float weight = float(sum / double(end - at)) / 2;
    std::vector<Wanted> band(at, end);
    at = end;
    const Reach reach = Reach(1 + axis);
    for (const auto& [pivot, far] : {std::pair(mesh.lowest[axis], mesh.highest[axis]),
                                     std::pair(mesh.highest[axis], mesh.lowest[axis])}) {
      XfaceItem item = item_of(task, band, pivot, {.reach = reach, .weight = weight});
      add_to_region(item, far);
      items.push_back(std::move(item));
    }
  }
  return items;
}

}  // namespace animeme::head::detail

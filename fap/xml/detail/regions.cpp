#include "fap/xml/detail/regions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace animeme::head::detail {
namespace {

constexpr double kGoodEnough = 0.002;  // error of a factor
constexpr int kWidths = 40;            // tried
constexpr float kLeastBell = 0.15f;    // of 2, at the border of a region that is cut into bands

constexpr double kFlat = 0.02;  // where the cosine is lower, nothing can be moved
constexpr float kAlone = 0.1f;  // least factor in the only region of a FAP

// A vertex, and the weight with which the cosine would be right for it.
struct Fit {
  std::uint32_t vertex = 0;
  double bell = 0;
  double wanted = 0;

  double weight() const { return wanted / bell; }
};

// Vertices that like one weight.
struct Band {
  std::vector<Fit> fits;  // by weight, ascending
  double weight = 0;
  double worst = 0;
};

class Fitter {
 public:
  Fitter(const RegionMesh& mesh, const RegionTask& task) : task_(task), wanted_(task.wanted) {
    // One region cannot go two ways, and what hardly goes along would set its size.
    float most = 0;
    for (const Wanted& w : wanted_) most = std::max(most, w.factor);
    if (task.most == 1 && most > 0) {
      std::erase_if(wanted_, [&](const Wanted& w) { return w.factor < kAlone * most; });
    }
    const Vec3 pivot = mesh.positions[task.pivot];
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      distance_.push_back(xface_distance(Reach::sphere, pivot, mesh.positions[v]));
      by_distance_.push_back(v);
    }
    std::stable_sort(by_distance_.begin(), by_distance_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return distance_[a] < distance_[b]; });
  }

  /// The vertex that sets the width.
  std::uint32_t far() const { return far_; }

  std::vector<Band> run() {
    far_ = best_width();
    std::vector<Band> bands;
    Band all;
    for (const Wanted& w : wanted_) {
      const double b = bell(w.vertex, distance_[far_]);
      if (b > kFlat && w.factor != 0) all.fits.push_back({w.vertex, b, w.factor});
    }
    if (all.fits.empty()) return bands;
    std::stable_sort(all.fits.begin(), all.fits.end(),
                     [](const Fit& a, const Fit& b) { return a.weight() < b.weight(); });
    bands.push_back(fitted(std::move(all)));
    while (int(bands.size()) < task_.most) {
      const auto worst =
          std::max_element(bands.begin(), bands.end(),
                           [](const Band& a, const Band& b) { return a.worst < b.worst; });
      if (worst->worst <= kGoodEnough || worst->fits.size() < 2) break;
      cut(bands, std::size_t(worst - bands.begin()));
    }
    return bands;
  }

 private:
  // The cosine without its weight; nothing beyond the width.
  double bell(std::uint32_t vertex, double width) const {
    const double d = distance_[vertex];
    return d < width ? std::cos(std::numbers::pi * d / width) + 1 : 0;
  }

  // Weight of the whole as one region, and the sum of its squared errors.
  double error_of(double width) const {
    double above = 0;
    double below = 0;
    for (const Wanted& w : wanted_) {
      const double b = bell(w.vertex, width);
      above += b * w.factor;
      below += b * b;
    }
    double weight = below > 0 ? above / below : 0;
    for (const Wanted& w : wanted_) {
      if (task_.exact_at_pivot && w.vertex == task_.pivot) weight = w.factor / 2;
    }
    double squares = 0;
    for (const Wanted& w : wanted_) {
      const double error = weight * bell(w.vertex, width) - w.factor;
      squares += error * error;
    }
    return squares;
  }

  // The width that fits best as one region. One that is to be cut has to reach all vertices, and
  // be high enough at the farthest.
  std::uint32_t best_width() const {
    float reach = 0;
    float near = std::numeric_limits<float>::max();
    for (const Wanted& w : wanted_) {
      const float d = distance_[w.vertex];
      reach = std::max(reach, d);
      if (d > 0) near = std::min(near, d);
    }
    const float end = distance_[by_distance_.back()];
    // cos(pi * reach / width) + 1 = kLeastBell
    if (task_.most > 1) near = reach * float(std::numbers::pi) / std::acos(kLeastBell - 1);
    near = std::clamp(near, 0.01f * end, end);
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t best = by_distance_.back();
    for (int i = 0; i <= kWidths; ++i) {
      const float width = near * std::pow(end / near, float(i) / kWidths);
      const auto at = std::lower_bound(by_distance_.begin(), by_distance_.end() - 1, width,
                                       [&](std::uint32_t v, float w) { return distance_[v] < w; });
      if (distance_[*at] <= 0) continue;
      const double error = error_of(distance_[*at]);
      if (error >= least) continue;
      least = error;
      best = *at;
    }
    return best;
  }

  Band fitted(Band band) const {
    double above = 0;
    double below = 0;
    for (const Fit& f : band.fits) {
      above += f.bell * f.wanted;
      below += f.bell * f.bell;
    }
    band.weight = above / below;
    for (const Fit& f : band.fits) {
      if (task_.exact_at_pivot && f.vertex == task_.pivot) band.weight = f.weight();
    }
    band.worst = 0;
    for (const Fit& f : band.fits) {
      band.worst = std::max(band.worst, std::abs(band.weight * f.bell - f.wanted));
    }
    return band;
  }

  // At the middle of the weights.
  void cut(std::vector<Band>& bands, std::size_t i) const {
    Band lower = std::move(bands[i]);
    Band upper;
    const double middle = (lower.fits.front().weight() + lower.fits.back().weight()) / 2;
    auto at = std::upper_bound(lower.fits.begin(), lower.fits.end(), middle,
                               [](double m, const Fit& f) { return m < f.weight(); });
    if (at == lower.fits.begin() || at == lower.fits.end()) {
      at = lower.fits.begin() + std::ptrdiff_t(lower.fits.size() / 2);
    }
    upper.fits.assign(at, lower.fits.end());
    lower.fits.erase(at, lower.fits.end());
    bands[i] = fitted(std::move(lower));
    bands.push_back(fitted(std::move(upper)));
  }

  const RegionTask& task_;
  std::vector<Wanted> wanted_;
  std::vector<float> distance_;
  std::vector<std::uint32_t> by_distance_;
  std::uint32_t far_ = 0;
};

template <class List>
XfaceItem item_of(const RegionTask& task, const List& vertices, std::uint32_t pivot,
                  XfaceInfluence influence) {
  XfaceItem item;
  item.pivot = pivot;
  influence.fap = task.fap;
  item.influences.push_back(influence);
  for (const auto& v : vertices) item.region.push_back(v.vertex);
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
  Fitter fitter(mesh, task);
  std::vector<XfaceItem> items;
  for (const Band& band : fitter.run()) {
    if (band.weight == 0) continue;
    items.push_back(item_of(task, band.fits, task.pivot,
                            {.reach = Reach::sphere, .weight = float(band.weight)}));
    add_to_region(items.back(), fitter.far());
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
  const int bands = range <= 0.02f ? 1 : std::max(1, task.most);
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

#include "fap/xml/detail/fdp_plan.h"

#include <algorithm>
#include <map>

#include "fap/xml/detail/moves.h"
#include "fap/xml/detail/regions.h"

namespace animeme::head::detail {
namespace {

constexpr int kHalfClosed = 512;   // lids
constexpr int kSmallTurn = 5000;   // 0.05 rad
constexpr int kTried = 200;        // FAP value at which the rig is asked
constexpr float kLeast = 0.01f;    // smaller factors are nothing
constexpr float kAsAWhole = 0.2f;  // parts whose vertices all move at least this share

// How much a FAP counts where a vertex has no room for all: those that recordings hardly use make
// room for the others. Source: fap/semantics.md, section 9.
float worth(int fap) {
  if (fap == 14 || fap == 15) return 0.2f;
  return fap == 27 || fap == 28 || fap == 39 || fap == 40 || fap >= 64 ? 0.5f : 1.0f;
}

bool is_lid(int fap) { return fap >= 19 && fap <= 22; }

bool is_turn(int fap) { return fap::move_of(fap).kind == fap::MoveKind::rotate; }

// The table names no point for eyeballs; their pupils are at the front.
std::string_view point_of(int fap) {
  if (fap >= 23 && fap <= 28) return fap % 2 == 1 ? "3.5" : "3.6";
  return fap::info(fap).feature_point;
}

// 0 where the size of a factor is at most `least`, itself where it is much larger, and no step in
// between, which would be seen as a crease.
float faded(float factor, float least) {
  const float share = least / std::max(std::abs(factor), least);
  return std::abs(factor) <= least ? 0 : factor * (1 - share * share * share * share);
}

// One FAP on one part.
struct Column {
  int fap = 0;
  bool waves = false;
  std::vector<float> factors;

  std::size_t cost() const { return waves ? 2 : 1; }
};

class Planner {
 public:
  Planner(const Head& head, const Rig& rig, const FdpOptions& options)
      : head_(head), rig_(rig), options_(options) {}

  FdpPlan plan() {
    for (std::size_t p = 0; p < head_.parts.size(); ++p) {
      if (head_.parts[p].triangles.empty()) continue;
      mesh_of_[p] = plan_.parts.size();
      plan_.parts.push_back(Part(p));
    }
    find_columns();
    for (std::size_t m = 0; m < plan_.parts.size(); ++m) {
      choose(m);
      fit(m);
    }
    name_items();
    return std::move(plan_);
  }

 private:
  std::span<const Vec3> positions(std::size_t mesh) const {
    return head_.part(plan_.parts[mesh]).positions;
  }

  void find_columns() {
    columns_.resize(plan_.parts.size());
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (step(fap) == 0) continue;
      // Openings of jaw and lids have one direction, the others go both ways.
      const bool one_way = fap == 3 || is_lid(fap);
      const int value = is_lid(fap) ? kHalfClosed : is_turn(fap) ? kSmallTurn : kTried;
      const auto moves = moves_between(rig_, fap, one_way ? 0 : -value, value);
      for (std::size_t m = 0; m < plan_.parts.size(); ++m) {
        const Part part = plan_.parts[m];
        const auto& of_part = moves[std::size_t(part)];
        // What lids do when eyes turn or come out is a matter of our rig, and no straight move.
        const bool eye = part == Part::left_eye || part == Part::right_eye;
        if (of_part.empty() || (fap >= 23 && fap <= 28 && !eye)) continue;
        Column column{fap, false, factors_of(fap, of_part)};
        float most = 0;
        float least = std::numeric_limits<float>::max();
        for (const float f : column.factors) {
          most = std::max(most, std::abs(f));
          least = std::min(least, std::abs(f));
        }
        if (most < 1e-3f) continue;
        for (float& f : column.factors) f = faded(f, kLeast * most);
        column.waves = least > kAsAWhole * most;
        columns_[m].push_back(std::move(column));
      }
    }
  }

  // Leaves the strongest influences of each vertex. Those that are hardly stronger than what has to
  // go are faded, so that there is no border where they end.
  void choose(std::size_t m) {
    std::vector<std::pair<float, std::size_t>> order;  // strength, column
    for (std::size_t v = 0; v < positions(m).size(); ++v) {
      order.clear();
      for (std::size_t c = 0; c < columns_[m].size(); ++c) {
        const float size = std::abs(columns_[m][c].factors[v]);
        if (size > 0) order.push_back({size * strength(columns_[m][c].fap), c});
      }
      std::stable_sort(order.begin(), order.end(),
                       [](const auto& a, const auto& b) { return a.first > b.first; });
      std::size_t used = 0;
      std::size_t kept = 0;
      while (kept < order.size() && used + columns_[m][order[kept].second].cost() <= kXfaceSlots) {
        used += columns_[m][order[kept++].second].cost();
      }
      if (kept == order.size()) continue;
      const float least = order[kept].first;
      for (const auto& [size, c] : order) {
        float& factor = columns_[m][c].factors[v];
        factor = faded(factor, least / strength(columns_[m][c].fap));
      }
      for (; kept < order.size(); ++kept) {
        columns_[m][order[kept].second].factors[v] = 0;
        ++plan_.left_out;
      }
    }
  }

  // What a factor of 1 counts.
  float strength(int fap) const {
    return worth(fap) * float(step(fap) / fap::step_size(fap, head_.fapu));
  }

  // In cm; turns do not grow with the units of the file.
  double step(int fap) const {
    return xface_step(fap, head_.fapu) / (is_turn(fap) ? options_.scale : 1);
  }

  // How far vertices should go with a FAP, in units of its direction and step.
  std::vector<float> factors_of(int fap, std::span<const Vec3> moves) const {
    const Vec3 direction = xface_direction(fap);
    std::vector<float> factors;
    for (const Vec3& move : moves) {
      // Lids go as far down or up as they should, whatever comes forward.
      const float along =
          is_lid(fap) ? move.y / direction.y : dot(move, direction) / dot(direction, direction);
      factors.push_back(along / float(step(fap)));
    }
    return factors;
  }

  std::uint32_t nearest(std::size_t m, Vec3 place) const {
    std::uint32_t best = 0;
    for (std::uint32_t v = 1; v < positions(m).size(); ++v) {
      if (length(positions(m)[v] - place) < length(positions(m)[best] - place)) best = v;
    }
    return best;
  }

  void fit(std::size_t m) {
    const RegionMesh mesh = region_mesh(positions(m));
    for (const Column& column : columns_[m]) {
      RegionTask task{.fap = column.fap, .most = options_.regions, .wanted = {}};
      for (std::uint32_t v = 0; v < column.factors.size(); ++v) {
        if (column.factors[v] != 0) task.wanted.push_back({v, column.factors[v]});
      }
      if (task.wanted.empty()) continue;
      const std::string_view id = point_of(column.fap);
      const FeaturePoint point = head_.point(id);
      const bool own = point.exists() && point.part == plan_.parts[m];
      task.exact_at_pivot = own && !is_turn(column.fap);
      if (own) {
        task.pivot = point.vertex;
        if (task.exact_at_pivot) set_exact(task);
      } else if (point.exists()) {
        task.pivot = nearest(m, head_.at(id));
      } else {
        const auto largest = std::max_element(task.wanted.begin(), task.wanted.end(),
                                              [](const Wanted& a, const Wanted& b) {
                                                return std::abs(a.factor) < std::abs(b.factor);
                                              });
        task.pivot = largest->vertex;
      }
      for (XfaceItem& item : column.waves ? fit_waves(mesh, task) : fit_regions(mesh, task)) {
        item.name = id.empty() ? std::string("FAP") + std::to_string(column.fap) : std::string(id);
        item.mesh = m;
        fitted_.push_back(std::move(item));
      }
    }
  }

  // The feature point itself moves as the table says, whatever the rig does on the way.
  void set_exact(RegionTask& task) const {
    for (Wanted& w : task.wanted) {
      if (w.vertex != task.pivot) continue;
      w.factor = float(fap::step_size(task.fap, head_.fapu) / step(task.fap));
    }
  }

  // A feature point is the first item of its name, around its own vertex. All further regions get
  // names that are none of feature points.
  void name_items() {
    std::vector<bool> taken(fitted_.size());
    for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
      const FeaturePoint point = head_.point(info.id);
      if (!point.exists() || head_.part(point.part).triangles.empty()) continue;
      const std::size_t mesh = mesh_of_[std::size_t(point.part)];
      XfaceItem first{.name = std::string(info.id),
                      .mesh = mesh,
                      .pivot = point.vertex,
                      .region = {},
                      .influences = {}};
      for (std::size_t i = 0; i < fitted_.size(); ++i) {
        const XfaceItem& item = fitted_[i];
        const bool own = item.name == info.id && item.mesh == mesh && item.pivot == point.vertex;
        if (!own || !std::binary_search(item.region.begin(), item.region.end(), point.vertex)) {
          continue;
        }
        first = item;
        taken[i] = true;
        break;
      }
      plan_.items.push_back(std::move(first));
    }
    std::map<std::string, int> counts;
    for (std::size_t i = 0; i < fitted_.size(); ++i) {
      if (taken[i]) continue;
      XfaceItem& item = fitted_[i];
      item.name += "/" + std::to_string(++counts[item.name] + 1);
      plan_.items.push_back(std::move(item));
    }
  }

  const Head& head_;
  const Rig& rig_;
  const FdpOptions& options_;
  FdpPlan plan_;
  std::array<std::size_t, kPartCount> mesh_of_ = {};
  std::vector<std::vector<Column>> columns_;  // by mesh
  std::vector<XfaceItem> fitted_;
};

}  // namespace

FdpPlan plan_fdp(const Head& head, const Rig& rig, const FdpOptions& options) {
  return Planner(head, rig, options).plan();
}

}  // namespace animeme::head::detail

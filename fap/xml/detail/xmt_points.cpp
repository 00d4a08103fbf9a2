#include "fap/xml/detail/xmt_tables.h"

#include <algorithm>
#include <cmath>

#include "fap/detail/number_text.h"

namespace animeme::head::detail {
namespace {

constexpr double kFarthest = 0.1;  // of the distance of the pupils: farther is no vertex of it
constexpr double kAsNear = 0.005;  // of it: as good as the nearest
constexpr double kWrongLip = 1;    // of scores
constexpr std::size_t kMostCandidates = 64;  // no face has more vertices in one place
constexpr double kNoTable = 0.5;

std::string shown(double length) {
  std::string text;
  fap::detail::append_significant(text, float(length), 3);
  return text;
}

// -1: the lower side of the mouth, +1: the upper one, 0: elsewhere.
int lip_of(std::string_view id) {
  if (id == "2.2" || id == "2.6" || id == "2.7") return 1;
  if (id == "2.3" || id == "2.8" || id == "2.9") return -1;
  return 0;
}

struct Candidate {
  std::size_t piece = 0;
  std::uint32_t vertex = 0;
  double distance = 0;
};

class Finder {
 public:
  explicit Finder(const XmtFace& face) : face_(face) {}

  /// All vertices that are as near as the nearest.
  std::vector<Candidate> near(const fap::Point& place) const {
    std::vector<Candidate> found;
    double least = std::numeric_limits<double>::infinity();
    const double room = kAsNear * face_.fapu.es;
    for (std::size_t i = 0; i < face_.source.pieces.size(); ++i) {
      const auto& positions = face_.source.pieces[i].mesh.positions;
      for (std::uint32_t v = 0; v < positions.size(); ++v) {
        const double distance = length(Vec3d(positions[v]) - Vec3d{place[0], place[1], place[2]});
        if (distance > least + room) continue;
        least = std::min(least, distance);
        found.push_back({i, v, distance});
      }
    }
    std::erase_if(found, [&](const Candidate& c) { return c.distance > least + room; });
    if (found.size() > kMostCandidates) found.resize(kMostCandidates);
    return found;
  }

  /// The smaller, the better.
  double score(std::string_view id, const Candidate& c) const {
    double sum = c.distance / face_.fapu.es;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const fap::Move move = fap::move_of(fap);
      if (fap::info(fap).feature_point != id || move.kind != fap::MoveKind::translate) continue;
      sum += std::min(std::abs(factor(fap, move, c) - 1), 2.0);
    }
    if (lip_of(id) != 0 && side(c) * lip_of(id) < 0) sum += kWrongLip;
    return sum;
  }

 private:
  // How far the FAP moves the vertex, 1 being as far as it should; without tables they are alike.
  double factor(int fap, const fap::Move& move, const Candidate& c) const {
    const double step = fap::step_size(fap, face_.fapu);
    Vec3d sum;
    bool known = false;
    for (const PieceTarget& target : face_.source.targets) {
      if (target.control != fap) continue;
      known = true;
      if (target.piece != c.piece || target.low > 0 || target.high <= 0) continue;
      const auto at = std::lower_bound(target.vertices.begin(), target.vertices.end(), c.vertex);
      if (at == target.vertices.end() || *at != c.vertex) continue;
      sum += Vec3d(target.deltas[std::size_t(at - target.vertices.begin())]);
    }
    const Vec3d axis{move.axis[0], move.axis[1], move.axis[2]};
    return known && step > 0 ? dot(sum, axis) / step : kNoTable;
  }

  // Above 0 if what is joined to the vertex lies above it.
  double side(const Candidate& c) const {
    const Mesh& mesh = face_.source.pieces[c.piece].mesh;
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
      if (std::find(t.begin(), t.end(), c.vertex) == t.end()) continue;
      for (const std::uint32_t v : t) {
        sum += double(mesh.positions[v].y - mesh.positions[c.vertex].y);
      }
    }
    return sum;
  }

  const XmtFace& face_;
};

}  // namespace

namespace {

void set_eye(std::size_t side, const fap::Point& pupil, XmtFace& face) {
  constexpr double kRadius = 0.19;  // of an eyeball, in distances of the pupils
  if (face.source.eyes[side]) return;
  face.source.eyes[side] = Vec3(Vec3d{pupil[0], pupil[1], pupil[2] - kRadius * face.fapu.es});
}

}  // namespace

void set_points(const fap::FeaturePoints& places, XmtFace& face) {
  const Finder finder(face);
  double farthest = 0;
  std::string farthest_id, left_out;
  for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
    const auto place = places.find(info.id);
    if (place == places.end()) continue;
    if (info.id == "7.1") {
      face.source.neck_pivot = Vec3(Vec3d{place->second[0], place->second[1], place->second[2]});
      continue;
    }
    const std::vector<Candidate> near = finder.near(place->second);
    Candidate best = near.front();
    if (near.size() > 1) {
      double least = std::numeric_limits<double>::infinity();
      for (const Candidate& c : near) {
        const double score = finder.score(info.id, c);
        if (score >= least) continue;
        least = score;
        best = c;
      }
    }
    if (best.distance > kFarthest * face.fapu.es) {
      // Without a mesh of the eye, the pupil still gives its position.
      if (info.id == "3.5" || info.id == "3.6")
        set_eye(info.id == "3.5" ? 0 : 1, place->second, face);
      left_out +=
          (left_out.empty() ? "" : ", ") + std::string(info.id) + " (" + shown(best.distance) + ")";
      continue;
    }
    face.source.points.push_back({std::string(info.id), best.piece, best.vertex});
    if (best.distance > farthest) {
      farthest = best.distance;
      farthest_id = info.id;
    }
  }
  if (farthest > 0) {
    face.source.notes.push_back("feature points are the nearest vertices; the farthest is " +
                                shown(farthest) + " units away (" + farthest_id + ")");
  }
  if (!left_out.empty()) {
    face.source.notes.push_back("no vertex is near these feature points (units): " + left_out);
  }
}

}  // namespace animeme::head::detail

#include <limits>
#include <map>

#include "fap/head/detail/look.h"
#include "fap/head/detail/own_steps.h"
#include "fap/head/detail/sided_bodies.h"

namespace animeme::head::detail {
namespace {

constexpr int kLooks = 32;
constexpr int kPixels = 320;      // of a picture
constexpr float kAround = 4.5f;   // considered radius around the middle of the head, eye distances
constexpr float kThin = 0.003f;   // eye distances: a front that is so little behind a back is seen
constexpr float kBefore = 0.2f;   // directions whose z is larger look at the face
constexpr float kInMouth = 0.5f;  // and into the mouth
constexpr int kLeastSeen = 20;    // pixels in all pictures, to judge by
constexpr double kMany = 4;       // so much more often backs are seen of what is wound wrong
constexpr double kShut = 0.15;    // of its area: less is missing to close a body
constexpr double kWhole = 0.9;    // of an area: as good as all of it

// Points where a face looks forward, whatever it is like.
constexpr std::array<std::string_view, 13> kFront = {
    "9.3", "2.10", "8.1", "8.2", "11.1", "4.1", "4.2", "5.1", "5.2", "5.3", "5.4", "9.12", "2.2"};

enum class Judgement : std::uint8_t { unknown, right, wrong };

// Triangles that hang together. They are of two classes: those of a class agree with each other
// about the front, and disagree with the other class.
struct Shell {
  std::size_t part = 0;
  std::uint32_t piece = 0;
  Vec3d sum;  // of area vectors, all as class 0 has it
  double area = 0;
  int forward = 0;  // points of the face that look forward, as class 0 has it
  int backward = 0;
  std::array<std::array<std::size_t, 2>, 2> seen = {};  // class; front, back
  std::array<double, 2> class_area = {};
  Judgement judgement = Judgement::unknown;

  std::size_t fronts() const { return seen[0][0] + seen[1][1]; }
  std::size_t backs() const { return seen[0][1] + seen[1][0]; }
  bool shut() const { return length(sum) < kShut * area; }
};

class Winding {
 public:
  Winding(Head& head, float es, const PieceOfTriangle& pieces)
      : head_(head), es_(es), pieces_(pieces) {}

  std::vector<TurnedPiece> run() {
    for (std::size_t part = 0; part < kPartCount; ++part) find_bodies(part);
    ask_face();
    for (int i = 0; i < kLooks; ++i) {
      const Vec3 from = side_of_sphere(i, kLooks);
      look(from, {});
      // The mouth may be shut, but what is in it was made to be seen when it opens.
      for (const Part inner : {Part::upper_teeth, Part::lower_teeth, Part::tongue}) {
        if (from.z > kInMouth) look(from, inner);
      }
    }
    for (Shell& body : bodies_) judge(body);
    judge_sheets();
    follow_the_rest();
    return turn();
  }

 private:
  struct Seen {
    float depth = std::numeric_limits<float>::lowest();
    SidedTriangle who;
  };
  Vec3 corner(std::size_t part, std::size_t t, std::size_t k) const {
    const Mesh& mesh = head_.parts[part];
    return mesh.positions[mesh.triangles[t][k]];
  }

  void find_bodies(std::size_t part) {
    members_[part] = sided_bodies(head_.parts[part]);
    const auto first = std::uint32_t(bodies_.size());
    for (std::uint32_t t = 0; t < members_[part].size(); ++t) {
      SidedTriangle& member = members_[part][t];
      if (member.body == kNobody) continue;
      member.body += first;
      if (member.body >= bodies_.size()) {
        bodies_.resize(member.body + 1);
        bodies_.back().part = part;
        bodies_.back().piece = pieces_[part][t];
      }
      measure(part, t, bodies_[member.body]);
    }
  }

  void measure(std::size_t part, std::uint32_t t, Shell& body) {
    const Vec3d a(corner(part, t, 0)), b(corner(part, t, 1)), c(corner(part, t, 2));
    const bool other = members_[part][t].other;
    const Vec3d area = cross(b - a, c - a) * (other ? -0.5 : 0.5);
    body.sum += area;
    body.area += length(area);
    body.class_area[other ? 1 : 0] += length(area);
  }

  void ask_face() {
    for (const std::string_view id : kFront) {
      const FeaturePoint point = head_.point(id);
      if (!point.exists()) continue;
      const auto part = std::size_t(point.part);
      std::map<std::uint32_t, Vec3> normals;  // by body, as its class 0 has it
      for (std::size_t t = 0; t < members_[part].size(); ++t) {
        const Triangle& corners = head_.parts[part].triangles[t];
        const SidedTriangle& member = members_[part][t];
        if (member.body == kNobody ||
            std::find(corners.begin(), corners.end(), point.vertex) == corners.end()) {
          continue;
        }
        const Vec3 a = corner(part, t, 0);
        normals[member.body] +=
            cross(corner(part, t, 1) - a, corner(part, t, 2) - a) * (member.other ? -1.0f : 1.0f);
      }
      for (const auto& [body, normal] : normals) {
        const float z = normalised(normal).z;
        if (z > 0.3f) ++bodies_[body].forward;
        if (z < -0.3f) ++bodies_[body].backward;
      }
    }
  }

  // The nearest front and the nearest back at each pixel, of all parts or of one.
  void look(Vec3 from, std::optional<Part> only) {
    const Look look(from, kAround * es_, kPixels);
    std::array<std::vector<Seen>, 2> pictures;
    for (auto& picture : pictures) picture.resize(std::size_t(kPixels) * kPixels);
    for (std::size_t part = 0; part < kPartCount; ++part) {
      if (only && *only != Part(part)) continue;
      const Mesh& mesh = head_.parts[part];
      const std::vector<Vec3> places = look.places(mesh.positions);
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& corners = mesh.triangles[t];
        const Vec3 a = places[corners[0]], b = places[corners[1]], c = places[corners[2]];
        const bool back = (b.x - a.x) * (c.y - a.y) < (b.y - a.y) * (c.x - a.x);
        std::vector<Seen>& picture = pictures[back ? 1 : 0];
        look.draw(a, b, c, [&](std::size_t i, float z) {
          if (z > picture[i].depth) picture[i] = {z, members_[part][t]};
        });
      }
    }
    for (std::size_t i = 0; i < pictures[0].size(); ++i) {
      const bool back = pictures[1][i].depth > pictures[0][i].depth + kThin * es_;
      const SidedTriangle& who = pictures[back ? 1 : 0][i].who;
      if (who.body == kNobody) continue;
      Shell& body = bodies_[who.body];
      // From behind a face is seen through, if it is a mask.
      if (from.z < kBefore && is_face(Part(body.part))) continue;
      ++body.seen[who.other ? 1 : 0][back ? 1 : 0];
    }
  }

  static bool is_face(Part part) { return part != Part::hair && part != Part::body; }

  static Judgement judged(std::size_t fronts, std::size_t backs) {
    if (fronts + backs < kLeastSeen) return Judgement::unknown;
    if (double(backs) > kMany * double(fronts)) return Judgement::wrong;
    return fronts > 2 * backs ? Judgement::right : Judgement::unknown;
  }

  void judge(Shell& body) const {
    const Judgement by_sight = judged(body.fronts(), body.backs());
    if (body.forward >= 3 && body.backward == 0) {
      body.judgement = Judgement::right;
    } else if (body.backward >= 3 && body.forward == 0 && by_sight != Judgement::right) {
      body.judgement = Judgement::wrong;
    } else if (body.shut()) {
      body.judgement = by_sight;
    }
  }

  // Inner cards of hair show their back alone, so that all hair is one.
  std::uint32_t group_of(const Shell& body) const {
    return Part(body.part) == Part::hair ? kNobody : body.piece;
  }

  void judge_sheets() {
    const auto is_sheet = [](const Shell& body) {
      return body.judgement == Judgement::unknown && !body.shut();
    };
    std::map<std::uint32_t, std::array<std::size_t, 2>> seen;
    for (const Shell& body : bodies_) {
      if (!is_sheet(body)) continue;
      seen[group_of(body)][0] += body.fronts();
      seen[group_of(body)][1] += body.backs();
    }
    for (Shell& body : bodies_) {
      if (!is_sheet(body) || body.fronts() + body.backs() == 0) continue;
      const auto& [fronts, backs] = seen[group_of(body)];
      body.judgement = judged(fronts, backs);
    }
  }

  // What could not be judged is as the rest of its piece, if that is wrong as a whole. Pieces
  // without a judgement are as all others are, if these agree.
  void follow_the_rest() {
    struct Areas {
      double right = 0;
      double wrong = 0;
      bool known() const { return right + wrong > 0; }
      bool all_wrong() const { return wrong > kWhole * (wrong + right); }
    };
    std::map<std::uint32_t, Areas> pieces;
    for (const Shell& body : bodies_) {
      Areas& areas = pieces[body.piece];
      if (body.judgement == Judgement::right) areas.right += body.area;
      if (body.judgement == Judgement::wrong) areas.wrong += body.area;
    }
    int known = 0;
    int wrong = 0;
    for (const auto& [piece, areas] : pieces) {
      known += areas.known() ? 1 : 0;
      wrong += areas.all_wrong() ? 1 : 0;
    }
    const bool all_wrong = known >= 2 && wrong == known;
    for (Shell& body : bodies_) {
      if (body.judgement != Judgement::unknown) continue;
      const Areas& own = pieces[body.piece];
      if (own.known() ? own.all_wrong() : all_wrong) body.judgement = Judgement::wrong;
    }
  }

  // Whether a class of a body is to be turned: never against what is seen of it, and the smaller
  // one not unseen.
  bool turns(const Shell& body, bool other) const {
    if (body.judgement == Judgement::unknown) return false;
    if ((body.judgement == Judgement::wrong) == other) return false;
    const auto& [fronts, backs] = body.seen[other ? 1 : 0];
    const bool larger = body.class_area[other ? 1 : 0] >= body.class_area[other ? 0 : 1];
    if (larger && fronts + backs < kLeastSeen) return true;
    return larger ? fronts <= 2 * backs : backs > fronts;
  }

  void turn(std::size_t part, std::size_t t) {
    Mesh& mesh = head_.parts[part];
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    if (!mesh.facets.empty()) std::swap(mesh.facets[t][1], mesh.facets[t][2]);
  }

  std::vector<TurnedPiece> turn() {
    std::map<std::uint32_t, TurnedPiece> found;
    std::map<std::uint32_t, std::vector<std::array<std::size_t, 2>>> without;  // a side of its own
    for (std::size_t part = 0; part < kPartCount; ++part) {
      for (std::size_t t = 0; t < members_[part].size(); ++t) {
        TurnedPiece& piece = found[pieces_[part][t]];
        piece.piece = pieces_[part][t];
        ++piece.triangles;
        const SidedTriangle& member = members_[part][t];
        if (member.body == kNobody) {
          without[pieces_[part][t]].push_back({part, t});
        } else if (turns(bodies_[member.body], member.other)) {
          turn(part, t);
          ++piece.turned;
        }
      }
    }
    std::vector<TurnedPiece> out;
    for (auto& [piece, turned] : found) {
      if (turned.turned == 0) continue;
      if (turned.turned + without[piece].size() == turned.triangles) {
        for (const auto& [part, t] : without[piece]) turn(part, t);
        turned.turned = turned.triangles;
      }
      out.push_back(turned);
    }
    return out;
  }

  Head& head_;
  float es_;
  const PieceOfTriangle& pieces_;
  std::array<std::vector<SidedTriangle>, kPartCount> members_;  // by triangle
  std::vector<Shell> bodies_;
};

}  // namespace

std::vector<TurnedPiece> turn_inside_out(Head& head, float es, const PieceOfTriangle& pieces) {
  return Winding(head, es, pieces).run();
}

}  // namespace animeme::head::detail

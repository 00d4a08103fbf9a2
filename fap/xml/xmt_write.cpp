#include <algorithm>
#include <span>

#include "fap/detail/number_text.h"
#include "fap/head/srgb.h"
#include "fap/xml/detail/moves.h"
#include "fap/xml/xmt.h"

namespace animeme::head {
namespace {

using fap::detail::append_significant;

constexpr float kLeast = 0.002f;  // smaller displacements are nothing, in FAPU
constexpr int kDigits = 4;
constexpr float kNone = 3.4e38f;  // for places of points that the head does not have
// Straight moves: one interval from 0. Borders have to be in it; the second says no more.
constexpr std::array<int, 2> kStraight = {0, 1024};
// Lids slide over a ball.
constexpr std::array<int, 4> kSliding = {-512, 0, 512, 1024};

class XmtWriter {
 public:
  XmtWriter(const Head& head, const Rig& rig) : head_(head), rig_(rig) {}

  std::string write() {
    text_ =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<XMT-A "
        "xmlns=\"urn:mpeg:mpeg4:xmta:schema:2002\">\n<Header>\n</Header>\n<Body>\n<Replace>\n"
        "<Scene>\n<Group>\n<children>\n<Face>\n<fdp>\n<FDP>\n";
    add_points();
    text_ += "<faceSceneGraph>\n";
    for (std::size_t p = 0; p < head_.parts.size(); ++p) add_shape(p);
    text_ += "</faceSceneGraph>\n<faceDefTables>\n";
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) add_tables(fap);
    text_ +=
        "</faceDefTables>\n</FDP>\n</fdp>\n</Face>\n</children>\n</Group>\n</Scene>\n</Replace>\n"
        "</Body>\n</XMT-A>\n";
    return std::move(text_);
  }

 private:
  void add(float value) { append_significant(text_, value, kDigits); }
  void add(Vec3 v) {
    add(v.x);
    text_ += ' ';
    add(v.y);
    text_ += ' ';
    add(v.z);
  }
  void add_colour(Vec3 linear) {
    const Vec3 c = srgb_of_linear(linear);
    for (const float x : {c.x, c.y, c.z}) {
      append_significant(text_, x, 3);
      text_ += ' ';
    }
  }
  static std::string name(std::size_t part) { return std::string(kPartNames[part]); }

  void add_points() {
    text_ += "<featurePointsCoord>\n<Coordinate point=\"";
    for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
      const bool known = info.id == "7.1" || head_.point(info.id).exists();
      add(known ? head_.at(info.id) : Vec3{kNone, kNone, kNone});
      text_ += '\n';
    }
    text_ += "\"/>\n</featurePointsCoord>\n";
  }

  // Eyes are in a Transform that turns them about their centre.
  void add_shape(std::size_t p) {
    const Mesh& mesh = head_.parts[p];
    if (mesh.triangles.empty()) return;
    const Part part = Part(p);
    const bool eye = part == Part::left_eye || part == Part::right_eye;
    if (eye) {
      text_ += "<Transform DEF=\"" + name(p) + "_turn\" center=\"";
      add(head_.eyes[part == Part::left_eye ? 0 : 1].centre);
      text_ += "\">\n<children>\n";
    }
    text_ += "<Shape DEF=\"" + name(p) + "\">\n";
    add_material(mesh);
    text_ += "<geometry>\n<IndexedFaceSet DEF=\"" + name(p) + "_faces\" coordIndex=\"";
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) text_ += std::to_string(v) + " ";
      text_ += "-1\n";
    }
    text_ += "\">\n<coord>\n<Coordinate point=\"";
    for (const Vec3& v : mesh.positions) {
      add(v);
      text_ += '\n';
    }
    text_ += "\"/>\n</coord>\n";
    if (mesh.colours.size() == mesh.positions.size()) {
      text_ += "<color>\n<Color color=\"";
      for (const Vec3& c : mesh.colours) {
        add_colour(c);
        text_ += '\n';
      }
      text_ += "\"/>\n</color>\n";
    }
    text_ += "</IndexedFaceSet>\n</geometry>\n</Shape>\n";
    if (eye) text_ += "</children>\n</Transform>\n";
  }

  void add_material(const Mesh& mesh) {
    if (mesh.colours.empty()) return;
    Vec3 sum;
    for (const Vec3& c : mesh.colours) sum += c;
    text_ += "<appearance>\n<Appearance>\n<material>\n<Material diffuseColor=\"";
    add_colour(sum * (1 / float(mesh.colours.size())));
    text_ += "\"/>\n</material>\n</Appearance>\n</appearance>\n";
  }

  void add_tables(int fap) {
    const std::size_t begin = text_.size();
    text_ += "<FaceDefTables fapID=\"" + std::to_string(fap) + "\">\n";
    const std::size_t start = text_.size();
    if (fap >= 23 && fap <= 28) {
      add_eye(fap);
    } else if (fap < 48 || fap > 50) {
      add_meshes(fap);
    }
    if (text_.size() == start) {
      text_.resize(begin);
    } else {
      text_ += "</FaceDefTables>\n";
    }
  }

  void add_eye(int fap) {
    const std::size_t part = std::size_t(fap % 2 == 1 ? Part::left_eye : Part::right_eye);
    if (head_.parts[part].triangles.empty()) return;
    const fap::Move move = fap::move_of(fap);
    const Vec3 axis(Vec3d{move.axis[0], move.axis[1], move.axis[2]});
    text_ += "<faceDefTransform>\n<FaceDefTransform ";
    if (move.kind == fap::MoveKind::rotate) {
      text_ += "rotationDef=\"";
      add(axis);
      text_ += " 1\">\n";
    } else {
      text_ += "translationDef=\"";
      add(axis);
      text_ += "\">\n";
    }
    text_ += "<faceSceneGraphNode>\n<Transform USE=\"" + name(part) +
             "_turn\"/>\n</faceSceneGraphNode>\n</FaceDefTransform>\n</faceDefTransform>\n";
  }

  void add_meshes(int fap) {
    const float step = float(fap::step_size(fap, head_.fapu));
    if (step <= 0) return;
    const bool lid = fap >= 19 && fap <= 22;
    const std::span<const int> borders =
        lid ? std::span<const int>(kSliding) : std::span<const int>(kStraight);
    using Moves = std::array<std::vector<Vec3>, kPartCount>;
    std::vector<Moves> intervals;
    for (std::size_t i = 1; i < borders.size(); ++i) {
      // What goes both ways is tried both ways.
      const int from = lid || fap == 3 ? borders[i - 1] : -kTried;
      const int to = lid ? borders[i] : kTried;
      intervals.push_back(detail::moves_between(rig_, fap, from, to));
    }
    const std::size_t before = text_.size();
    text_ += "<faceDefMesh>\n";
    const std::size_t start = text_.size();
    for (std::size_t p = 0; p < head_.parts.size(); ++p) {
      std::vector<const std::vector<Vec3>*> of_part;
      for (const Moves& moves : intervals) of_part.push_back(&moves[p]);
      add_mesh(p, step, borders, of_part);
    }
    if (text_.size() == start) {
      text_.resize(before);
    } else {
      text_ += "</faceDefMesh>\n";
    }
  }

  void add_mesh(std::size_t part, float step, std::span<const int> borders,
                const std::vector<const std::vector<Vec3>*>& intervals) {
    std::string indices, moves;
    for (std::size_t v = 0; v < head_.parts[part].positions.size(); ++v) {
      float largest = 0;
      for (const auto* of_part : intervals) {
        if (!of_part->empty()) largest = std::max(largest, length((*of_part)[v]));
      }
      if (largest <= kLeast * step) continue;
      indices += std::to_string(v) + " ";
      for (const auto* of_part : intervals) {
        const Vec3 d = of_part->empty() ? Vec3{} : (*of_part)[v] * (1 / step);
        for (const float x : {d.x, d.y, d.z}) {
          // Digits beyond those of the largest move say nothing.
          append_significant(moves, std::abs(x) < 1e-4f ? 0 : x, kDigits);
          moves += ' ';
        }
      }
      moves += '\n';
    }
    if (indices.empty()) return;
    text_ += "<FaceDefMesh intervalBorders=\"";
    for (const int b : borders) text_ += std::to_string(b) + " ";
    text_ += "\" coordIndex=\"" + indices + "\" displacements=\"" + moves +
             "\">\n<faceSceneGraphNode>\n<IndexedFaceSet USE=\"" + name(part) +
             "_faces\"/>\n</faceSceneGraphNode>\n</FaceDefMesh>\n";
  }

  static constexpr int kTried = 200;

  const Head& head_;
  const Rig& rig_;
  std::string text_;
};

}  // namespace

Result<std::string> write_xmt(const Head& head, const Rig& rig) {
  if (auto good = detail::check_writable(head, rig); !good) return good.error();
  fap::FeaturePoints places;
  for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
    const Vec3 p = head.at(info.id);
    if (head.point(info.id).exists()) places[std::string(info.id)] = {p.x, p.y, p.z};
  }
  if (const auto fapu = fap::measure_fapu(places); !fapu) return fapu.error();
  return XmtWriter(head, rig).write();
}

}  // namespace animeme::head

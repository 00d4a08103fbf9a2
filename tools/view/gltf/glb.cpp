#include "tools/view/gltf/glb.h"

#include <algorithm>
#include <optional>

#include "tools/view/gltf/detail/bones.h"
#include "tools/view/gltf/detail/glb_buffer.h"
#include "tools/view/gltf/detail/morphs.h"

namespace animeme::gltf {
namespace {

using head::Part;
using head::Vec3;

constexpr int kNeckNode = 1;  // node 0 is the foot of the skeleton

constexpr int node_of(Bone bone) { return kNeckNode + int(bone); }

// The bone that carries a part; nothing: the scene does.
std::optional<Bone> carrier_of(const head::Rig& rig, Part part) {
  if (part == Part::skin || part == Part::body) return std::nullopt;
  if (rig.shown_by_shapes[std::size_t(part)]) return Bone::neck;
  switch (part) {
    case Part::left_eye:
      return Bone::left_eye;
    case Part::right_eye:
      return Bone::right_eye;
    case Part::lower_teeth:
    case Part::tongue:
      return Bone::jaw;
    default:
      return Bone::neck;
  }
}

// Name and roughness, in the order of head::SurfaceKind.
constexpr std::pair<const char*, double> kMaterials[] = {
    {"skin", 0.6}, {"eye", 0.1}, {"teeth", 0.3}, {"wet", 0.25}, {"hair", 0.5}, {"cloth", 0.9}};

Json material_of(head::SurfaceKind material) {
  const auto& [name, roughness] = kMaterials[std::size_t(material)];
  return {{"name", name},
          {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}}};
}

class Writer {
 public:
  Writer(const head::Head& head, const head::Rig& rig, const fap::Sequence& clip,
         const GlbOptions& options)
      : head_(head), rig_(rig), clip_(clip), options_(options) {}

  Result<std::vector<std::uint8_t>> write() {
    morphs_ = make_morphs(rig_, options_);
    report(0.3);
    weights_ = morph_weights(rig_, clip_, morphs_, options_.morphs, options_.visemes);
    report(0.6);
    add_bones();
    for (std::size_t part = 0; part < head_.parts.size(); ++part) add_part(part);
    add_animation();
    report(0.9);
    Result<std::vector<std::uint8_t>> file = pack();
    report(1);
    return file;
  }

 private:
  void report(double done) const {
    if (options_.progress) options_.progress(done);
  }

  void add_bones() {
    nodes_.push_back({{"name", "root"}, {"children", {kNeckNode}}});
    const auto rest = bones_of(rig_, head::pose(rig_, {}));
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const Vec3 place = rest[i].place;
      nodes_.push_back({{"name", kBoneNames[i]}, {"translation", {place.x, place.y, place.z}}});
    }
    nodes_[kNeckNode]["children"] = {node_of(Bone::jaw), node_of(Bone::left_eye),
                                     node_of(Bone::right_eye)};
    scene_.push_back(0);
  }

  Json skin_attributes(std::size_t count) {
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (std::size_t v = 0; v < count; ++v) {
      const float turn = v < rig_.neck_weights.size() ? rig_.neck_weights[v] : 1;
      // A joint without weight has to be number 0.
      const std::uint8_t neck = turn > 0 ? 1 : 0;
      joints.insert(joints.end(), {0, neck, 0, 0});
      weights.insert(weights.end(), {1 - turn, turn, 0, 0});
    }
    return {{"JOINTS_0", buffer_.joints(joints)},
            {"WEIGHTS_0", buffer_.floats(weights, 4, BufferUse::vertices)}};
  }

  // All bones are joints, also those that no vertex of the skin follows: Blender makes bones of
  // joints alone, and loses what hangs on other nodes below them when it exports.
  int skeleton() {
    std::vector<float> inverse;
    Json joints = Json::array();
    const auto add = [&](int node, Vec3 pivot) {
      joints.push_back(node);
      inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
      inverse.insert(inverse.end(), {-pivot.x, -pivot.y, -pivot.z, 1});
    };
    add(0, {});
    for (int bone = 0; bone < kBoneCount; ++bone) {
      add(node_of(Bone(bone)), pivot_of(rig_, Bone(bone)) * kMetres);
    }
    skins_.push_back({{"joints", joints},
                      {"skeleton", 0},
                      {"inverseBindMatrices", buffer_.floats(inverse, 16, BufferUse::other)}});
    return int(skins_.size()) - 1;
  }

  void add_part(std::size_t number) {
    const Part part = Part(number);
    const head::Mesh& mesh = head_.parts[number];
    if (mesh.positions.empty() || mesh.triangles.empty()) return;
    const std::optional<Bone> carrier = carrier_of(rig_, part);
    const Vec3 origin = carrier ? pivot_of(rig_, *carrier) : Vec3{};
    std::vector<Vec3> places;
    for (const Vec3& v : rig_.parts[number].positions) places.push_back((v - origin) * kMetres);
    Json attributes = part == Part::skin ? skin_attributes(places.size()) : Json::object();
    attributes["POSITION"] = buffer_.vectors(places, BufferUse::vertices, true);
    attributes["NORMAL"] =
        buffer_.vectors(unit_normals(rig_.parts[number].normals), BufferUse::vertices, false);
    attributes["COLOR_0"] = buffer_.colours(shaded(mesh));
    std::vector<std::uint32_t> indices;
    for (const head::Triangle& triangle : mesh.triangles) {
      indices.insert(indices.end(), triangle.begin(), triangle.end());
    }
    Json primitive = {{"attributes", attributes},
                      {"indices", buffer_.triangles(indices)},
                      {"material", material(mesh.surface)}};
    Json out = {{"name", head::kPartNames[number]}};
    add_morphs(number, places.size(), primitive, out);
    out["primitives"] = Json::array({primitive});
    meshes_.push_back(std::move(out));
    Json node = {{"name", head::kPartNames[number]}, {"mesh", meshes_.size() - 1}};
    if (part == Part::skin) node["skin"] = skeleton();
    nodes_.push_back(std::move(node));
    const int index = int(nodes_.size()) - 1;
    if (carrier) {
      nodes_[std::size_t(node_of(*carrier))]["children"].push_back(index);
    } else {
      scene_.push_back(index);
    }
    if (!used_[number].empty()) morphed_.emplace_back(number, index);
  }

  // Vertices of triangles without area have none, which glTF does not want.
  static std::vector<Vec3> unit_normals(std::vector<Vec3> normals) {
    for (Vec3& n : normals) {
      if (!(head::length(n) > 0.9f)) n = {0, 0, 1};
    }
    return normals;
  }

  // Players have no baked light: hollows are darkened by colour.
  static std::vector<Vec3> shaded(const head::Mesh& mesh) {
    std::vector<Vec3> colours = mesh.colours;
    for (std::size_t v = 0; v < std::min(colours.size(), mesh.occlusion.size()); ++v) {
      colours[v] *= 0.4f + 0.6f * mesh.occlusion[v];
    }
    return colours;
  }

  int material(head::SurfaceKind wanted) {
    const Json entry = material_of(wanted);
    for (std::size_t i = 0; i < materials_.size(); ++i) {
      if (materials_[i] == entry) return int(i);
    }
    materials_.push_back(entry);
    return int(materials_.size()) - 1;
  }

  void add_morphs(std::size_t part, std::size_t vertices, Json& primitive, Json& mesh) {
    Json targets = Json::array();
    Json names = Json::array();
    for (std::size_t m = 0; m < morphs_.size(); ++m) {
      const PartMove& move = morphs_[m].parts[part];
      if (move.vertices.empty()) continue;
      std::vector<Vec3> steps = move.moves;
      for (Vec3& step : steps) step *= kMetres;
      Json target = {{"POSITION", buffer_.sparse(vertices, move.vertices, steps)}};
      if (!move.turns.empty()) {
        target["NORMAL"] = buffer_.sparse(vertices, move.vertices, move.turns);
      }
      targets.push_back(std::move(target));
      names.push_back(morphs_[m].name);
      used_[part].push_back(m);
    }
    if (targets.empty()) return;
    mesh["weights"] = std::vector<int>(targets.size(), 0);
    mesh["extras"] = {{"targetNames", names}};
    primitive["targets"] = std::move(targets);
  }

  void add_channel(int input, int output, int node, const char* path) {
    samplers_.push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
    channels_.push_back(
        {{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  void add_animation() {
    std::vector<float> times;
    std::array<std::vector<float>, kBoneCount> turns;
    std::array<std::vector<Vec3>, kBoneCount> places;
    head::Pose pose;
    for (const fap::Frame& frame : clip_.frames) {
      times.push_back(float(clip_.rate.seconds(double(frame.number - clip_.frames[0].number))));
      head::pose(rig_, frame, pose);
      const auto keys = bones_of(rig_, pose);
      for (std::size_t i = 0; i < keys.size(); ++i) {
        turns[i].insert(turns[i].end(), keys[i].rotation.begin(), keys[i].rotation.end());
        places[i].push_back(keys[i].place);
      }
    }
    const int input = buffer_.floats(times, 1, BufferUse::other, true);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const int node = kNeckNode + int(i);
      add_channel(input, buffer_.floats(turns[i], 4, BufferUse::other), node, "rotation");
      add_channel(input, buffer_.vectors(places[i], BufferUse::other, false), node, "translation");
    }
    for (const auto& [part, node] : morphed_) {
      std::vector<float> values;
      for (const std::vector<float>& row : weights_) {
        for (const std::size_t m : used_[part]) values.push_back(row[m]);
      }
      add_channel(input, buffer_.floats(values, 1, BufferUse::other), node, "weights");
    }
  }

  Result<std::vector<std::uint8_t>> pack() {
    Json scene = {{"nodes", scene_}};
    if (!options_.audio.empty()) scene["extras"] = {{"audio", options_.audio}};
    Json root = {{"asset", {{"version", "2.0"}, {"generator", "animeme"}}},
                 {"scene", 0},
                 {"scenes", Json::array({scene})},
                 {"nodes", nodes_},
                 {"meshes", meshes_},
                 {"skins", skins_},
                 {"materials", materials_},
                 {"animations",
                  {{{"name", options_.name.empty() ? "talk" : options_.name},
                    {"samplers", samplers_},
                    {"channels", channels_}}}},
                 {"accessors", std::move(buffer_.accessors)},
                 {"bufferViews", std::move(buffer_.views)}};
    if (skins_.empty()) root.erase("skins");
    return buffer_.file(std::move(root));
  }

  const head::Head& head_;
  const head::Rig& rig_;
  const fap::Sequence& clip_;
  const GlbOptions& options_;
  GlbBuffer buffer_;
  std::vector<Morph> morphs_;
  std::vector<std::vector<float>> weights_;                      // frame by frame
  std::array<std::vector<std::size_t>, head::kPartCount> used_;  // morphs of a part
  std::vector<std::pair<std::size_t, int>> morphed_;             // part, node
  Json nodes_ = Json::array();
  Json scene_ = Json::array();
  Json meshes_ = Json::array();
  Json skins_ = Json::array();
  Json materials_ = Json::array();
  Json samplers_ = Json::array();
  Json channels_ = Json::array();
};

}  // namespace

Result<std::vector<std::uint8_t>> make_glb(const head::Head& head, const head::Rig& rig,
                                           const fap::Sequence& clip, const GlbOptions& options) {
  if (clip.frames.empty() || !clip.rate.valid()) {
    return make_error(Code::invalid_argument, "there is no motion to export");
  }
  return Writer(head, rig, clip, options).write();
}

}  // namespace animeme::gltf

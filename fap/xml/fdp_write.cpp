#include <algorithm>
#include <cmath>

#include "fap/detail/number_text.h"
#include "fap/head/wrl.h"
#include "fap/xml/detail/colour_plane.h"
#include "fap/xml/detail/fdp_keyframes.h"
#include "fap/xml/detail/fdp_plan.h"
#include "fap/xml/detail/moves.h"
#include "fap/xml/fdp.h"

namespace animeme::head {
namespace {

using detail::FdpKeyframe;
using detail::FdpPlan;
using detail::XfaceItem;
using fap::detail::append_shortest;

constexpr std::string_view kNameLetters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

bool is_file_name(std::string_view name) {
  return !name.empty() && name.size() <= 200 && name.front() != '-' &&
         name.find_first_not_of(kNameLetters) == name.npos;
}

Result<void> check(const Head& head, const Rig& rig, const FdpOptions& options) {
  const auto refuse = [](std::string message) {
    return make_error(Code::invalid_argument, std::move(message));
  };
  if (!is_file_name(options.name)) {
    return refuse("the name of an .fdp file has letters, digits, '-' and '_'");
  }
  if (!(options.scale > 0 && options.scale <= 1e6)) return refuse("the scale has to be in 0..1e6");
  if (options.regions < 1 || options.regions > 100) return refuse("regions have to be in 1..100");
  if (auto good = detail::check_writable(head, rig); !good) return good;
  for (std::size_t p = 0; p < head.parts.size(); ++p) {
    if (head.parts[p].positions.size() > detail::kXfaceMostVertices) {
      return make_error(Code::out_of_range, "the " + std::string(kPartNames[p]) +
                                                " has more than 65536 vertices, more than Xface "
                                                "can count; make the mesh coarser");
    }
  }
  return {};
}

constexpr std::pair<Part, std::string_view> kBindings[] = {
    {Part::hair, "Hair"},
    {Part::left_eye, "LeftEye"},
    {Part::right_eye, "RightEye"},
    {Part::lower_teeth, "LowerTeeth"},
    {Part::upper_teeth, "UpperTeeth"},
    {Part::tongue, "Tongue"},
};

std::string_view binding_of(Part part) {
  for (const auto& [bound, name] : kBindings)
    if (bound == part) return name;
  return {};
}

constexpr const char* kStill = "_still";

// Whether a part of the plan is in the file of those that no keyframe moves.
bool stays(std::span<const FdpKeyframe> keyframes, std::size_t mesh) {
  return !keyframes.empty() && keyframes.front().positions[mesh].empty();
}
bool any_stays(std::span<const FdpKeyframe> keyframes, const FdpPlan& plan) {
  for (std::size_t m = 0; m < plan.parts.size(); ++m)
    if (stays(keyframes, m)) return true;
  return false;
}

class FdpWriter {
 public:
  FdpWriter(const Head& head, const FdpPlan& plan, std::span<const FdpKeyframe> keyframes,
            const FdpOptions& options)
      : head_(head),
        plan_(plan),
        keyframes_(keyframes),
        options_(options),
        scale_(float(options.scale)) {}

  std::string write() {
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\" ?>\n<xfdp>\n";
    add_header();
    add_source();
    for (const XfaceItem& item : plan_.items) add_item(item);
    text_ += "</xfdp>\n";
    return std::move(text_);
  }

 private:
  void add(std::string_view name, double value) {
    text_ += " " + std::string(name) + "=\"";
    append_shortest(text_, float(value));
    text_ += "\"";
  }
  std::string submesh(std::size_t mesh) const {
    const auto same_file = [&](std::size_t m) {
      return stays(keyframes_, m) == stays(keyframes_, mesh);
    };
    std::size_t number = 0;
    for (std::size_t m = 0; m < mesh; ++m) number += same_file(m) ? 1 : 0;
    return options_.name + (stays(keyframes_, mesh) ? kStill : "") + ".wrl_" +
           std::to_string(number);
  }

  void add_header() {
    text_ += "  <head>\n    <file version=\"0.2\"/>\n    <fapu";
    const fap::Fapu& f = head_.fapu;
    add("ENS0", f.ens * options_.scale);
    add("ES0", f.es * options_.scale);
    add("IRISD0", f.irisd * options_.scale);
    add("MNS0", f.mns * options_.scale);
    add("MW0", f.mw * options_.scale);
    // Where Xface puts the head before its camera: as far away as its own heads.
    text_ += "/>\n    <translation";
    add("x", 0);
    add("y", 0.5 * f.es * options_.scale);
    add("z", -9.5 * f.es * options_.scale);
    text_ +=
        "/>\n    <rotation axis_angle=\"0\" axis_x=\"0\" axis_y=\"1\" axis_z=\"0\"/>\n  </head>\n";
  }

  void add_source() {
    text_ += "  <source>\n    <entity alias=\"Rest\" category=\"Expression\">\n";
    add_meshes_of("");
    for (std::size_t m = 0; m < plan_.parts.size(); ++m) {
      const Part part = plan_.parts[m];
      if (binding_of(part).empty()) continue;
      text_ += "      <bind item=\"" + std::string(binding_of(part)) + "\"";
      if (part == Part::left_eye || part == Part::right_eye) {
        // Xface shifts by the pivot to come back from the centre.
        const Vec3 c = head_.eyes[part == Part::left_eye ? 0 : 1].centre * -scale_;
        add("pivotX", c.x);
        add("pivotY", c.y);
        add("pivotZ", c.z);
      }
      text_ += " submesh=\"" + submesh(m) + "\"/>\n";
    }
    text_ += "    </entity>\n";
    for (const FdpKeyframe& keyframe : keyframes_) {
      text_ += "    <entity alias=\"" + std::string(keyframe.alias) + "\" category=\"" +
               std::string(keyframe.category) + "\">\n";
      add_meshes_of("_" + std::string(keyframe.alias));
      text_ += "    </entity>\n";
    }
    text_ += "  </source>\n";
  }

  // Xface pairs the meshes of two entities by their order.
  void add_meshes_of(const std::string& suffix) {
    add_mesh(suffix);
    if (any_stays(keyframes_, plan_)) add_mesh(kStill);
  }
  void add_mesh(std::string_view suffix) {
    text_ +=
        "      <mesh file=\"" + options_.name + std::string(suffix) + ".wrl\" format=\"wrl\"/>\n";
  }

  void add_item(const XfaceItem& item) {
    text_ += "  <fdp affects=\"" + submesh(item.mesh) + "\" index=\"" + std::to_string(item.pivot) +
             "\" name=\"" + item.name + "\">\n";
    if (!item.region.empty()) {
      text_ += "    <indices>";
      for (const std::uint32_t v : item.region) text_ += std::to_string(v) + " ";
      text_ += "</indices>\n";
    }
    for (const detail::XfaceInfluence& influence : item.influences) {
      text_ += "    <influence fap=\"" + std::to_string(influence.fap - 1) + "\" type=\"" +
               std::string(detail::kReachNames[std::size_t(influence.reach)]) + "\"";
      add("weight", influence.weight);
      text_ += "/>\n";
    }
    text_ += "  </fdp>\n";
  }

  const Head& head_;
  const FdpPlan& plan_;
  std::span<const FdpKeyframe> keyframes_;
  const FdpOptions& options_;
  float scale_;
  std::string text_;
};

struct MeshFile {
  std::vector<Piece> pieces;
  std::vector<PieceTexture> textures;

  void add(Piece piece, PieceTexture texture) {
    pieces.push_back(std::move(piece));
    textures.push_back(std::move(texture));
  }
  std::string text() const { return write_wrl(pieces, textures); }
};

// A thousandth of a unit is enough for a mesh that is morphed to, and shorter.
Vec3 rounded(Vec3 p) {
  const auto round = [](float x) { return std::round(x * 1000) / 1000; };
  return {round(p.x), round(p.y), round(p.z)};
}

void add_meshes(const Head& head, const FdpPlan& plan, std::span<const FdpKeyframe> keyframes,
                const FdpOptions& options, FdpFiles& out) {
  MeshFile rest, still;
  std::vector<MeshFile> morphs(keyframes.size());
  const auto scale = float(options.scale);
  for (std::size_t m = 0; m < plan.parts.size(); ++m) {
    const Part part = plan.parts[m];
    Piece piece{.name = std::string(kPartNames[std::size_t(part)]),
                .material = {},
                .mesh = head.part(part),
                .neck_weights = {}};
    PieceTexture texture;
    if (!piece.mesh.colours.empty()) {
      detail::ColourPlane plane = detail::colour_plane(piece.mesh);
      texture = {options.name + "_" + piece.name + ".tga", std::move(plane.places)};
      out.textures.push_back({texture.file, detail::write_tga(plane.picture)});
    }
    for (std::size_t k = 0; k < keyframes.size() && !stays(keyframes, m); ++k) {
      Piece morph = piece;
      morph.mesh.colours.clear();
      const std::vector<Vec3>& to = keyframes[k].positions[m];
      for (std::size_t v = 0; v < to.size(); ++v) morph.mesh.positions[v] = rounded(to[v] * scale);
      morphs[k].add(std::move(morph), texture);
    }
    for (Vec3& p : piece.mesh.positions) p *= scale;
    (stays(keyframes, m) ? still : rest).add(std::move(piece), std::move(texture));
  }
  out.wrl = rest.text();
  if (!still.pieces.empty()) {
    out.keyframes.push_back({options.name + kStill + ".wrl", still.text()});
  }
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const std::string suffix = "_" + std::string(keyframes[k].alias);
    out.keyframes.push_back({options.name + suffix + ".wrl", morphs[k].text()});
  }
}

}  // namespace

Result<FdpFiles> write_fdp(const Head& head, const Rig& rig, const FdpOptions& options) {
  if (auto good = check(head, rig, options); !good) return good.error();
  const FdpPlan plan = detail::plan_fdp(head, rig, options);
  FdpFiles files;
  std::vector<FdpKeyframe> keyframes;
  if (options.keyframes) keyframes = detail::fdp_keyframes(rig, plan.parts);
  files.fdp = FdpWriter(head, plan, keyframes, options).write();
  add_meshes(head, plan, keyframes, options, files);
  return files;
}

}  // namespace animeme::head

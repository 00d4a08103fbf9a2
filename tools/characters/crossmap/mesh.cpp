#include "tools/characters/crossmap/mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "dam/signal/fap_signal.h"
#include "fap/head/obj.h"
#include "fap/head/point_list.h"
#include "fap/head/rig.h"
#include "fap/tables.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/files.h"
#include "tools/view/studio/head_file.h"

namespace animeme::crossmap {
namespace {

using head::Vec3;

constexpr Vec3 kClay = {0.55f, 0.42f, 0.36f};  // of meshes without colours
constexpr float kStill = 1e-6f;                // of the size of the mesh

bool is_vertex(std::string_view line) {
  const std::size_t at = line.find_first_not_of(" \t");
  return at != std::string_view::npos && line[at] == 'v' && at + 1 < line.size() &&
         (line[at + 1] == ' ' || line[at + 1] == '\t');
}

// Behind each of three numbers from `at`; npos: there are fewer.
std::size_t three_numbers(std::string_view line, std::array<float, 3>& out) {
  std::size_t at = line.find('v') + 1;
  for (float& value : out) {
    at = line.find_first_not_of(" \t", at);
    if (at == std::string_view::npos) return at;
    const auto [end, error] = std::from_chars(line.data() + at, line.data() + line.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::string_view::npos;
    at = std::size_t(end - line.data());
  }
  return at;
}

template <class Each>
void each_line(std::string_view text, const Each& each) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (!each(text.substr(at, end - at))) return;
    at = end + 1;
  }
}

// Triangles and colours of an OBJ file by the numbers of its "v" lines.
Result<void> read_faces(const std::string& path, TargetMesh& out) {
  const Result<head::ObjFile> file = head::read_obj(out.obj);
  if (!file) return file.error().in_file(path);
  const std::size_t count = std::min(out.vertices.size(), file->vertices.size());
  out.colours.assign(out.vertices.size(), kClay);
  std::vector<std::vector<std::uint32_t>> number(file->pieces.size());
  for (std::size_t p = 0; p < file->pieces.size(); ++p) {
    number[p].assign(file->pieces[p].mesh.positions.size(), head::kMissing);
  }
  for (std::size_t v = 0; v < count; ++v) {
    const auto& place = file->vertices[v];
    if (place.vertex == head::kMissing) continue;
    number[place.piece][place.vertex] = std::uint32_t(v);
    const auto& colours = file->pieces[place.piece].mesh.colours;
    if (place.vertex < colours.size() && colours[place.vertex].x >= 0) {
      out.colours[v] = colours[place.vertex];
    }
  }
  for (std::size_t p = 0; p < file->pieces.size(); ++p) {
    for (const head::Triangle& t : file->pieces[p].mesh.triangles) {
      const head::Triangle moved = {number[p][t[0]], number[p][t[1]], number[p][t[2]]};
      if (std::find(moved.begin(), moved.end(), head::kMissing) == moved.end()) {
        out.triangles.push_back(moved);
      }
    }
  }
  return {};
}

Result<std::string> read_obj_text(const std::string& path) {
  Result<std::string> text = tools::read_text_file(path);
  if (text && text->starts_with("\x1f\x8b")) {
    return make_error(Code::unsupported, "this is a compressed file; unpack it with gunzip first")
        .in_file(path);
  }
  return text;
}

// Feature points of an OBJ head by their vertices, and its FAP units.
struct ObjFace {
  std::map<std::string, std::uint32_t, std::less<>> points;
  fap::Fapu fapu;
};

Result<ObjFace> face_of(const Project& project, const TargetMesh& mesh) {
  const Result<std::string> text = tools::read_text_file(project.head_points, tools::kMostWritten);
  if (!text) return text.error();
  const auto rows = head::read_points(*text);
  if (!rows) return rows.error().in_file(project.head_points);
  ObjFace out;
  fap::FeaturePoints places;
  for (const head::PointRow& row : *rows) {
    if (!row.vertex || *row.vertex >= mesh.vertices.size()) {
      return error_at_line(Code::not_found,
                           "a head with shapes needs the vertex of each feature point, counted "
                           "from 0",
                           row.line)
          .in_file(project.head_points);
    }
    out.points[row.id] = *row.vertex;
    const Vec3 p = mesh.vertices[*row.vertex];
    places[row.id] = {p.x, p.y, p.z};
  }
  const Result<fap::Fapu> fapu = fap::measure_fapu(places);
  if (!fapu) {
    Error error = fapu.error();
    error.message += "; the mesh must have +Y up and face along +Z";
    return error.in_file(project.head_points);
  }
  out.fapu = *fapu;
  return out;
}

// How far the feature points of FAPs go, in FAP units.
fap::Frame faps_of(const ObjFace& face, const std::vector<Vec3>& moves) {
  fap::Frame out;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const fap::Move move = fap::move_of(fap);
    const auto point = face.points.find(fap::info(fap).feature_point);
    if (move.kind != fap::MoveKind::translate || point == face.points.end()) continue;
    const Vec3 d = moves[point->second];
    const double along = move.axis[0] * d.x + move.axis[1] * d.y + move.axis[2] * d.z;
    out.set(fap, std::int32_t(std::lround(fap::fap_value(fap, along, face.fapu))));
  }
  return out;
}

Result<TargetMesh> load_obj(const Project& project) {
  TargetMesh out;
  Result<std::string> text = read_obj_text(project.to);
  if (!text) return text.error();
  out.obj = std::move(*text);
  auto vertices = obj_vertices(out.obj);
  if (!vertices) return std::move(vertices).error().in_file(project.to);
  out.vertices = std::move(*vertices);
  if (auto ok = read_faces(project.to, out); !ok) return ok.error();
  std::optional<ObjFace> face;
  if (!project.head_points.empty()) {
    auto read = face_of(project, out);
    if (!read) return read.error();
    face = std::move(*read);
  }
  float size = 0;
  for (const Vec3& v : out.vertices) size = std::max({size, std::abs(v.x), std::abs(v.y)});
  for (const std::string& path : project.shapes) {
    const Result<std::string> shape = read_obj_text(path);
    if (!shape) return shape.error();
    auto places = obj_vertices(*shape);
    if (!places) return std::move(places).error().in_file(path);
    if (places->size() != out.vertices.size()) {
      return make_error(Code::invalid_argument, "this shape has " + std::to_string(places->size()) +
                                                    " vertices, " + project.to + " has " +
                                                    std::to_string(out.vertices.size()) +
                                                    "; export both with all vertices in one order")
          .in_file(path);
    }
    MeshControl control{std::filesystem::path(path).stem().string(), 0, 1, {}, {}};
    for (std::size_t v = 0; v < places->size(); ++v) {
      (*places)[v] -= out.vertices[v];
      if (length((*places)[v]) > kStill * size) {
        control.moves.emplace_back(std::uint32_t(v), (*places)[v]);
      }
    }
    if (face) control.faps = faps_of(*face, *places);
    out.controls.push_back(std::move(control));
  }
  return out;
}

constexpr float kFullFap = 256;  // units at which a FAP's moves are looked at

// Numbers of the vertices of a head's parts in write_obj().
std::array<std::uint32_t, head::kPartCount> first_vertices(const head::Head& head) {
  std::array<std::uint32_t, head::kPartCount> first{};
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < head.parts.size(); ++p) {
    first[p] = count;
    count += std::uint32_t(head.parts[p].positions.size());
  }
  return first;
}

// A control of each shape of a head.
void add_shapes(const head::Head& head, const head::Rig& rig, TargetMesh& out) {
  const auto first = first_vertices(head);
  for (const head::ShapeControl& shape : head.shapes) {
    out.controls.push_back({shape.name, 0, 1, shape.faps, {}});
  }
  for (const head::Target& target : rig.targets) {
    if (target.control < head::kFirstShape) continue;
    const float units = target.units(head::kFullShape);
    auto& moves = out.controls[std::size_t(target.control - head::kFirstShape)].moves;
    for (std::size_t i = 0; i < target.vertices.size(); ++i) {
      moves.emplace_back(first[std::size_t(target.part)] + target.vertices[i],
                         target.deltas[i] * units);
    }
  }
}

// All vertices of a head in a pose.
std::vector<Vec3> posed(const head::Head& head, const head::Rig& rig, const fap::Frame& frame) {
  const head::Pose pose = head::pose(rig, frame, {.contact = false, .follow = false});
  std::vector<Vec3> out;
  for (std::size_t p = 0; p < head.parts.size(); ++p) {
    const auto& places = pose.positions[p].empty() ? rig.parts[p].positions : pose.positions[p];
    for (const Vec3& place : places) out.push_back(pose.transforms[p](place));
  }
  return out;
}

// A control of each FAP that moves a head and no bone: what the head does at kFullFap, as a line.
void add_faps(const head::Head& head, const head::Rig& rig, TargetMesh& out) {
  const std::vector<Vec3> rest = posed(head, rig, {});
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const auto moves_it = [&](const head::Target& target) { return target.control == fap; };
    if (std::none_of(rig.targets.begin(), rig.targets.end(), moves_it) ||
        fap::move_of(fap).kind != fap::MoveKind::translate) {
      continue;
    }
    fap::Frame frame;
    frame.set(fap, std::int32_t(kFullFap));
    const std::vector<Vec3> full = posed(head, rig, frame);
    const fap::FapInfo& info = fap::info(fap);
    const double reach = double(info.default_i_range) * info.quant_step;
    MeshControl control{dam::fap_channel(fap), -reach, reach, {}, {}};
    control.faps.set(fap, 1);
    for (std::size_t v = 0; v < full.size(); ++v) {
      const Vec3 move = (full[v] - rest[v]) * (1 / kFullFap);
      if (length(move) > kStill) control.moves.emplace_back(std::uint32_t(v), move);
    }
    out.controls.push_back(std::move(control));
  }
}

void add_head_controls(const head::Head& head, TargetMesh& out) {
  const head::Rig rig = head::make_rig(head);
  if (head.shapes.empty()) return add_faps(head, rig, out);
  add_shapes(head, rig, out);
  for (MeshControl& control : out.controls) {
    auto& moves = control.moves;
    std::stable_sort(moves.begin(), moves.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::size_t kept = 0;
    for (const auto& move : moves) {
      if (kept > 0 && moves[kept - 1].first == move.first) {
        moves[kept - 1].second += move.second;
      } else {
        moves[kept++] = move;
      }
    }
    moves.resize(kept);
  }
}

Result<void> choose_controls(const Project& project, TargetMesh& mesh) {
  if (mesh.controls.empty()) {
    return make_error(Code::not_found,
                      "the head has no control: name OBJ files of its shapes (--shapes), or give "
                      "one with morph targets");
  }
  if (project.controls.empty()) return {};
  std::vector<MeshControl> chosen;
  for (const std::string& name : project.controls) {
    const auto at = std::find_if(mesh.controls.begin(), mesh.controls.end(), [&](const auto& c) {
      return c.name == name || (name.starts_with("fap") && c.name.starts_with(name + "_"));
    });
    if (at == mesh.controls.end()) {
      std::string names;
      for (const MeshControl& c : mesh.controls) names += (names.empty() ? "" : ", ") + c.name;
      return make_error(Code::not_found, "the head has no control '" + name + "'; it has " + names);
    }
    chosen.push_back(*at);
  }
  mesh.controls = std::move(chosen);
  return {};
}

}  // namespace

Result<std::vector<Vec3>> obj_vertices(std::string_view text) {
  std::vector<Vec3> out;
  std::int64_t line_number = 0;
  std::optional<Error> error;
  each_line(text, [&](std::string_view line) {
    ++line_number;
    if (!is_vertex(line)) return true;
    std::array<float, 3> at{};
    if (three_numbers(line, at) == std::string_view::npos) {
      error = error_at_line(Code::syntax, "a vertex has three numbers", line_number, 1);
      return false;
    }
    out.push_back({at[0], at[1], at[2]});
    return true;
  });
  if (error) return *error;
  if (out.empty()) return make_error(Code::truncated, "there is no vertex in this OBJ file");
  return out;
}

std::string obj_with_vertices(std::string_view obj, const std::vector<Vec3>& vertices) {
  std::string out;
  std::size_t next = 0;
  each_line(obj, [&](std::string_view line) {
    std::array<float, 3> at{};
    const std::size_t behind = is_vertex(line) ? three_numbers(line, at) : std::string_view::npos;
    if (behind != std::string_view::npos && next < vertices.size()) {
      const Vec3 p = vertices[next++];
      out += tools::format("v %.7g %.7g %.7g", double(p.x), double(p.y), double(p.z));
      line.remove_prefix(behind);
    }
    out.append(line);
    out += '\n';
    return true;
  });
  return out;
}

Result<TargetMesh> load_mesh(const Project& project, const tools::Log& log) {
  TargetMesh out;
  if (tools::extension_of(project.to) == ".obj" && !project.shapes.empty()) {
    auto read = load_obj(project);
    if (!read) return read;
    out = std::move(*read);
  } else {
    if (!project.shapes.empty()) {
      return make_error(Code::invalid_argument,
                        "shapes are OBJ files of a head that is an .obj itself");
    }
    const Result<head::Head> head = studio::load_head(
        {.head = project.to, .points = project.head_points, .colours_at_vertices = true}, log);
    if (!head) return head.error();
    out.obj = head::write_obj(*head);
    for (const head::Mesh& part : head->parts) {
      const auto first = std::uint32_t(out.vertices.size());
      out.vertices.insert(out.vertices.end(), part.positions.begin(), part.positions.end());
      out.colours.insert(out.colours.end(), part.colours.begin(), part.colours.end());
      out.colours.resize(out.vertices.size(), kClay);
      for (const head::Triangle& t : part.triangles) {
        out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      }
    }
    add_head_controls(*head, out);
  }
  out.name = std::filesystem::path(project.to).stem().string();
  if (auto ok = choose_controls(project, out); !ok) return ok.error();
  return out;
}

}  // namespace animeme::crossmap

#include "tools/characters/crossmap/target.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "dam/crossmap/bounded_least_squares.h"
#include "dam/signal/fap_signal.h"
#include "fap/arkit.h"
#include "fap/tables.h"
#include "tools/characters/crossmap/fap_space_internal.h"
#include "tools/formats/exchange/pose_table.h"
#include "tools/formats/files/files.h"

namespace animeme::crossmap {
namespace {

using Values = std::vector<double>;

// A control that does most of its work where no point was captured is left alone unless it is
// named: a cheek that squints raises the corner of the mouth a little, and would be used for that.
// Of ARKit's shapes with points of lips and chin in a picture these are jawForward, cheekPuff and
// cheekSquint (0.04 to 0.23); all others of jaw and mouth are above 0.4.
constexpr double kSeenEnough = 0.3;

struct Limits {
  double low = 0, high = 1;
};

Limits limits_of(const std::string& control) {
  const int fap = dam::fap_of_channel(control);
  if (fap < fap::kFirstLowLevel) return {};
  const fap::FapInfo& info = fap::info(fap);
  const double reach = double(info.default_i_range) * info.quant_step;
  return {-reach, reach};
}

void add_control(Target& out, const std::string& name, Limits limits) {
  out.character.controls.push_back(name);
  out.character.lows.push_back(limits.low);
  out.character.highs.push_back(limits.high);
}

// What the artist wrote down: controls.csv in the folder of key shapes.
Result<std::optional<dam::Poses>> adjusted_values(const Project& project) {
  if (project.keys.empty()) return std::optional<dam::Poses>();
  const std::filesystem::path path = std::filesystem::path(project.keys) / "controls.csv";
  if (!std::filesystem::is_regular_file(path)) return std::optional<dam::Poses>();
  const Result<std::string> text = tools::read_text_file(path.string(), tools::kMostWritten);
  if (!text) return text.error();
  Result<dam::Poses> table = exchange::read_pose_table(*text);
  if (!table) return std::move(table).error().in_file(path.string());
  return std::optional<dam::Poses>(std::move(*table));
}

// The row of a key shape in the order of the target's controls; those that the table lacks are 0.
std::optional<Values> row_of(const dam::Poses& table, const std::string& key,
                             const std::vector<std::string>& controls) {
  const auto row = std::find(table.labels.begin(), table.labels.end(), key);
  if (row == table.labels.end()) return std::nullopt;
  const std::size_t first = std::size_t(row - table.labels.begin()) * table.names.size();
  Values out;
  for (const std::string& name : controls) {
    const auto at = std::find(table.names.begin(), table.names.end(), name);
    out.push_back(
        at == table.names.end() ? 0 : table.values[first + std::size_t(at - table.names.begin())]);
  }
  return out;
}

Result<Target> table_target(const Project& project, const Keys& keys) {
  const Result<std::string> text = tools::read_text_file(project.to, tools::kMostWritten);
  if (!text) return text.error();
  const Result<dam::Poses> table = exchange::read_pose_table(*text);
  if (!table) return table.error().in_file(project.to);
  Target out;
  out.kind = TargetKind::table;
  for (const std::string& name : table->names) add_control(out, name, limits_of(name));
  for (const std::string& key : keys.shapes.names) {
    const auto row = row_of(*table, key, out.character.controls);
    if (!row) {
      return make_error(Code::not_found, "there is no row for the key shape " + key +
                                             "; --write-keys writes all of them")
          .in_file(project.to);
    }
    out.values.insert(out.values.end(), row->begin(), row->end());
    out.adjusted.push_back(true);
  }
  return out;
}

Target coefficient_target(const Keys& keys) {
  Target out;
  out.kind = TargetKind::keys;
  const std::size_t count = keys.shapes.names.size();
  out.values.assign(count * count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    add_control(out, keys.shapes.names[k], {0, std::numeric_limits<double>::infinity()});
    out.values[k * count + k] = 1;
    out.adjusted.push_back(false);
  }
  return out;
}

Values measured_faps(const Capture& capture, const Keys& keys, std::size_t key) {
  const std::size_t size = capture.tracks[0].size();
  return dam::fap_values(*capture.face, {&keys.shapes.values[key * size], size});
}

Error no_guess(const Capture& capture, const std::string& key) {
  Error error = capture.no_face;
  if (error.message.empty()) {
    error = make_error(Code::not_found,
                       "the target's controls show no FAP of the captured points; give its feature "
                       "points (--points)");
  }
  error.message =
      "the key shape " + key + " is not adjusted and cannot be guessed: " + error.message;
  return error;
}

Result<Target> fap_target(const Capture& capture, const Keys& keys,
                          const std::optional<dam::Poses>& table) {
  Target out;
  out.kind = TargetKind::faps;
  std::vector<int> faps;
  if (capture.face) faps = capture.face->faps;
  if (table) {
    for (const std::string& name : table->names) {
      const int fap = dam::fap_of_channel(name);
      if (fap >= fap::kFirstLowLevel && std::find(faps.begin(), faps.end(), fap) == faps.end()) {
        faps.push_back(fap);
      }
    }
    std::sort(faps.begin(), faps.end());
  }
  for (const int fap : faps)
    add_control(out, dam::fap_channel(fap), limits_of(dam::fap_channel(fap)));
  for (std::size_t k = 0; k < keys.shapes.names.size(); ++k) {
    std::optional<Values> row;
    if (table) row = row_of(*table, keys.shapes.names[k], out.character.controls);
    out.adjusted.push_back(row.has_value());
    if (!row) {
      if (!capture.face) return no_guess(capture, keys.shapes.names[k]);
      const Values told = measured_faps(capture, keys, k);
      row.emplace(faps.size(), 0.0);
      for (std::size_t i = 0; i < told.size(); ++i) {
        const auto at = std::find(faps.begin(), faps.end(), capture.face->faps[i]);
        (*row)[std::size_t(at - faps.begin())] = told[i];
      }
    }
    out.values.insert(out.values.end(), row->begin(), row->end());
  }
  return out;
}

// Controls by what FAPs they show: the fit of ARKit's shapes, and the first guess for a head's.
class ByFaps {
 public:
  ByFaps(const FapSpace& space, const std::vector<fap::Frame>& controls, const Target& target,
         double ridge)
      : space_(space), moves_(space.rows() * controls.size()) {
    for (std::size_t c = 0; c < controls.size(); ++c) {
      const Values lengths = space.lengths(controls[c]);
      for (std::size_t r = 0; r < lengths.size(); ++r) moves_[r * controls.size() + c] = lengths[r];
    }
    fit_.emplace(
        moves_, space.rows(), controls.size(),
        dam::LeastSquaresLimits{
            .lows = target.character.lows, .highs = target.character.highs, .ridge = ridge});
  }
  const Values& moves() const { return moves_; }
  Values fit(const Values& faps) {
    const auto values = fit_->fit(space_.lengths(faps));
    return {values.begin(), values.end()};
  }

 private:
  const FapSpace& space_;
  Values moves_;
  std::optional<dam::BoundedLeastSquares> fit_;
};

Result<Target> arkit_target(const Project& project, const Capture& capture, const Keys& keys,
                            const std::optional<dam::Poses>& table) {
  Target out;
  out.kind = TargetKind::arkit;
  if (!capture.face) return no_guess(capture, keys.shapes.names[0]);
  const FapSpace space(capture.face->faps);
  std::vector<fap::Frame> frames;
  for (int c = 0; c < fap::kArkitShapeCount; ++c) {
    const std::string name(fap::kArkitNames[std::size_t(c)]);
    if (!project.controls.empty() && std::find(project.controls.begin(), project.controls.end(),
                                               name) == project.controls.end()) {
      continue;
    }
    fap::ArkitFrame weights{};
    weights[std::size_t(c)] = 1;
    const fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    const Values lengths = space.lengths(frame);
    if (std::all_of(lengths.begin(), lengths.end(), [](double v) { return v == 0; })) continue;
    if (project.controls.empty() && space.seen_share(frame) < kSeenEnough) continue;
    add_control(out, name, {0, 1});
    frames.push_back(frame);
  }
  if (frames.empty()) return make_error(Code::not_found, "no shape of ARKit is left to be moved");
  ByFaps by(space, frames, out, project.controls_fit.ridge);
  out.character.rows = space.rows();
  out.character.moves = by.moves();
  const std::size_t controls = frames.size();
  for (std::size_t k = 0; k < keys.shapes.names.size(); ++k) {
    std::optional<Values> row;
    if (table) row = row_of(*table, keys.shapes.names[k], out.character.controls);
    out.adjusted.push_back(row.has_value());
    const Values faps = measured_faps(capture, keys, k);
    Values shape = space.lengths(faps);
    if (row) {
      for (std::size_t r = 0; r < shape.size(); ++r) {
        shape[r] = 0;
        for (std::size_t c = 0; c < controls; ++c) {
          shape[r] += (*row)[c] * out.character.moves[r * controls + c];
        }
      }
    } else {
      row = by.fit(faps);
    }
    out.values.insert(out.values.end(), row->begin(), row->end());
    out.character.keys.insert(out.character.keys.end(), shape.begin(), shape.end());
  }
  return out;
}

// The shape that an artist saved: KEY.obj in the folder of key shapes.
Result<std::optional<std::vector<head::Vec3>>> adjusted_shape(const Project& project,
                                                              const TargetMesh& mesh,
                                                              const std::string& key) {
  using Shape = std::optional<std::vector<head::Vec3>>;
  if (project.keys.empty()) return Shape();
  const std::filesystem::path path = std::filesystem::path(project.keys) / (key + ".obj");
  if (!std::filesystem::is_regular_file(path)) return Shape();
  const Result<std::string> text = tools::read_text_file(path.string());
  if (!text) return text.error();
  auto places = obj_vertices(*text);
  if (!places) return std::move(places).error().in_file(path.string());
  if (places->size() != mesh.vertices.size()) {
    return make_error(Code::invalid_argument,
                      "this key shape has " + std::to_string(places->size()) + " vertices, " +
                          mesh.name + " has " + std::to_string(mesh.vertices.size()) +
                          "; export all of them, in their order")
        .in_file(path.string());
  }
  for (std::size_t v = 0; v < places->size(); ++v) (*places)[v] -= mesh.vertices[v];
  return Shape(std::move(*places));
}

std::vector<head::Vec3> moved_by(const TargetMesh& mesh, const Values& values) {
  std::vector<head::Vec3> out(mesh.vertices.size());
  for (std::size_t c = 0; c < values.size(); ++c) {
    if (values[c] == 0) continue;
    for (const auto& [v, move] : mesh.controls[c].moves) out[v] += move * float(values[c]);
  }
  return out;
}

// Rows: the coordinates of all vertices that a control or an adjusted shape moves.
void add_rows(Target& out) {
  const TargetMesh& mesh = *out.mesh;
  std::vector<bool> moved(mesh.vertices.size());
  for (const MeshControl& control : mesh.controls) {
    for (const auto& move : control.moves) moved[move.first] = true;
  }
  for (std::size_t k = 0; k < out.mesh_keys.size(); ++k) {
    for (std::size_t v = 0; out.adjusted[k] && v < moved.size(); ++v) {
      if (length(out.mesh_keys[k][v]) > 1e-4f) moved[v] = true;
    }
  }
  std::vector<std::size_t> row(moved.size(), 0);
  std::size_t rows = 0;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    row[v] = rows;
    if (moved[v]) rows += 3;
  }
  dam::Character& character = out.character;
  const std::size_t controls = mesh.controls.size();
  character.rows = rows;
  character.moves.assign(rows * controls, 0.0);
  for (std::size_t c = 0; c < controls; ++c) {
    for (const auto& [v, move] : mesh.controls[c].moves) {
      const float parts[] = {move.x, move.y, move.z};
      for (std::size_t d = 0; d < 3; ++d) character.moves[(row[v] + d) * controls + c] = parts[d];
    }
  }
  character.keys.reserve(rows * out.mesh_keys.size());
  for (const auto& shape : out.mesh_keys) {
    for (std::size_t v = 0; v < shape.size(); ++v) {
      if (moved[v])
        character.keys.insert(character.keys.end(), {shape[v].x, shape[v].y, shape[v].z});
    }
  }
}

Result<Target> mesh_target(const Project& project, const Capture& capture, const Keys& keys,
                           const std::optional<dam::Poses>& table, const tools::Log& log) {
  Target out;
  out.kind = TargetKind::mesh;
  auto mesh = load_mesh(project, log);
  if (!mesh) return mesh.error();
  // Without FAPs there is no guess, and with none of these controls nothing to be guessed.
  const FapSpace space(capture.face ? capture.face->faps : std::vector<int>());
  if (project.controls.empty() && capture.face) {
    std::vector<MeshControl> seen;
    for (const MeshControl& control : mesh->controls) {
      if (space.seen_share(control.faps) >= kSeenEnough) seen.push_back(control);
    }
    if (!seen.empty()) mesh->controls = std::move(seen);
  }
  out.mesh = std::move(*mesh);
  std::vector<fap::Frame> frames;
  for (const MeshControl& control : out.mesh->controls) {
    add_control(out, control.name, {control.low, control.high});
    frames.push_back(control.faps);
  }
  const bool told = std::any_of(frames.begin(), frames.end(), [&](const fap::Frame& frame) {
    const Values lengths = space.lengths(frame);
    return std::any_of(lengths.begin(), lengths.end(), [](double v) { return v != 0; });
  });
  std::optional<ByFaps> by;
  if (told) by.emplace(space, frames, out, project.controls_fit.ridge);
  for (std::size_t k = 0; k < keys.shapes.names.size(); ++k) {
    const std::string& key = keys.shapes.names[k];
    std::optional<Values> row;
    if (table) row = row_of(*table, key, out.character.controls);
    auto shape = adjusted_shape(project, *out.mesh, key);
    if (!shape) return shape.error();
    out.adjusted.push_back(*shape || row);
    if (!row && !by && !*shape) return no_guess(capture, key);
    if (!row) row = by ? by->fit(measured_faps(capture, keys, k)) : Values(frames.size(), 0.0);
    out.mesh_keys.push_back(*shape ? std::move(**shape) : moved_by(*out.mesh, *row));
    out.values.insert(out.values.end(), row->begin(), row->end());
  }
  add_rows(out);
  if (out.character.rows == 0) {
    return make_error(Code::not_found, "the controls of the head move no vertex");
  }
  return out;
}

}  // namespace

Result<Target> load_target(const Project& project, const Capture& capture, const Keys& keys,
                           const tools::Log& log) {
  if (project.to == "keys") return coefficient_target(keys);
  if (tools::extension_of(project.to) == ".csv") return table_target(project, keys);
  const auto table = adjusted_values(project);
  if (!table) return table.error();
  Result<Target> out = project.to == "faps"    ? fap_target(capture, keys, *table)
                       : project.to == "arkit" ? arkit_target(project, capture, keys, *table)
                                               : mesh_target(project, capture, keys, *table, log);
  if (!out) return out;
  const auto adjusted = std::count(out->adjusted.begin(), out->adjusted.end(), true);
  if (adjusted > 0) {
    log.info(std::to_string(adjusted) + " of " + std::to_string(out->adjusted.size()) +
             " key shapes were adjusted in " + project.keys);
  }
  return out;
}

Result<dam::Retarget> fit_target(const Target& target, const dam::Blend& blend, fap::Rate rate,
                                 const dam::RetargetOptions& options) {
  if (target.character.rows == 0) {
    return dam::mix_controls(blend, rate, target.character, target.values);
  }
  return dam::fit_controls(blend, rate, target.character, options);
}

std::optional<fap::Frame> shown_faps(const Target& target, const double* values) {
  const auto& names = target.character.controls;
  if (target.kind == TargetKind::arkit) {
    fap::ArkitFrame weights{};
    for (std::size_t c = 0; c < names.size(); ++c) {
      if (const auto at = fap::find_arkit(names[c])) weights[std::size_t(*at)] = values[c];
    }
    return fap::arkit_to_fap(weights, fap::kAllArkit);
  }
  fap::Frame frame;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const int fap = dam::fap_of_channel(names[c]);
    if (fap >= fap::kFirstLowLevel) frame.set(fap, std::int32_t(std::lround(values[c])));
  }
  if (frame.mask.none()) return std::nullopt;
  return frame;
}

}  // namespace animeme::crossmap

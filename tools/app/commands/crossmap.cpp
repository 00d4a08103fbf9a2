// Captured lips to the controls of a character: Appendix A of the paper.
#include <cmath>
#include <filesystem>
#include <set>

#include "dam/signal/fap_signal.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/crossmap_options.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/outputs.h"
#include "tools/characters/crossmap/run.h"
#include "tools/characters/crossmap/sheet.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/exchange/pose_table.h"
#include "tools/view/plot/curves.h"

namespace animeme::tools {

namespace {

using crossmap::Mapped;
using crossmap::Project;

// Two inputs of one name would become one file.
Result<void> check_names(const Project& project) {
  std::set<std::string> taken;
  for (const std::string& path : project.inputs) {
    const std::string stem = std::filesystem::path(path).stem().string();
    if (taken.insert(stem).second) continue;
    return make_error(Code::invalid_argument,
                      "two recordings are called " + stem + "; rename one of them");
  }
  return {};
}

std::string curves_of(const dam::Signal& signal) {
  std::vector<std::string> names = signal.names;
  if (!signal.measured.empty()) names.emplace_back("measured");
  std::string out = exchange::write_curve_header(names);
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    std::string row = exchange::write_curve_row(signal, i);
    if (!signal.measured.empty()) {
      while (!row.empty() && (row.back() == '\n' || row.back() == '\r')) row.pop_back();
      row += signal.measured[i] ? ",1\n" : ",0\n";
    }
    out += row;
  }
  return out;
}

Result<void> write_curve_file(const std::string& path, const dam::Signal& signal,
                              const std::string& name, bool as_fap) {
  if (!as_fap) return write_file(path, curves_of(signal));
  Result<fap::Sequence> clip = dam::to_sequence(signal);
  if (!clip) return clip.error();
  clip->name = name;
  OutputFile file(path);
  const auto frames = write_face_text(file, name_of_output(path), face_text(*clip));
  if (!frames) return frames.error();
  return file.publish();
}

// One file, or one for each recording in a folder.
Result<void> write_curves(const CrossmapOptions& options, const Mapped& mapped) {
  const bool faps = mapped.target.kind == crossmap::TargetKind::faps;
  const std::string extension = extension_of(options.output);
  if (extension == ".fap" && !faps) {
    return make_error(Code::invalid_argument,
                      "only FAPs (--to faps) are written as .fap; name a .csv");
  }
  const bool folder = extension.empty() && options.output != "-";
  if (!folder && mapped.takes.size() > 1) {
    return make_error(Code::invalid_argument,
                      "several recordings are written to a folder: -o FOLDER (one file each)");
  }
  if (!folder) {
    const bool as_fap = extension == ".fap" || (options.output == "-" && faps && !options.csv);
    return write_curve_file(options.output, mapped.takes[0].retarget.signal,
                            mapped.capture.tracks[0].name, as_fap);
  }
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  const bool as_fap = faps && !options.csv;
  for (std::size_t i = 0; i < mapped.takes.size(); ++i) {
    const std::string& name = mapped.capture.tracks[i].name;
    const auto path = std::filesystem::path(options.output) / (name + (as_fap ? ".fap" : ".csv"));
    if (const std::string problem = problem_with_another_output(path.string()); !problem.empty()) {
      return make_error(Code::invalid_argument, problem);
    }
    if (auto ok = write_curve_file(path.string(), mapped.takes[i].retarget.signal, name, as_fap);
        !ok) {
      return ok;
    }
  }
  return {};
}

// What an artist works on: the key shapes, their controls, and meshes to begin with.
Result<void> write_key_folder(const std::string& folder, const Mapped& mapped) {
  namespace fs = std::filesystem;
  const bool meshes = mapped.target.mesh.has_value();
  std::error_code error;
  fs::create_directories(meshes ? fs::path(folder) / "start" : fs::path(folder), error);
  std::vector<std::pair<std::string, std::string>> texts;
  const auto file = [&](const fs::path& name) { return (fs::path(folder) / name).string(); };
  texts.emplace_back(file("keys.csv"), crossmap::write_keys(mapped.keys, mapped.capture));
  if (mapped.target.kind != crossmap::TargetKind::keys) {
    texts.emplace_back(file("controls.csv"),
                       exchange::write_pose_table({mapped.target.character.controls,
                                                   mapped.keys.shapes.names, mapped.target.values},
                                                  "key"));
  }
  const auto sheet = crossmap::sheet_svg(mapped);
  if (!sheet) return sheet.error();
  texts.emplace_back(file("sheet.svg"), *sheet);
  if (meshes) {
    const crossmap::TargetMesh& mesh = *mapped.target.mesh;
    texts.emplace_back(file("start/neutral.obj"), mesh.obj);
    for (std::size_t k = 0; k < mapped.keys.shapes.names.size(); ++k) {
      std::vector<head::Vec3> places = mesh.vertices;
      for (std::size_t v = 0; v < places.size(); ++v) places[v] += mapped.target.mesh_keys[k][v];
      texts.emplace_back(file("start/" + mapped.keys.shapes.names[k] + ".obj"),
                         crossmap::obj_with_vertices(mesh.obj, places));
    }
  }
  std::vector<OutputText> files;
  for (const auto& [path, text] : texts) {
    if (const std::string problem = problem_with_another_output(path); !problem.empty()) {
      return make_error(Code::invalid_argument, problem);
    }
    files.push_back({path, text});
  }
  return write_files(files);
}

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

Json residual_json(const Mapped& mapped, std::size_t take) {
  const auto& regions = mapped.capture.regions;
  const dam::PointTrack& track = mapped.capture.tracks[take];
  Json out = Json::object();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const crossmap::RegionResidual residual = crossmap::region_residual(mapped, take, r);
    Json frames = Json::array();
    for (std::size_t i = 0; i < track.frames(); ++i) {
      const double value = mapped.takes[take].blend.residuals[i * regions.size() + r];
      frames.push_back(std::isnan(value) ? Json() : Json(rounded(value)));
    }
    out[regions[r].name] = {{"rms", rounded(residual.rms)},
                            {"worst", rounded(residual.worst)},
                            {"worst_s", rounded(track.rate.seconds(double(residual.frame)))},
                            {"frames", std::move(frames)}};
  }
  return out;
}

Json report_of(const Mapped& mapped) {
  Json keys = Json::array();
  for (std::size_t k = 0; k < mapped.keys.shapes.names.size(); ++k) {
    const crossmap::KeySource& source = mapped.keys.sources[k];
    keys.push_back({{"name", mapped.keys.shapes.names[k]},
                    {"input", source.input},
                    {"at_s", rounded(source.seconds)},
                    {"share", rounded(source.share)},
                    {"adjusted", bool(mapped.target.adjusted[k])}});
  }
  Json takes = Json::array();
  for (std::size_t i = 0; i < mapped.takes.size(); ++i) {
    const crossmap::Take& take = mapped.takes[i];
    const dam::PointTrack& track = mapped.capture.tracks[i];
    Json target = Json::array();
    for (const double value : take.retarget.residuals) target.push_back(rounded(value));
    takes.push_back({{"name", track.name},
                     {"frames", track.frames()},
                     {"rate", fap::format_rate(track.rate)},
                     {"frames_with_missing_points", take.blend.partly},
                     {"frames_without_points", take.blend.unseen},
                     {"residual", rounded(take.blend.residual)},
                     {"regions", residual_json(mapped, i)},
                     {"frames_at_a_limit", take.retarget.limited},
                     {"target_residual", std::move(target)}});
  }
  return {{"unit", mapped.capture.unit},
          {"points", mapped.capture.tracks[0].names},
          {"key_shapes", std::move(keys)},
          {"controls", mapped.target.character.controls},
          {"recordings", std::move(takes)}};
}

void tell(const Mapped& mapped) {
  for (std::size_t i = 0; i < mapped.takes.size(); ++i) {
    const dam::PointTrack& track = mapped.capture.tracks[i];
    std::string text = format("%s: %zu frames, off by %.3g", track.name.c_str(), track.frames(),
                              mapped.takes[i].blend.residual);
    if (!mapped.capture.unit.empty()) text += " " + mapped.capture.unit;
    for (std::size_t r = 0; r < mapped.capture.regions.size() && mapped.takes.size() < 6; ++r) {
      const auto residual = crossmap::region_residual(mapped, i, r);
      text += format("%s%s %.3g", r == 0 ? " (" : ", ", mapped.capture.regions[r].name.c_str(),
                     residual.rms);
      if (r + 1 == mapped.capture.regions.size()) text += ")";
    }
    if (const std::size_t limited = mapped.takes[i].retarget.limited; limited > 0) {
      text += format("; a control stands at its limit in %zu frames", limited);
    }
    say(text);
  }
}

}  // namespace

Result<int> run(const CrossmapOptions& options) {
  if (options.output.empty() && options.write_keys.empty() && options.picture.empty() &&
      !options.json) {
    return usage_error("nothing would be written: name -o, --write-keys, --picture or --json");
  }
  const Result<Project> project = project_of(options);
  if (!project) {
    if (project.error().code == Code::invalid_argument) return usage_error(project.error().message);
    return project.error();
  }
  if (auto ok = check_names(*project); !ok) return ok.error();
  Log log;
  log.info = [](const std::string& text) { say(text); };
  log.warn = [](const std::string& text) { warn(text); };
  const Result<Mapped> mapped = crossmap::run(*project, log);
  if (!mapped) return mapped.error();
  tell(*mapped);
  if (!options.picture.empty()) {
    const auto sheet = crossmap::sheet_svg(*mapped);
    if (!sheet) return sheet.error();
    const auto bytes = plot::drawing_bytes(options.picture, *sheet);
    if (!bytes) return bytes.error();
    if (auto ok = write_file(options.picture, *bytes); !ok) return ok.error();
  }
  if (!options.write_keys.empty()) {
    if (auto ok = write_key_folder(options.write_keys, *mapped); !ok) return ok.error();
    say(options.write_keys + ": " + std::to_string(mapped->keys.shapes.names.size()) +
        " key shapes; adjust controls.csv" +
        (mapped->target.mesh ? ", or save meshes of start/ as KEY.obj beside it," : "") +
        " and go on with --keys " + options.write_keys);
  }
  if (!options.output.empty()) {
    if (auto ok = write_curves(options, *mapped); !ok) return ok.error();
  }
  if (options.json) std::printf("%s\n", pretty(report_of(*mapped)).c_str());
  return kOk;
}

const Command kCrossmap{
    "crossmap", "Map captured lip motion to the controls of your character by key shapes",
    "  animeme crossmap take1.csv take2.csv -o curves/\n"
    "  animeme crossmap markers.c3d --unit mm --axes \"left back up\" --to arkit -o take.csv\n"
    "  animeme crossmap take.csv --to anna.glb --write-keys keys/\n"
    "  animeme crossmap take.csv --to anna.glb --keys keys/ -o take_anna.csv --picture sheet.png\n"
    "  animeme crossmap take.csv --key M=0.52 --key AH=1.24 --to controls.csv -o take_rig.csv\n"
    "  animeme crossmap project.toml -o curves/ --json",
    set_up<CrossmapOptions>};

}  // namespace animeme::tools

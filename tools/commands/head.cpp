#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "fap/head/rig.h"
#include "tools/commands/common.h"
#include "tools/commands/head_file.h"

namespace animeme::tools {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  HeadChoice head;
  bool json = false;
};

// FAPs that show nothing on this head.
std::vector<std::string> still_faps(const head::Head& head, const head::Rig& rig) {
  std::set<int> moved;
  for (const head::Target& target : rig.targets) {
    if (target.control < head::kFirstShape) moved.insert(target.control);
  }
  for (const head::ShapeControl& shape : rig.shapes) {
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const auto f = std::size_t(fap);
      if (shape.faps.mask[f] && shape.faps.value[f] != 0) moved.insert(fap);
    }
  }
  for (const int fap : {23, 25, 27}) {
    if (!head.part(head::Part::left_eye).positions.empty()) moved.insert(fap);
    if (!head.part(head::Part::right_eye).positions.empty()) moved.insert(fap + 1);
  }
  for (const int fap : {48, 49, 50}) moved.insert(fap);
  std::vector<std::string> still;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!moved.contains(fap)) still.emplace_back(fap::info(fap).name);
  }
  return still;
}

Json describe(const LoadedHead& loaded, const head::Rig& rig) {
  const head::Head& head = loaded.head;
  Json parts = Json::object();
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    const head::Mesh& mesh = head.parts[i];
    if (mesh.positions.empty()) continue;
    parts[std::string(head::kPartNames[i])] = {{"vertices", mesh.positions.size()},
                                               {"triangles", mesh.triangles.size()}};
  }
  Json points = Json::object();
  Json missing = Json::array();
  for (std::size_t i = 0; i < head.feature_points.size(); ++i) {
    const std::string id(fap::kFeaturePoints[i].id);
    if (!head.feature_points[i].exists()) {
      if (id != "7.1") missing.push_back(id);
      continue;
    }
    const head::Vec3 p = head.at(id);
    points[id] = {p.x, p.y, p.z};
  }
  Json shapes = Json::array();
  for (const head::ShapeControl& shape : head.shapes) shapes.push_back(shape.name);
  return {{"name", head.name},
          {"parts", parts},
          {"fapu_cm",
           {{"IRISD", head.fapu.irisd},
            {"ES", head.fapu.es},
            {"ENS", head.fapu.ens},
            {"MNS", head.fapu.mns},
            {"MW", head.fapu.mw}}},
          {"moved_by", !head.shapes.empty()    ? "shapes"
                       : !head.targets.empty() ? "targets"
                                               : "feature_points"},
          {"shapes", shapes},
          {"feature_points_cm", points},
          {"missing_feature_points", missing},
          {"still_faps", still_faps(head, rig)},
          {"notes", loaded.notes}};
}

std::string list(const Json& names) {
  std::string text;
  for (const Json& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text;
}

void print_text(const Json& info) {
  std::printf("%s\n", info["name"].get<std::string>().c_str());
  for (const auto& [name, part] : info["parts"].items()) {
    std::printf("  %-12s %6zu vertices %6zu triangles\n", name.c_str(),
                part["vertices"].get<std::size_t>(), part["triangles"].get<std::size_t>());
  }
  std::printf("FAP units (cm):");
  for (const auto& [name, cm] : info["fapu_cm"].items()) {
    std::printf(" %s %.2f", name.c_str(), cm.get<double>());
  }
  std::printf("\nfeature points: %zu of 84\n", info["feature_points_cm"].size());
  const std::string by = info["moved_by"];
  if (by == "shapes") {
    std::printf("moved by %zu shapes: %s\n", info["shapes"].size(), list(info["shapes"]).c_str());
  } else {
    std::printf("moved by %s\n", by == "targets" ? "what its file says" : "its feature points");
  }
  if (!info["still_faps"].empty()) {
    std::printf("FAPs that show nothing: %s\n", list(info["still_faps"]).c_str());
  }
  for (const Json& note : info["notes"]) {
    std::printf("note: %s\n", note.get<std::string>().c_str());
  }
}

Result<int> run(const Options& options) {
  if (const std::string problem = problem_of(options.head); !problem.empty()) {
    return usage_error(problem);
  }
  const Result<LoadedHead> loaded = load_head(options.head);
  if (!loaded) return loaded.error();
  const Json info = describe(*loaded, head::make_rig(loaded->head));
  if (options.json) {
    std::printf("%s\n", info.dump(2).c_str());
  } else {
    print_text(info);
  }
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("head", options->head.head, kHeadHelp)->capture_default_str();
  app.add_option("--points", options->head.points, kPointsHelp);
  app.add_flag("--json", options->json, "The same for scripts");
  return [options] { return run(*options); };
}

}  // namespace

const Command kHead{
    "head", "What a head of yours has: parts, feature points, FAPs that move it",
    "  animeme head woman\n"
    "  animeme head me.obj --points landmarks.csv\n"
    "\n"
    "A list of landmarks is a text: 2.1,966 in a line makes vertex 966 (from 0) the\n"
    "chin. The mouth needs 2.2-2.9 and 8.1-8.8, lids 3.1-3.4, brows 4.1-4.6, the\n"
    "chin 2.1 and 2.10, the nose 9.1-9.3 and 9.15, cheeks 5.1-5.4; further points\n"
    "make it better. Show the head with --head me.obj --points landmarks.csv in\n"
    "render, view and export.",
    add};

}  // namespace animeme::tools

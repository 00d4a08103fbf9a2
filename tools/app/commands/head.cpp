#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <set>
#include <string>

#include "fap/head/obj.h"
#include "fap/head/rig.h"
#include "fap/result.h"
#include "fap/xml/fdp.h"
#include "fap/xml/xmt.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/head_options.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/said_visemes.h"
#include "tools/formats/common/json.h"
#include "tools/view/gltf/glb.h"
#include "tools/view/studio/head_file.h"
#include "tools/view/studio/head_view.h"
#include "tools/view/studio/picture_file.h"
#include "tools/view/studio/speak_check.h"

namespace animeme::tools {

namespace {

constexpr int kPictureSize = 256;
constexpr int kColumns = 5;

Result<void> draw_visemes(const studio::HeadChoice& choice, const std::string& path) {
  const auto frames = studio::shape_frames("visemes");
  if (!frames) return frames.error();
  const studio::HeadLook look{
      .head = choice, .zoom = 1.4, .width = kPictureSize, .height = kPictureSize};
  const auto sheet = studio::draw_sheet(look, *frames, kColumns);
  if (!sheet) return sheet.error();
  const auto file = studio::picture_of(*sheet, extension_of(path));
  if (!file) return file.error();
  return write_file(path, *file);
}

void print_row(const studio::SpeakRow& row) {
  std::printf("  %-14s %-26s %7.2f  %-8s (%s %g)\n", row.sound.c_str(), row.what.c_str(), row.value,
              row.ok() ? "ok" : "short of", row.at_most ? "at most" : "at least", row.limit);
}

// Prints how a head speaks (studio::check_speech()), as a table or as JSON, and draws its visemes
// into `sheet` (empty: no picture). Errors: those of load_head() and check_speech(), of drawing
// and writing; a usage error for an ending that is no picture.
Result<int> test_speech(const studio::HeadChoice& choice, const std::string& mouth,
                        const std::string& sheet, bool json) {
  if (!sheet.empty() && !studio::is_picture(extension_of(sheet))) {
    return usage_error("--speak-test draws its sheet as .png, .jpg or .webp, not " + sheet);
  }
  const Result<studio::LoadedHead> loaded = studio::load_head(choice);
  if (!loaded) return loaded.error();
  const head::Head& head = loaded->head;
  const auto rows =
      studio::check_speech(head, head::make_rig(head), {.visemes = mouth == kMouthByVisemes});
  if (!rows) return rows.error().in_file(choice.head);
  const bool can = std::all_of(rows->begin(), rows->end(), std::mem_fn(&studio::SpeakRow::ok));
  const int code = can ? kOk : kCheckFailed;
  if (!sheet.empty()) {
    if (auto drawn = draw_visemes(choice, sheet); !drawn) return drawn.error();
  }
  if (!json) {
    std::printf("%s, as if its eyes were %g mm apart, lips opened %.2f times as wide (--gain)\n",
                head.name.c_str(), studio::kEyesApart, head.mouth_gain);
    for (const studio::SpeakRow& row : *rows) print_row(row);
    return code;
  }
  Json list = Json::array();
  for (const studio::SpeakRow& row : *rows) {
    list.push_back({{"sound", row.sound},
                    {"measure", row.what},
                    {"value", row.value},
                    {row.at_most ? "at_most" : "at_least", row.limit},
                    {"ok", row.ok()}});
  }
  const Json all = {{"name", head.name},
                    {"eyes_apart_mm", studio::kEyesApart},
                    {"gain", head.mouth_gain},
                    {"rows", list}};
  std::printf("%s\n", pretty(all).c_str());
  return code;
}

struct HeadOptions {
  studio::HeadChoice head{.gain = ""};
  std::string mouth = kMouthByVisemes;
  std::string output;
  bool json = false;
  bool speak_test = false;
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

Json describe(const studio::LoadedHead& loaded, const head::Rig& rig) {
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
  return {{"name", head.name},
          {"parts", parts},
          {"fapu_cm",
           {{"IRISD", head.fapu.irisd},
            {"ES", head.fapu.es},
            {"ENS", head.fapu.ens},
            {"MNS", head.fapu.mns},
            {"MW", head.fapu.mw}}},
          {"moved_by", !head.shapes.empty()                   ? "shapes"
                       : !head.targets.empty() && !head.eased ? "targets"
                                                              : "feature_points"},
          {"shapes", json_list(head.shapes, &head::ShapeControl::name)},
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
  const std::string by = info["moved_by"].text();
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

struct Output {
  const std::string& path;
  const head::Head& head;
  const head::Rig& rig;

  std::string name() const { return std::filesystem::path(path).stem().string(); }
  std::string beside(const std::string& file) const {
    return (std::filesystem::path(path).parent_path() / file).string();
  }
};

// Files that belong together: none is written without the others.
Result<void> write_together(std::span<const OutputText> files) {
  for (const OutputText& file : files.subspan(1)) {
    if (const std::string text = problem_with_another_output(file.path); !text.empty()) {
      return make_error(Code::invalid_argument, text);
    }
  }
  return write_files(files);
}

Result<void> write_obj(const Output& out) {
  const std::string obj = head::write_obj(out.head);
  const std::string points = head::points_of(out.head);
  const OutputText files[] = {{out.path, obj}, {out.beside(out.name() + ".points.csv"), points}};
  if (auto ok = write_together(files); !ok) return ok;
  say(out.path + " and its feature points " + files[1].path);
  return {};
}

// Xface cuts texts at blanks, so the files that an .fdp names have none: "my head.fdp" has
// "my_head.wrl".
std::string plain_name(std::string name) {
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-';
    if (!plain) c = '_';
  }
  if (name.starts_with('-')) name[0] = '_';
  return name;
}

Result<void> write_fdp(const Output& out) {
  const std::string name = plain_name(out.name());
  const Result<head::FdpFiles> made =
      head::write_fdp(out.head, out.rig, {.name = name, .keyframes = true});
  if (!made) return made.error();
  std::vector<OutputText> files = {{out.path, made->fdp}, {out.beside(name + ".wrl"), made->wrl}};
  for (const head::FdpTexture& texture : made->textures) {
    files.push_back({out.beside(texture.name), texture.content});
  }
  for (const head::FdpTexture& mesh : made->keyframes) {
    files.push_back({out.beside(mesh.name), mesh.content});
  }
  if (auto ok = write_together(files); !ok) return ok;
  say(out.path + ", its mesh " + files[1].path + ", its visemes and expressions (" + name +
      "_*.wrl) and " + std::to_string(made->textures.size()) + " textures (" + name +
      "_*.tga); keep them together");
  return {};
}

Result<void> write_glb(const Output& out) {
  const fap::Sequence rest{{25, 1}, {fap::Frame{}}, ""};
  const Result<std::vector<std::uint8_t>> glb = gltf::make_glb(out.head, out.rig, rest);
  if (!glb) return glb.error();
  return write_file(out.path, *glb);
}

Result<void> write_xmt(const Output& out) {
  const Result<std::string> scene = head::write_xmt(out.head, out.rig);
  if (!scene) return scene.error();
  return write_file(out.path, *scene);
}

constexpr struct Writer {
  std::string_view extension;
  Result<void> (*write)(const Output&);
} kWriters[] = {{".fdp", write_fdp},
                {".xmt", write_xmt},
                {".xmta", write_xmt},
                {".glb", write_glb},
                {".obj", write_obj}};

Result<int> run(const HeadOptions& given) {
  HeadOptions options = given;
  if (options.head.gain.empty()) options.head.gain = options.speak_test ? "auto" : "1";
  if (const std::string problem = studio::problem_of(options.head); !problem.empty()) {
    return usage_error(problem);
  }
  if (options.speak_test)
    return test_speech(options.head, options.mouth, options.output, options.json);
  const Writer* const writer = std::find_if(
      std::begin(kWriters), std::end(kWriters),
      [kind = extension_of(options.output)](const Writer& each) { return each.extension == kind; });
  if (!options.output.empty() && writer == std::end(kWriters)) {
    return usage_error(
        "a head is written as .fdp, .xmt, .glb or .obj; pictures are for --speak-test");
  }
  studio::HeadChoice choice = options.head;
  choice.colours_at_vertices = writer != std::end(kWriters);
  const Result<studio::LoadedHead> loaded = studio::load_head(choice);
  if (!loaded) return loaded.error();
  const head::Rig rig = head::make_rig(loaded->head);
  if (!options.output.empty()) {
    for (const std::string& note : loaded->notes) say(options.head.head + ": " + note);
    if (auto ok = writer->write({options.output, loaded->head, rig}); !ok) return ok.error();
    if (!options.json) return kOk;
  }
  const Json info = describe(*loaded, rig);
  if (options.json) {
    std::printf("%s\n", pretty(info).c_str());
  } else {
    print_text(info);
  }
  return kOk;
}

void add_options(OptionTable& cli, HeadOptions& options) {
  cli.add("head", options.head.head, kHeadHelp)->show_default();
  cli.add("--points", options.head.points, kPointsHelp);
  add_shape_options(cli, options.head);
  add_gain_option(cli, options.head)->help += "; default: auto for --speak-test, else 1";
  cli.add("--speak-test", options.speak_test,
          "Speak with the head and measure: P B M closed within 0.1 mm, UW OW W rounder than IY, "
          "AA open by 70 % of a full jawOpen, F V with the lip and TH with the tongue at the "
          "teeth, lids that shut; exit code 1 if it falls short of any; with -o a sheet of its "
          "visemes");
  add_mouth_option(cli, options.mouth);
  cli.add("-o,--output", options.output,
          "Head to write: .fdp (Xface; with its mesh, .wrl, and textures, .tga), .xmt "
          "(MPEG-4 scene with an FDP), .glb (with morph targets), .obj (with a list of "
          "feature points); with --speak-test: .png, .jpg, .webp")
      ->output(".png .jpg .jpeg .webp .xmta .fdp .xmt .glb .obj", OutputKind::file);
  cli.add("--json", options.json, "Print the same as JSON");
}

}  // namespace

const Command kHead{
    "head",
    "Print what a head contains and which FAPs move it; convert it for Xface, Blender "
    "and MPEG-4",
    "  animeme head me.glb\n"
    "  animeme head me.glb --speak-test -o visemes.png   # can it close P B M, round UW, open AA?\n"
    "  animeme head me.obj --points landmarks.csv\n"
    "  animeme head woman -o woman.fdp     # for XfacePlayer\n"
    "  animeme head child -o child.obj     # to edit; child.points.csv is beside it\n"
    "\n"
    "A table of landmarks is a text file: the line 2.1,966 makes vertex 966 (from 0) the chin. "
    "The mouth needs 2.2-2.9 and 8.1-8.8, lids 3.1-3.4, brows 4.1-4.6, the chin 2.1 and 2.10, the "
    "nose 9.1-9.3 and 9.15, cheeks 5.1-5.4; further points improve it. Show the head with --head "
    "me.obj --points landmarks.csv in render, view and export.",
    set_up<HeadOptions>};

}  // namespace animeme::tools

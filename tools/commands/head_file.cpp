#include "tools/commands/head_file.h"

#include <filesystem>

#include "fap/head/obj.h"
#include "fap/head/own_head.h"
#include "fap/head/point_list.h"
#include "tools/commands/common.h"
#include "tools/gltf/read_head.h"

namespace animeme::tools {
namespace {

constexpr const char* kOurs = "woman, man or child";

Result<std::vector<head::PointRow>> read_point_list(const std::string& path) {
  const Result<std::string> text = read_text_file(path);
  if (!text) return text.error();
  Result<std::vector<head::PointRow>> rows = head::read_points(*text);
  if (!rows) return rows.error().in_file(path);
  return rows;
}

Result<head::Source> read_obj_head(const HeadChoice& choice) {
  const Result<std::string> text = read_text_file(choice.head);
  if (!text) return text.error();
  Result<head::ObjFile> file = head::read_obj(*text);
  if (!file) return file.error().in_file(choice.head);
  const Result<std::vector<head::PointRow>> rows = read_point_list(choice.points);
  if (!rows) return rows.error();
  Result<std::vector<head::PiecePoint>> points = head::points_on(*file, *rows);
  if (!points) return points.error().in_file(choice.points);
  head::Source source;
  source.pieces = std::move(file->pieces);
  source.points = std::move(*points);
  return source;
}

bool is_gltf(const std::string& kind) {
  return kind == ".glb" || kind == ".gltf" || kind == ".vrm";
}

Result<head::Source> read_source(const HeadChoice& choice) {
  if (is_gltf(extension_of(choice.head))) return gltf::read_head_file(choice.head);
  return read_obj_head(choice);
}

}  // namespace

void add_head_options(CLI::App& app, HeadChoice& choice) {
  app.add_option("--head", choice.head,
                 std::string(kOurs) +
                     ", or a head of your own: .glb, .gltf or .vrm with "
                     "ARKit's shapes or visemes, .obj with --points")
      ->capture_default_str();
  app.add_option("--points", choice.points,
                 "Which vertex of your head is which feature point: lines such as 2.1,966");
}

std::string problem_of(const HeadChoice& choice) {
  if (head::head_parameters(choice.head)) {
    if (choice.points.empty()) return "";
    return "--points is for a head of your own; give its file with --head";
  }
  if (!std::filesystem::exists(choice.head)) {
    return "--head is " + std::string(kOurs) + ", or a file; there is no file \"" + choice.head +
           "\"";
  }
  const std::string kind = extension_of(choice.head);
  if (is_gltf(kind)) {
    if (choice.points.empty()) return "";
    return "--points is for .obj files; the shapes of a glTF file move it";
  }
  if (kind != ".obj") {
    return "--head " + choice.head +
           ": a head of your own is a .glb, .gltf or .vrm file, or an .obj with --points";
  }
  if (kind == ".obj" && choice.points.empty()) {
    return "an .obj does not tell where its face is: add --points LIST, a text with lines such as "
           "2.1,966 (feature point, vertex counted from 0)";
  }
  return "";
}

Result<LoadedHead> load_head(const HeadChoice& choice) {
  if (std::string problem = problem_of(choice); !problem.empty()) {
    return make_error(Code::invalid_argument, std::move(problem));
  }
  LoadedHead loaded;
  if (const auto parameters = head::head_parameters(choice.head)) {
    Result<head::Head> made = head::make_head(*parameters);
    if (!made) return made.error();
    loaded.head = std::move(*made);
    return loaded;
  }
  Result<head::Source> source = read_source(choice);
  if (!source) return source.error();
  source->name = std::filesystem::path(choice.head).stem().string();
  Result<head::Head> made = head::assemble(std::move(*source), &loaded.notes);
  if (!made) return made.error().in_file(choice.head);
  loaded.head = std::move(*made);
  return loaded;
}

Result<head::Head> load_head_and_tell(const HeadChoice& choice) {
  Result<LoadedHead> loaded = load_head(choice);
  if (!loaded) return loaded.error();
  for (const std::string& note : loaded->notes) say(choice.head + ": " + note);
  return std::move(loaded->head);
}

}  // namespace animeme::tools

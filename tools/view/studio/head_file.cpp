#include "tools/view/studio/head_file.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <new>

#include "fap/head/obj.h"
#include "fap/head/own_head.h"
#include "fap/head/people.h"
#include "fap/head/point_list.h"
#include "fap/wider.h"
#include "fap/xml/fdp.h"
#include "fap/xml/xmt.h"
#include "tools/formats/files/file_cache.h"
#include "tools/formats/files/files.h"
#include "tools/view/gltf/obj_folder.h"
#include "tools/view/gltf/read_head.h"
#include "tools/view/gltf/shape_names.h"
#include "tools/view/studio/head_store.h"
#include "tools/view/studio/speak_check.h"

namespace animeme::studio {
namespace {

constexpr const char* kOurs = "woman, man, child, amara, mei, rosa, omar, kenji or george";
constexpr const char* kNamesOfShapes =
    "--shape-name and --shape-names are for a .glb, .gltf, .vrm or folder with shapes; give one "
    "with "
    "--head";

// What a file name says of its format.
enum class Format : std::uint8_t { none, obj, folder, gltf, fdp, xmt };

Format format_of(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) return Format::folder;
  std::string kind = tools::extension_of(path);
  if (kind == ".gz") kind = tools::extension_of(path.substr(0, path.size() - kind.size())) + kind;
  if (kind == ".obj" || kind == ".obj.gz") return Format::obj;
  if (kind == ".glb" || kind == ".gltf" || kind == ".vrm") return Format::gltf;
  if (kind == ".fdp") return Format::fdp;
  if (kind == ".xmt" || kind == ".xmta") return Format::xmt;
  return Format::none;
}

Result<std::vector<head::PointRow>> read_point_list(const std::string& path) {
  const Result<std::string> text = tools::read_text_file(path);
  if (!text) return text.error();
  Result<std::vector<head::PointRow>> rows = head::read_points(*text);
  if (!rows) return rows.error().in_file(path);
  return rows;
}

Result<head::Source> read_obj_head(const HeadChoice& choice) {
  const Result<std::string> text = gltf::read_obj_text(choice.head);
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

// The points say where the face is; its shapes move it.
Result<head::Source> read_folder_head(const HeadChoice& choice) {
  gltf::ReadOptions options;
  options.vertices = 0;  // there are no textures
  auto rules = gltf::shape_rules_of(choice.shape_names, choice.shape_table);
  if (!rules) return rules.error();
  options.rules = std::move(*rules);
  Result<gltf::HeadFile> file = gltf::read_obj_folder(choice.head, std::move(options));
  if (!file) return file.error();
  if (!choice.points.empty()) {
    const Result<std::vector<head::PointRow>> rows = read_point_list(choice.points);
    if (!rows) return rows.error();
    Result<std::vector<head::PiecePoint>> points = gltf::points_on(*file, *rows);
    if (!points) return points.error().in_file(choice.points);
    file->source.points = std::move(*points);
  } else if (file->source.shapes.empty()) {
    return make_error(Code::not_found,
                      "nothing says how its face moves: " + gltf::advice_on_names(file->unknown) +
                          "; with --points LIST its points move it")
        .in_file(choice.head);
  }
  return std::move(file->source);
}

Result<head::Source> read_gltf_head(const HeadChoice& choice, std::string& advice) {
  gltf::ReadOptions options;
  if (!choice.colours_at_vertices) options.vertices = 0;
  auto rules = gltf::shape_rules_of(choice.shape_names, choice.shape_table);
  if (!rules) return rules.error();
  options.rules = std::move(*rules);
  Result<gltf::HeadFile> file = gltf::read_head_and_vertices(choice.head, std::move(options));
  if (!file) return file.error();
  if (choice.points.empty()) {
    const head::Source& source = file->source;
    if (source.shapes.empty()) advice = gltf::advice_on_names(file->unknown);
    if (source.shapes.empty() && source.points.empty() && !source.eyes[0]) {
      return make_error(Code::not_found, "there is no face in it: nothing in it is an eye, and " +
                                             gltf::advice_on_names(file->unknown) +
                                             "; with --points LIST a head is made of its mesh")
          .in_file(choice.head);
    }
    return std::move(file->source);
  }
  const Result<std::vector<head::PointRow>> rows = read_point_list(choice.points);
  if (!rows) return rows.error();
  Result<std::vector<head::PiecePoint>> points = gltf::points_on(*file, *rows);
  if (!points) return points.error().in_file(choice.points);
  // The points move it then, not its shapes.
  file->source.points = std::move(*points);
  file->source.shapes.clear();
  file->source.targets.clear();
  return std::move(file->source);
}

Result<head::Source> read_xml_head(const HeadChoice& choice, Format format) {
  const Result<std::string> text = tools::read_text_file(choice.head);
  if (!text) return text.error();
  const std::filesystem::path folder = std::filesystem::path(choice.head).parent_path();
  const auto load =
      [&, files = gltf::files_of(folder.string())](const std::string& name) -> Result<std::string> {
    const auto bytes = files(name);
    if (!bytes) return bytes.error().in_file((folder / name).string());
    return std::string(bytes->begin(), bytes->end());
  };
  Result<head::Source> source =
      format == Format::fdp ? head::read_fdp(*text, load) : head::read_xmt(*text);
  if (!source) {
    return source.error().where.file.empty() ? source.error().in_file(choice.head) : source.error();
  }
  return source;
}

// `advice`: on names of shapes, if they alone do not make a head.
Result<head::Source> read_source(const HeadChoice& choice, std::string& advice) {
  const Format format = format_of(choice.head);
  if (format == Format::obj) return read_obj_head(choice);
  if (format == Format::folder) return read_folder_head(choice);
  if (format == Format::gltf) return read_gltf_head(choice, advice);
  return read_xml_head(choice, format);
}

Result<LoadedHead> load_as_it_is(const HeadChoice& choice) {
  LoadedHead loaded;
  if (head::names_person(choice.head)) {
    Result<head::Head> made = ready_head(choice.head);
    if (!made) return made.error();
    loaded.head = std::move(*made);
    return loaded;
  }
  std::string advice;
  Result<head::Source> source = read_source(choice, advice);
  if (!source) return source.error();
  if (source->name.empty() || format_of(choice.head) != Format::folder) {
    source->name = std::filesystem::path(choice.head).stem().string();
  }
  Result<head::Head> made = head::assemble(std::move(*source), &loaded.notes);
  if (!made) {
    Error error = made.error();
    if (!advice.empty()) error.message = advice + ". " + error.message;
    return std::move(error).in_file(choice.head);
  }
  loaded.head = std::move(*made);
  return loaded;
}

std::string gain_note(double gain) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "--gain auto: lips open %.2f times as wide", gain);
  return text.data();
}

}  // namespace

std::optional<double> gain_of(const std::string& text) {
  double gain = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, gain);
  const bool fits = error == std::errc() && stop == end && gain >= fap::kLeastMouthGain &&
                    gain <= fap::kMostMouthGain;
  return fits ? std::optional(gain) : std::nullopt;
}

std::string problem_of(const HeadChoice& choice) {
  if (choice.gain != "auto" && !gain_of(choice.gain)) {
    return "--gain is auto or a number from 0.25 to 4, not \"" + choice.gain + "\"";
  }
  if (head::names_person(choice.head)) {
    if (const auto parsed = head::parse_head(choice.head); !parsed) {
      return "--head " + choice.head + ": " + parsed.error().message;
    }
    if (choice.names_shapes()) return kNamesOfShapes;
    if (choice.points.empty()) return "";
    return "--points is for custom heads; give the file with --head";
  }
  if (!std::filesystem::exists(choice.head)) {
    return "--head is " + std::string(kOurs) + ", or a file; there is no file \"" + choice.head +
           "\"";
  }
  const Format format = format_of(choice.head);
  if (format == Format::none) {
    return "--head " + choice.head +
           ": a head of your own is a .glb, .gltf, .vrm, .fdp or .xmt file, an .obj with "
           "--points, or a folder with neutral.obj and an .obj for each shape";
  }
  if (format == Format::obj && choice.points.empty()) {
    return "an .obj does not define where its face is: add --points LIST, a text with lines such "
           "as "
           "2.1,966 (feature point, vertex counted from 0)";
  }
  if (choice.names_shapes()) {
    if (format != Format::gltf && format != Format::folder) return kNamesOfShapes;
    if (!choice.points.empty() && format == Format::gltf) {
      return "--shape-name is for heads that their shapes move; with --points these do nothing";
    }
    for (const std::string& text : choice.shape_names) {
      const auto rule = gltf::shape_rules_of({text}, "");
      if (!rule) return rule.error().message;
    }
  }
  if ((format == Format::fdp || format == Format::xmt) && !choice.points.empty()) {
    return "--points is for .obj and .glb; " + choice.head + " has its own points";
  }
  return "";
}

Result<LoadedHead> load_head(const HeadChoice& choice) {
  if (std::string problem = problem_of(choice); !problem.empty()) {
    return make_error(Code::invalid_argument, std::move(problem));
  }
  try {
    Result<LoadedHead> loaded = load_as_it_is(choice);
    if (!loaded) return loaded;
    if (choice.gain == "auto") {
      const Result<double> gain = speaking_gain(loaded->head);
      if (!gain && gain.error().code != Code::not_found) return gain.error().in_file(choice.head);
      loaded->head.mouth_gain = gain ? *gain : 1;
      loaded->notes.push_back(gain ? gain_note(*gain)
                                   : "--gain auto: lips open without gain, since " +
                                         gain.error().message);
    } else {
      loaded->head.mouth_gain = gain_of(choice.gain).value_or(1);
    }
    return loaded;
  } catch (const std::bad_alloc&) {
    if (format_of(choice.head) == Format::none) {  // our own cannot be reduced
      return make_error(Code::internal,
                        "there is not enough memory for a head; close other programs");
    }
    return make_error(Code::out_of_range,
                      "there is not enough memory for this head; reduce its meshes")
        .in_file(choice.head);
  }
}

Result<head::Head> load_head(const HeadChoice& choice, const tools::Log& log) {
  static tools::FileCache<LoadedHead> cache;  // batches ask again and again
  std::string how = choice.points + "\n" + choice.gain + (choice.colours_at_vertices ? "c" : "") +
                    "\n" + choice.shape_table;
  for (const std::string& rule : choice.shape_names) how += "\n" + rule;
  Result<LoadedHead> loaded = cache.get(choice.head, how, [&] { return load_head(choice); });
  if (!loaded) return loaded.error();
  for (const std::string& note : loaded->notes) log.info(choice.head + ": " + note);
  return std::move(loaded->head);
}

}  // namespace animeme::studio

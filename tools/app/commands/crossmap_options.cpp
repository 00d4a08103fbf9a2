#include "tools/app/commands/crossmap_options.h"

#include <charconv>
#include <filesystem>
#include <utility>

#include "tools/app/commands/options.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {

namespace {

using crossmap::Project;

template <class T>
void take(const std::optional<T>& given, T& out) {
  if (given) out = *given;
}

void take(const std::vector<std::string>& given, std::vector<std::string>& out) {
  if (!given.empty()) out = given;
}

// A text that is a number and nothing else.
std::optional<double> number_of_text(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end) return std::nullopt;
  return value;
}

// "M=take1.csv:1.24", "take1.csv:1.24", "1.24".
std::optional<crossmap::NamedKey> parse_key(std::string text) {
  crossmap::NamedKey key;
  if (const std::size_t at = text.find('='); at != std::string::npos) {
    key.name = text.substr(0, at);
    text.erase(0, at + 1);
  }
  if (const std::size_t at = text.rfind(':'); at != std::string::npos) {
    key.input = text.substr(0, at);
    text.erase(0, at + 1);
  }
  const auto seconds = number_of_text(text);
  if (!seconds || !(*seconds >= 0 && *seconds <= 1e9)) return std::nullopt;
  key.seconds = *seconds;
  return key;
}

// "MW=50".
std::optional<std::pair<std::string, double>> parse_fapu(const std::string& text) {
  const std::size_t at = text.find('=');
  const auto size = at == std::string::npos ? std::nullopt : number_of_text(text.substr(at + 1));
  if (!size || !(*size > 0 && *size <= 1e9)) return std::nullopt;
  return std::pair(text.substr(0, at), *size);
}

std::string problem_of_fapu(const std::string& text) {
  return parse_fapu(text) ? "" : "'" + text + "' is not a FAP unit; write MW=50";
}

std::string problem_of_key(const std::string& text) {
  return parse_key(text) ? ""
                         : "'" + text + "' is not a key shape; write NAME=take.csv:1.24 (seconds)";
}

void add_point_options(OptionTable& cli, CrossmapOptions& options) {
  const char* group = "Captured points";
  const auto add = [&](Option* option) { option->in_group(group); };
  add(cli.add("--neutral", options.neutral,
              "The face at rest: a file of the same points (table, C3D or JSON), or seconds of "
              "the first recording such as 0-0.4s. Default: the stillest 0.2 seconds"));
  add(cli.add("--use", options.use,
              "Points to fit, A,B,C; default: all (of a whole face those of the mouth)")
          ->at_commas());
  add(cli.add("--head-points", options.head,
              "Points that do not move with the face, A,B,C: they are used to remove head "
              "motion; none: there is no head motion")
          ->at_commas());
  add(cli.add("--fapu", options.fapu,
              "Sizes of the captured face in its own unit, MW=38,MNS=19.5 (mouth width, mouth to "
              "nose); default: measured, or those of an average face")
          ->type("UNIT=SIZE")
          ->check(problem_of_fapu)
          ->at_commas());
  add(cli.add("--unit", options.unit, "Unit of the points")->one_of("mm cm m in"));
  add(cli.add("--axes", options.axes,
              "Directions of x, y (and z) seen by the person: \"left down back\" is a camera; "
              "default: detected"));
  add(cli.add("--layout", options.layout, "Layout of numbered points")->one_of("68 mediapipe"));
  add(cli.add("--rate", options.rate, "Frames per second, if the table has no times")
          ->frame_rate());
  add(cli.add("--size", options.size,
              "Size of the picture, such as 1280x720, if points are fractions of it")
          ->picture_size());
}

void add_key_options(OptionTable& cli, CrossmapOptions& options) {
  const char* group = "Key shapes";
  const auto add = [&](Option* option) { option->in_group(group); };
  add(cli.add("--shapes-wanted", options.count,
              "Number of key shapes; default: chosen from the recording")
          ->between(1, 200));
  add(cli.add("--preference", options.preference,
              "Preference of a frame to be a key shape, below 0; default: the median of all pairs")
          ->between(-1e9, 0));
  add(cli.add("--key", options.named,
              "Use this frame as a key shape, NAME=take.csv:1.24 (seconds); may be repeated")
          ->type("KEY=FILE:SECONDS")
          ->check(problem_of_key));
  add(cli.add("--keys", options.keys,
              "Folder of key shapes that --write-keys wrote and you edited"));
  add(cli.add("--contact-weight", options.contact_weight,
              "Weight of lip contact relative to other points; default: 3")
          ->between(0.0, 1e6));
  add(cli.add("--smooth", options.smooth,
              "Standard deviation of smoothing in seconds; default: 0. Smoothing loses short "
              "closures")
          ->between(0.0, 1.0));
  cli.add("--convex", options.convex,
          "Do not extrapolate beyond the key shapes: less noise, but larger shapes are missed")
      ->in_group(group);
}

}  // namespace

Result<Project> project_of(const CrossmapOptions& options) {
  Project out;
  std::vector<std::string> inputs = options.inputs;
  if (extension_of(inputs[0]) == ".toml") {
    const Result<std::string> text = read_text_file(inputs[0], kMostWritten);
    if (!text) return text.error();
    auto read =
        crossmap::read_project(*text, std::filesystem::path(inputs[0]).parent_path().string());
    if (!read) return std::move(read).error().in_file(inputs[0]);
    out = std::move(*read);
    inputs.erase(inputs.begin());
  }
  take(inputs, out.inputs);
  take(options.to, out.to);
  take(options.points, out.head_points);
  take(options.neutral, out.neutral);
  take(options.keys, out.keys);
  take(options.rate, out.rate);
  take(options.size, out.size);
  take(options.layout, out.layout);
  take(options.axes, out.axes);
  take(options.unit, out.unit);
  take(options.shapes, out.shapes);
  take(options.controls, out.controls);
  take(options.use, out.points);
  take(options.head, out.head);
  take(options.count, out.search.count);
  if (options.preference) out.search.preference = *options.preference;
  take(options.smooth, out.fit.smooth);
  take(options.contact_weight, out.fit.contact_weight);
  if (options.convex) out.fit.convex = true;
  for (const std::string& text : options.fapu) {
    const auto [name, size] = *parse_fapu(text);
    out.fapu[name] = size;
  }
  for (const std::string& text : options.named) out.named.push_back(*parse_key(text));
  return out;
}

void add_options(OptionTable& cli, CrossmapOptions& options) {
  cli.add("input", options.inputs,
          "Recordings of points: tables with UL_x, UL_y, UL_z ... or x61, y61 ..., or C3D "
          "files; they share their key shapes. Or a project file (.toml) with all options")
      ->required();
  cli.add("-o,--output", options.output,
          "Curves to write: .fap, .csv, or a folder for several recordings")
      ->output(".fap .csv", OutputKind::file_or_folder);
  cli.add("--picture", options.picture, "Write a picture of source, key shapes and target")
      ->output(".svg .png", OutputKind::file);
  cli.add("--write-keys", options.write_keys,
          "Write the key shapes to this folder, with a first guess of the character's "
          "controls for each, and meshes to start from")
      ->output("", OutputKind::folder);
  cli.add("--json", options.json, "Print residuals per frame and region");
  cli.add("--csv", options.csv, "Write FAPs as curves (.csv), as training reads them");
  cli.add("--to", options.to,
          "What moves your character: faps, arkit, keys (a control per key shape), a table "
          "of controls for each key shape (.csv), or its head (.glb, .vrm, .obj, woman)");
  cli.add("--points", options.points,
          "Feature points of an .obj or .glb head, as of animeme render");
  cli.add("--shapes", options.shapes,
          "OBJ files of an .obj head: the shape of each control at full value");
  cli.add("--controls", options.controls, "Controls that may move, A,B,C; default: all")
      ->at_commas();
  add_key_options(cli, options);
  add_point_options(cli, options);
}

}  // namespace animeme::tools

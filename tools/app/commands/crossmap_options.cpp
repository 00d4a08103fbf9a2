#include "tools/app/commands/crossmap_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <utility>

#include "tools/app/commands/bounds.h"
#include "tools/app/commands/outputs.h"
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
  return parse_fapu(text) ? "" : "'" + text + "' is no FAP unit; write MW=50";
}

std::string problem_of_key(const std::string& text) {
  return parse_key(text) ? ""
                         : "'" + text + "' is no key shape; write NAME=take.csv:1.24 (seconds)";
}

void add_point_options(CLI::App& app, CrossmapOptions& options) {
  const char* group = "Captured points";
  const auto add = [&](CLI::Option* option) { option->group(group); };
  add(app.add_option("--neutral", options.neutral,
                     "The face at rest: a file of the same points (table, C3D or JSON), or seconds "
                     "of the first recording like 0-0.4s. Without it: the stillest 0.2 seconds"));
  add(app.add_option("--use", options.use,
                     "Points to fit, A,B,C; without it all (of a whole face those of the mouth)")
          ->delimiter(','));
  add(app.add_option("--head-points", options.head,
                     "Points that do not move with the face, A,B,C: the head is held still by "
                     "them; none: it is still already")
          ->delimiter(','));
  add(app.add_option("--fapu", options.fapu,
                     "Sizes of the captured face in its own unit, MW=38,MNS=19.5 (mouth width, "
                     "mouth to nose); without it measured, or those of a usual face")
          ->type_name("UNIT=SIZE")
          ->check(written_so(problem_of_fapu))
          ->delimiter(','));
  add(app.add_option("--unit", options.unit, "Unit of the points")
          ->check(CLI::IsMember({"mm", "cm", "m", "in"})));
  add(app.add_option("--axes", options.axes,
                     "Where x, y (and z) point to, seen by the person: \"left down back\" is a "
                     "camera; without it the points tell"));
  add(app.add_option("--layout", options.layout, "What numbered points are")
          ->check(CLI::IsMember({"68", "mediapipe"})));
  add(app.add_option("--rate", options.rate, "Frames a second, if the table has no times")
          ->type_name("RATE")
          ->check(frame_rate()));
  add(app.add_option("--size", options.size,
                     "Size of the picture, like 1280x720, where points are shares of it")
          ->type_name("WIDTHxHEIGHT")
          ->check(picture_size()));
}

void add_key_options(CLI::App& app, CrossmapOptions& options) {
  const char* group = "Key shapes";
  const auto add = [&](CLI::Option* option) { option->group(group); };
  add(app.add_option("--shapes-wanted", options.count,
                     "How many key shapes to find; without it the recording decides")
          ->check(between(1, 200)));
  add(app.add_option("--preference", options.preference,
                     "How willing a frame is to be a key shape, below 0; the median of all pairs")
          ->check(between(-1e9, 0)));
  add(app.add_option("--key", options.named,
                     "A key shape of your choice, NAME=take.csv:1.24 (seconds); once for each")
          ->type_name("KEY=FILE:SECONDS")
          ->check(written_so(problem_of_key)));
  add(app.add_option("--keys", options.keys,
                     "Folder of key shapes that --write-keys wrote and you adjusted"));
  add(app.add_option("--contact-weight", options.contact_weight,
                     "How much lips that meet count beside other points; 3")
          ->check(between(0.0, 1e6)));
  add(app.add_option(
             "--smooth", options.smooth,
             "Seconds (standard deviation) to average over; 0. Short closures get lost in it")
          ->check(between(0.0, 1.0)));
  app.add_flag("--convex", options.convex,
               "Never go beyond the key shapes; quieter, and larger shapes are missed")
      ->group(group);
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

void add_options(CLI::App& app, CrossmapOptions& options) {
  app.add_option(
         "input", options.inputs,
         "Recordings of points: tables with UL_x, UL_y, UL_z ... or x61, y61 ..., C3D files; "
         "they share their key shapes. Or a project (.toml), which says all of this")
      ->required();
  add_output(app.add_option("-o,--output", options.output,
                            "Curves to write: .fap, .csv, or a folder for several recordings"),
             {".fap", ".csv"}, OutputKind::file_or_folder);
  add_output(app.add_option("--picture", options.picture,
                            "Picture of source, key shapes and target to write"),
             {".svg", ".png"}, OutputKind::file);
  add_output(app.add_option("--write-keys", options.write_keys,
                            "Folder for the key shapes, the first guess of your character's "
                            "controls in each, and meshes to begin with"),
             {}, OutputKind::folder);
  app.add_flag("--json", options.json, "Residuals by frame and region on standard output");
  app.add_flag("--csv", options.csv, "FAPs as curves (.csv), as training takes them");
  app.add_option("--to", options.to,
                 "What moves your character: faps, arkit, keys (one control a key shape), a table "
                 "of controls in each key shape (.csv), or its head (.glb, .vrm, .obj, woman)");
  app.add_option("--points", options.points,
                 "Feature points of an .obj or .glb head, as animeme render takes them");
  app.add_option("--shapes", options.shapes,
                 "OBJ files of an .obj head: what each of its controls does when it is full on");
  app.add_option("--controls", options.controls, "Controls that may move, A,B,C; all")
      ->delimiter(',');
  add_key_options(app, options);
  add_point_options(app, options);
}

}  // namespace animeme::tools

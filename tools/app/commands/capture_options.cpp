#include "tools/app/commands/capture_options.h"
#include "tools/app/commands/bounds.h"

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "fap/rate_text.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {

namespace {

Error wrong(const std::string& text) { return make_error(Code::invalid_argument, text); }

Result<void> set_columns(const CaptureOptions& options, exchange::ColumnMap& map) {
  for (const std::string& text : options.columns) {
    auto rule = exchange::parse_column_rule(text);
    if (!rule) return wrong("--column " + text + ": " + rule.error().message);
    map.push_back(std::move(*rule));
  }
  if (options.column_file.empty()) return {};
  const auto text = read_text_file(options.column_file, kMostWritten);
  if (!text) return text.error();
  auto rules = exchange::read_column_map(*text);
  if (!rules) return std::move(rules).error().in_file(options.column_file);
  map.insert(map.end(), rules->begin(), rules->end());
  return {};
}

Result<void> set_tracker(const CaptureOptions& options, CaptureSettings& settings) {
  std::string command = options.tracker;
  const char* usual = std::getenv("ANIMEME_TRACKER");
  if (command.empty() && usual != nullptr) command = usual;
  if (command.empty()) return {};
  auto tracker = Tracker::parse(command);
  if (!tracker) {
    return wrong((options.tracker.empty() ? "ANIMEME_TRACKER: " : "--tracker: ") +
                 tracker.error().message);
  }
  settings.tracker = std::move(*tracker);
  return {};
}

// Width of a pixel to its height, of "16:15" or "1.067".
std::optional<double> aspect_of(const std::string& text) {
  const auto shape =
      exchange::parse_picture_size(text.find(':') == std::string::npos ? text + ":1" : text);
  if (!shape) return std::nullopt;
  const double aspect = shape->width / shape->height;
  return aspect >= 0.01 && aspect <= 100 ? std::optional(aspect) : std::nullopt;
}

std::string problem_of_aspect(const std::string& text) {
  return aspect_of(text) ? "" : "'" + text + "' is no shape of a pixel; write 16:15 or 1.067";
}

std::string problem_of_depth(const std::string& text) {
  if (const std::string wrong = between(-1e6, 1e6)(text); !wrong.empty()) return wrong;
  return std::stod(text) == 0 ? "0 leaves no depth; --flat leaves it out" : "";
}

void add_landmark_options(CLI::App& app, CaptureOptions& options) {
  exchange::LandmarkImportOptions& landmarks = options.settings.landmarks;
  const auto seen = [&options](const std::string&) { options.for_landmarks = true; };
  const auto add = [&](CLI::Option* option) { option->group(kLandmarkGroup)->each(seen); };
  const auto flag = [&](const char* name, bool& value, const char* help) {
    app.add_flag_callback(
           name, [&options, &value] { value = options.for_landmarks = true; }, help)
        ->group(kLandmarkGroup);
  };
  add(app.add_option("--neutral", landmarks.neutral,
                     "Where the face is neutral (looks at the camera, eyes open, mouth closed): "
                     "frames like 12 or 0-24, seconds like 1.5s or 0.5-1.2s. Without it: frames "
                     "with open eyes and closed lips, the calmer half of them"));
  add(app.add_option("--smooth", landmarks.face.smooth,
                     "Seconds (standard deviation) to average over, both ways, so nothing is "
                     "delayed; 0 leaves all as it is")
          ->capture_default_str()
          ->check(between(0.0, 1.0)));
  add(app.add_option("--layout", options.layout,
                     "What numbered points are, if the table has a part of them only")
          ->check(CLI::IsMember({"68", "mediapipe"})));
  add(app.add_option("--size", options.size,
                     "Size of the picture, like 1280x720, where points are shares of it "
                     "(MediaPipe); a video says it itself")
          ->type_name("WIDTHxHEIGHT")
          ->check(picture_size()));
  add(app.add_option("--pixel-aspect", options.pixel_aspect,
                     "Width of a pixel to its height, like 16:15 or 1.067, where points are pixels "
                     "of a video that is shown wider than it is stored")
          ->type_name("WIDTH:HEIGHT")
          ->check(written_so(problem_of_aspect)));
  add(app.add_option("--depth-scale", landmarks.table.depth_scale,
                     "z times this has the unit of x and y")
          ->check(written_so(problem_of_depth))
          ->capture_default_str());
  add(app.add_option("--face", options.face, "Number (face_id) of the face to read; the first")
          ->check(at_least_zero()));
  add(app.add_option("--confidence", landmarks.table.confidence,
                     "Rows with less are left out (OpenFace)")
          ->check(between(0, 1))
          ->capture_default_str());
  flag("--flat", landmarks.table.flat, "Use the picture alone, not the depth");
  flag("--mirrored", landmarks.face.mirrored,
       "The picture was mirrored, as selfie cameras do: swap left and right");
}

}  // namespace

void add_capture_options(CLI::App& app, CaptureOptions& options) {
  app.add_option("--rate", options.rate,
                 "Frames a second of the clip, like 30 or 29.97; without it the times tell")
      ->type_name("RATE")
      ->check(frame_rate());
  app.add_flag("--degrees", options.degrees, "Angles of head and eyes are degrees, not radians");
  app.add_option("--column", options.columns,
                 "What a column is whose name says nothing: NAME=jawOpen, NAME=jawOpen*0.01, "
                 "NAME=x_61, NAME=fap3, NAME=time_s; mouthL_*=8.3_* for x, y and z; NAME=- leaves "
                 "it out. As often as needed")
      ->allow_extra_args(false);
  app.add_option("--columns", options.column_file, "The same as a table: column,meaning[,factor]");
  app.add_flag("--shapes", options.settings.table.shapes,
               "Of a JSON with landmarks and blend shapes the blend shapes");
  app.add_flag_callback(
      "--no-repair", [&options] { options.settings.landmarks.repair = false; },
      "Leave glitches and gaps as they are. Without it: a face that jumps away and back is left "
      "out, and at most 0.2 s are put between their neighbours");
  app.add_option(
      "--tracker", options.tracker,
      "Of videos: the command of a tracker, {in} for the video, {out} for the table that "
      "it writes (else its standard output). Without it: the environment variable "
      "ANIMEME_TRACKER. No shell is run");
  app.add_option("--tracker-seconds", options.settings.tracker_seconds,
                 "Longest that a tracker may take for a video. Without it: an hour, or thirty "
                 "times the length of the video if that is more")
      ->check(between(0.1, 1e6));
  add_landmark_options(app, options);
}

void add_neutral_options(CLI::App& app, NeutralSource& source) {
  app.add_option("--neutral-from", source.from,
                 "Another recording of the same person, whose neutral face counts (with --neutral: "
                 "that part of it)")
      ->group(kLandmarkGroup);
  app.add_option("--face-file", source.face_file,
                 "The neutral face, as --save-face wrote it (or neutral.json of a corpus)")
      ->group(kLandmarkGroup);
}

Result<CaptureSettings> capture_settings(const CaptureOptions& options) {
  CaptureSettings settings = options.settings;
  settings.degrees = options.degrees;
  if (!options.rate.empty()) {
    const Result<fap::Rate> rate = fap::parse_rate(options.rate);
    if (!rate) return rate.error();
    settings.rate = *rate;
  }
  exchange::LandmarkTableOptions& table = settings.landmarks.table;
  if (!options.size.empty()) table.size = exchange::parse_picture_size(options.size);
  if (const auto aspect = aspect_of(options.pixel_aspect)) table.pixel_aspect = *aspect;
  if (options.layout == "68") table.layout = fap::LandmarkLayout::ibug68;
  if (options.layout == "mediapipe") table.layout = fap::LandmarkLayout::mediapipe;
  if (options.face >= 0) table.face = options.face;
  if (auto ok = set_columns(options, settings.table.columns); !ok) return ok.error();
  if (auto ok = set_tracker(options, settings); !ok) return ok.error();
  return settings;
}

}  // namespace animeme::tools

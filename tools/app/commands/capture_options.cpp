#include "tools/app/commands/capture_options.h"

#include <cstdlib>

#include "fap/rate_text.h"
#include "tools/app/commands/options.h"
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
  return aspect_of(text) ? "" : "'" + text + "' is not a pixel aspect ratio; write 16:15 or 1.067";
}

std::string problem_of_depth(const std::string& text) {
  if (const std::string wrong = problem_of_number(text, -1e6, 1e6); !wrong.empty()) return wrong;
  return std::stod(text) == 0 ? "0 is not a scale; --flat ignores the depth" : "";
}

void add_landmark_options(OptionTable& cli, CaptureOptions& options) {
  exchange::LandmarkImportOptions& landmarks = options.settings.landmarks;
  const auto add = [&](Option* option) {
    option->in_group(kLandmarkGroup)->sets(options.for_landmarks);
  };
  add(cli.add("--neutral", landmarks.neutral,
              "Where the face is neutral (looks at the camera, eyes open, mouth closed): frames "
              "such as 12 or 0-24, seconds such as 1.5s or 0.5-1.2s. Default: the calmer half of "
              "the frames with open eyes and closed lips"));
  add(cli.add("--smooth", landmarks.face.smooth,
              "Standard deviation of smoothing in seconds, without delay; 0: none")
          ->show_default()
          ->between(0.0, 1.0));
  add(cli.add("--layout", options.layout,
              "Layout of numbered points, if the table contains only some of them")
          ->one_of("68 mediapipe"));
  add(cli.add("--size", options.size,
              "Size of the picture, such as 1280x720, if points are fractions of it (MediaPipe); "
              "default: that of the video")
          ->picture_size());
  add(cli.add("--pixel-aspect", options.pixel_aspect,
              "Width of a pixel to its height, such as 16:15 or 1.067, if points are pixels of "
              "an anamorphic video")
          ->type("WIDTH:HEIGHT")
          ->check(problem_of_aspect));
  add(cli.add("--depth-scale", landmarks.table.depth_scale,
              "Factor from the unit of z to that of x and y")
          ->check(problem_of_depth)
          ->show_default());
  add(cli.add("--face", options.face, "Number (face_id) of the face to read; default: the first")
          ->at_least_zero());
  add(cli.add("--confidence", landmarks.table.confidence,
              "Leave out rows with less confidence (OpenFace)")
          ->between(0, 1)
          ->show_default());
  add(cli.add("--flat", landmarks.table.flat, "Ignore the depth of the points"));
  add(cli.add("--mirrored", landmarks.face.mirrored,
              "The picture is mirrored, as by selfie cameras: swap left and right"));
}

}  // namespace

void add_capture_options(OptionTable& cli, CaptureOptions& options) {
  cli.add("--rate", options.rate,
          "Frames per second of the clip, such as 30 or 29.97; default: from the times")
      ->frame_rate();
  cli.add("--degrees", options.degrees, "Angles of head and eyes are in degrees, not radians");
  cli.add("--column", options.columns,
          "Meaning of a column with another name: NAME=jawOpen, NAME=jawOpen*0.01, "
          "NAME=x_61, NAME=fap3, NAME=time_s; mouthL_*=8.3_* for x, y and z; NAME=- ignores "
          "it. May be repeated")
      ->one_at_a_time();
  cli.add("--columns", options.column_file, "The same as a table: column,meaning[,factor]");
  cli.add("--shapes", options.settings.table.shapes,
          "Read the blend shapes of a JSON file that has landmarks, too");
  cli.add("--no-repair", options.no_repair,
          "Keep glitches and gaps. Default: a face that jumps away and back is left out, and "
          "gaps up to 0.2 s are interpolated");
  cli.add("--tracker", options.tracker,
          "For videos: command of a tracker, with {in} for the video and {out} for the table "
          "that it writes (else its standard output). Default: the environment variable "
          "ANIMEME_TRACKER. No shell is run");
  cli.add("--tracker-seconds", options.settings.tracker_seconds,
          "Time limit of the tracker per video. Default: an hour, or thirty times the length "
          "of the video if that is more")
      ->between(0.1, 1e6);
  add_landmark_options(cli, options);
}

void add_neutral_options(OptionTable& cli, NeutralSource& source) {
  cli.add("--neutral-from", source.from,
          "Another recording of the same person that has the neutral face (with --neutral: "
          "that part of it)")
      ->in_group(kLandmarkGroup);
  cli.add("--face-file", source.face_file,
          "The neutral face, as written by --save-face (or neutral.json of a corpus)")
      ->in_group(kLandmarkGroup);
}

Result<CaptureSettings> capture_settings(const CaptureOptions& options) {
  CaptureSettings settings = options.settings;
  if (options.no_repair) settings.landmarks.repair = false;
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

// Motion captured by other programs: shapes of a phone, points of a tracker.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "fap/rate_text.h"
#include "tools/commands/common.h"
#include "tools/commands/face_text.h"
#include "tools/exchange/arkit.h"
#include "tools/exchange/landmarks.h"

namespace animeme::tools {

namespace {

struct ImportOptions {
  std::string input;
  std::string output;
  std::string rate;
  bool degrees = false;
  bool exact = false;
  std::string layout;
  std::string size;
  int face = -1;
  exchange::LandmarkImportOptions landmarks;
  bool for_landmarks = false;  // an option was given that only landmarks know
};

// Where the neutral face was and how large it is, for people.
std::string talk_of(const exchange::LandmarkImport& take, bool given) {
  const auto& frames = take.face.neutral_frames;
  std::string text =
      std::string(take.depth ? "points in space" : "points in the picture") + ", neutral face " +
      (given ? "given" : "found") + " in " + std::to_string(frames.size()) +
      (frames.size() == 1 ? " frame, " : " frames, ") + std::to_string(frames.front());
  if (frames.size() > 1) text += " to " + std::to_string(frames.back());
  const fap::Fapu& fapu = take.face.fapu;
  char units[200];
  std::snprintf(units, sizeof units,
                "; its units: IRISD %.4g, ES %.4g, ENS %.4g, MNS %.4g, MW %.4g", fapu.irisd,
                fapu.es, fapu.ens, fapu.mns, fapu.mw);
  return text + units;
}

// The clip, after what is to be said of it was said.
Result<fap::Sequence> read_table(const ImportOptions& options, std::optional<fap::Rate> rate,
                                 const std::string& text) {
  const auto tell = [&](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) warn(options.input + ": " + warning);
  };
  if (options.for_landmarks || exchange::is_landmark_table(text)) {
    exchange::LandmarkImportOptions settings = options.landmarks;
    settings.table.rate = rate;
    if (options.layout == "68") settings.table.layout = fap::LandmarkLayout::ibug68;
    if (options.layout == "mediapipe") settings.table.layout = fap::LandmarkLayout::mediapipe;
    if (options.face >= 0) settings.table.face = options.face;
    auto take = exchange::import_landmarks(text, settings);
    if (!take) return std::move(take).error().in_file(options.input);
    tell(take->warnings);
    say(options.input + ": " + talk_of(*take, !settings.neutral.empty()));
    return std::move(take->face.clip);
  }
  auto take = exchange::read_arkit_table(text, {rate, options.degrees});
  if (!take) return std::move(take).error().in_file(options.input);
  tell(take->warnings);
  return std::move(take->clip);
}

// Empty if FAP text may have this name: not that of another kind of file.
std::string wrong_output(const std::string& path) {
  const std::string extension = extension_of(path);
  for (const char* other : {".fba", ".mp4", ".mkv", ".ts", ".csv", ".json", ".glb"}) {
    if (extension != other) continue;
    return "--output is FAP text and should end in .fap, not " + extension +
           "; encode, mux and export make other files of it";
  }
  return {};
}

Result<int> run(ImportOptions options) {
  std::optional<fap::Rate> given_rate;
  if (!options.rate.empty()) {
    const Result<fap::Rate> rate = fap::parse_rate(options.rate);
    if (!rate || !rate->valid()) {
      return usage_error("--rate: '" + options.rate + "' is no frame rate; write 30 or 29.97");
    }
    given_rate = *rate;
  }
  if (!options.size.empty()) {
    options.landmarks.table.size = exchange::parse_picture_size(options.size);
    if (!options.landmarks.table.size) {
      return usage_error("--size: '" + options.size + "' is no size; write 1280x720");
    }
  }
  if (const std::string wrong = wrong_output(options.output); !wrong.empty()) {
    return usage_error(wrong);
  }
  const Result<std::string> text = read_text_file(options.input);
  if (!text) return text.error();
  if (text->starts_with("\x1f\x8b")) {
    return make_error(Code::unsupported, "this is a packed file; unpack it with gunzip first")
        .in_file(options.input);
  }
  if (options.for_landmarks && exchange::is_arkit_table(*text)) {
    return usage_error(options.input +
                       " has blend shapes: --layout, --neutral and the like are "
                       "for landmarks");
  }
  Result<fap::Sequence> read = read_table(options, given_rate, *text);
  if (!read) return std::move(read).error();
  fap::Sequence& clip = *read;
  if (options.input != "-") clip.name = std::filesystem::path(options.input).stem().string();
  FaceText face = face_text(clip);
  face.coded = options.exact;  // nobody has coded it: as it is
  OutputFile file(options.output);
  const Result<std::int64_t> frames = write_face_text(file, name_of_output(options.output), face);
  if (!frames) return frames.error();
  if (auto written = file.publish(); !written) return written.error();
  const std::int64_t skipped = clip.frames.back().number + 1 - std::int64_t(clip.frames.size());
  say(name_of_output(options.output) + ": " + std::to_string(*frames) + " frames, " +
      std::to_string(clip.frames.front().mask.count()) + " FAPs, " + fap::format_rate(clip.rate) +
      " frames a second" +
      (skipped == 0 ? ""
                    : ", " + std::to_string(skipped) +
                          (options.exact ? " frames skipped" : " of them held")));
  return kOk;
}

void add_landmark_options(CLI::App& app, ImportOptions& options) {
  const char* group = "Landmarks";
  const auto seen = [&options](const std::string&) { options.for_landmarks = true; };
  const auto add = [&](CLI::Option* option) { option->group(group)->each(seen); };
  const auto flag = [&](const char* name, bool& value, const char* help) {
    app.add_flag_callback(
           name, [&options, &value] { value = options.for_landmarks = true; }, help)
        ->group(group);
  };
  add(app.add_option("--neutral", options.landmarks.neutral,
                     "Where the face is neutral (looks at the camera, eyes open, mouth closed): "
                     "frames like 12 or 0-24, seconds like 1.5s or 0.5-1.2s. Without it: frames "
                     "with open eyes and closed lips, the calmer half of them"));
  add(app.add_option("--smooth", options.landmarks.face.smooth,
                     "Seconds (standard deviation) to average over, both ways, so nothing is "
                     "delayed; 0 leaves all as it is")
          ->capture_default_str()
          ->check(CLI::Range(0.0, 1.0)));
  add(app.add_option("--layout", options.layout,
                     "What numbered points are, if the table has a part of them only")
          ->check(CLI::IsMember({"68", "mediapipe"})));
  add(app.add_option("--size", options.size,
                     "Size of the picture, like 1280x720, where points are shares of it "
                     "(MediaPipe)"));
  add(app.add_option("--face", options.face, "Number (face_id) of the face to read; the first")
          ->check(CLI::NonNegativeNumber));
  add(app.add_option("--confidence", options.landmarks.table.confidence,
                     "Rows with less are left out (OpenFace)")
          ->capture_default_str());
  flag("--flat", options.landmarks.table.flat, "Use the picture alone, not the depth");
  flag("--mirrored", options.landmarks.face.mirrored,
       "The picture was mirrored, as selfie cameras do: swap left and right");
}

void add_options(CLI::App& app, ImportOptions& options) {
  app.add_option("input", options.input,
                 "Table (CSV) of ARKit blend shapes: of Live Link Face, or time_s and one column a "
                 "shape; or of landmarks: of OpenFace, 68 points (x_0, y_0 or landmark_0_x ...), "
                 "468 or 478 points of MediaPipe, or feature points (8.1_x, 8.1_y ...); - for "
                 "standard input")
      ->required();
  add_output(
      app.add_option("-o,--output", options.output, "FAP text to write, - for standard output"),
      {".fap", ".txt"})
      ->required();
  app.add_option("--rate", options.rate,
                 "Frames a second of the clip, like 30 or 29.97; without it the times tell");
  app.add_flag("--degrees", options.degrees, "Angles of head and eyes are degrees, not radians");
  add_exact_option(app, options.exact);
  add_landmark_options(app, options);
}

}  // namespace

const Command kImport{"import", "Turn a captured face (ARKit curves, landmarks) into FAPs",
                      "  animeme import take.csv -o take.fap\n"
                      "  animeme import take.csv --rate 29.97 -o take.fap\n"
                      "  animeme import take.csv -o - | animeme encode - -o take.fba\n"
                      "  animeme import openface.csv -o take.fap\n"
                      "  animeme import openface.csv --flat --neutral 0.5-1.2s -o take.fap\n"
                      "  animeme import mediapipe.csv --size 1280x720 --mirrored -o take.fap",
                      set_up<ImportOptions>};

}  // namespace animeme::tools

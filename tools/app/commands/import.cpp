// Motion captured by other programs: shapes of a phone, points of a tracker, videos by way of one.
#include <filesystem>
#include <set>

#include "dam/signal/fap_signal.h"
#include "fap/rate_text.h"
#include "tools/app/commands/capture_options.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/face_text.h"
#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/report.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/exchange/face_file.h"

namespace animeme::tools {

namespace {

struct ImportOptions {
  std::vector<std::string> inputs;
  std::string output;
  CaptureOptions capture;
  NeutralSource neutral;
  std::string save_face;
  bool exact = false;
};

// Where the neutral face was and how large it is, for people.
std::string talk_of(const exchange::LandmarkImport& take, bool given) {
  const auto& frames = take.face.neutral_frames;
  std::string text = std::string(take.depth ? "points in space" : "points in the picture");
  if (frames.empty()) {
    text += ", neutral face of another recording or of all";
  } else {
    text += std::string(", neutral face ") + (given ? "given" : "found") + " in " +
            std::to_string(frames.size()) + (frames.size() == 1 ? " frame, " : " frames, ") +
            std::to_string(frames.front());
    if (frames.size() > 1) text += " to " + std::to_string(frames.back());
  }
  const fap::Fapu& fapu = take.face.rest.fapu;
  return text + format("; its units: IRISD %.4g, ES %.4g, ENS %.4g, MNS %.4g, MW %.4g", fapu.irisd,
                       fapu.es, fapu.ens, fapu.mns, fapu.mw);
}

std::string stem_of(const std::string& path) {
  return path == "-" ? "standard input" : std::filesystem::path(path).stem().string();
}

// Empty if what is imported may have this name: not that of another kind of file.
std::string wrong_output(const std::string& path) {
  const std::string extension = extension_of(path);
  for (const char* other : {".fba", ".mp4", ".mkv", ".ts", ".json", ".glb"}) {
    if (extension != other) continue;
    return "--output is FAP text (.fap) or a table of curves (.csv), not " + extension +
           "; encode, mux and export make other files of it";
  }
  return {};
}

// Where the clips go: into one file, or each into one of its name in a folder.
struct Places {
  std::string folder;  // empty: one file
  bool corpus = false;

  std::string of(const std::string& input, const std::string& output) const {
    if (folder.empty()) return output;
    return (std::filesystem::path(folder) / (stem_of(input) + (corpus ? ".csv" : ".fap"))).string();
  }
};

Result<Places> find_places(const ImportOptions& options) {
  Places places;
  std::error_code ignored;
  const std::filesystem::path path = options.output;
  const bool folder = options.inputs.size() > 1 || options.output.ends_with('/') ||
                      (options.output != "-" && std::filesystem::is_directory(path, ignored));
  if (!folder) return places;
  if (options.output == "-") {
    return make_error(Code::invalid_argument,
                      "-o - is one stream for " + std::to_string(options.inputs.size()) +
                          " inputs; name a folder, in which each gets a file of its name");
  }
  if (!extension_of(options.output).empty() && !std::filesystem::is_directory(path, ignored)) {
    return make_error(Code::invalid_argument,
                      "-o " + options.output + " is one file for " +
                          std::to_string(options.inputs.size()) +
                          " inputs; name a folder, in which each gets a file of its name");
  }
  places.corpus = std::filesystem::is_regular_file(path / "utterances.tsv", ignored);
  places.folder = (places.corpus ? path / "fap" : path).string();
  std::error_code error;
  std::filesystem::create_directories(places.folder, error);
  if (error) {
    return make_error(Code::io,
                      "cannot create the folder " + places.folder + ": " + error.message());
  }
  std::set<std::string> names;
  for (const std::string& input : options.inputs) {
    const std::string name = places.of(input, options.output);
    if (!names.insert(name).second) {
      return make_error(Code::invalid_argument,
                        "two inputs would be written to " + name + "; import them one by one");
    }
    if (const std::string text = problem_with_another_output(name); !text.empty()) {
      return make_error(Code::invalid_argument, text);
    }
  }
  return places;
}

Result<void> write_curves(const std::string& path, const CapturedFace& face) {
  Result<dam::Signal> signal = dam::to_signal(face.clip);
  if (!signal) return signal.error();
  mark_made(*signal, face.made);
  if (auto written = write_file(path, exchange::write_curves(*signal)); !written) return written;
  const std::string rate = fap::format_rate(signal->rate);
  report_output(path,
                std::to_string(signal->frames()) + " frames, " +
                    std::to_string(signal->names.size()) + " curves, " + rate +
                    " frames per second",
                {{"frames", signal->frames()}, {"curves", signal->names.size()}, {"rate", rate}});
  return {};
}

Result<void> write_clip(const std::string& path, const CapturedFace& captured, bool exact) {
  if (extension_of(path) == ".csv") return write_curves(path, captured);
  const fap::Sequence& clip = captured.clip;
  FaceText face = face_text(clip);
  face.coded = exact;  // it was never coded: exact
  OutputFile file(path);
  const Result<std::int64_t> frames = write_face_text(file, name_of_output(path), face);
  if (!frames) return frames.error();
  if (auto written = file.publish(); !written) return written.error();
  const std::int64_t skipped = clip.frames.back().number + 1 - std::int64_t(clip.frames.size());
  const std::size_t faps = clip.frames.front().mask.count();
  const std::string rate = fap::format_rate(clip.rate);
  report_output(path,
                std::to_string(*frames) + " frames, " + std::to_string(faps) + " FAPs, " + rate +
                    " frames per second" +
                    (skipped == 0 ? ""
                                  : ", " + std::to_string(skipped) +
                                        (exact ? " frames skipped" : " of them held")),
                {{"frames", *frames}, {"faps", faps}, {"rate", rate}, {"skipped", skipped}});
  return {};
}

Result<std::vector<Capture>> read_captures(const ImportOptions& options,
                                           const CaptureSettings& settings) {
  std::vector<Capture> captures;
  ProgressLine line("tracking");
  std::optional<Interrupt> interrupt;  // Ctrl-C ends a table that is typed, as usual
  if (settings.tracker) interrupt.emplace();
  CaptureSettings watched = settings;
  watched.tracking.at = [&](double share) { line.update(share); };
  watched.tracking.stop = [] { return Interrupt::requested(); };
  for (const std::string& input : options.inputs) {
    Result<Capture> capture = read_capture(input, watched, terminal_log());
    line.clear();
    if (!capture) return std::move(capture).error();
    captures.push_back(std::move(*capture));
  }
  return captures;
}

Result<int> run(const ImportOptions& options) {
  if (const std::string wrong = wrong_output(options.output); !wrong.empty()) {
    return usage_error(wrong);
  }
  const Result<CaptureSettings> settings = capture_settings(options.capture);
  if (!settings) return usage_error(settings.error().describe());
  const Result<Places> places = find_places(options);
  if (!places) {
    if (places.error().code == Code::invalid_argument) return usage_error(places.error().message);
    return places.error();
  }
  Result<std::vector<Capture>> captures = read_captures(options, *settings);
  if (!captures) {
    if (Interrupt::requested()) return kInterrupted;
    return captures.error();
  }
  bool points = false;
  for (const Capture& capture : *captures) {
    points = points || capture.points;
    if (capture.points || !options.capture.for_landmarks) continue;
    return usage_error(capture.path +
                       " has blend shapes or FAPs: --layout, --neutral and the like are for "
                       "landmarks");
  }
  if (!options.save_face.empty() && !points) {
    return usage_error("--save-face: there is no neutral face in blend shapes and FAPs");
  }
  const auto rest = neutral_face(options.neutral, *captures, *settings, terminal_log());
  if (!rest) return rest.error();
  std::optional<fap::RestingFace> saved = *rest;
  for (Capture& capture : *captures) {
    const std::string input = capture.path;
    Result<CapturedFace> face = face_of_capture(std::move(capture), *settings, *rest);
    if (!face) return face.error();
    for (const std::string& warning : face->warnings) warn(input + ": " + warning);
    if (face->points) {
      say(input + ": " + talk_of(*face->points, !settings->landmarks.neutral.empty()));
      if (!saved) saved = face->points->face.rest;
    }
    if (input != "-") face->clip.name = stem_of(input);
    if (auto done = write_clip(places->of(input, options.output), *face, options.exact); !done) {
      return done.error();
    }
  }
  if (!options.save_face.empty()) {
    if (auto done = write_file(options.save_face, exchange::write_face_file(*saved)); !done) {
      return done.error();
    }
    report_output(options.save_face, "the neutral face");
  }
  return kOk;
}

void add_options(OptionTable& cli, ImportOptions& options) {
  cli.add("input", options.inputs,
          "Table (CSV) of ARKit blend shapes: from Live Link Face, or time_s and a column "
          "per shape; or of landmarks: from OpenFace, 68 points (x_0, y_0 or landmark_0_x "
          "...), 468 or 478 points of MediaPipe, a part of them, or feature points (8.1_x, "
          "8.1_y ...), with a row per frame or per point; action units of OpenFace; JSON of "
          "landmarks or shapes (MediaPipe, Audio2Face, Azure, export's own ...); or a video, "
          "with --tracker. Several inputs share a neutral face; - for standard input")
      ->required();
  cli.add("-o,--output", options.output,
          "FAP text (.fap) or table of curves (.csv) to write, - for standard output; a "
          "folder for several inputs; in the folder of a corpus fap/NAME.csv")
      ->output(".fap .txt .csv", OutputKind::file_or_folder)
      ->required();
  add_capture_options(cli, options.capture);
  add_neutral_options(cli, options.neutral);
  cli.add("--save-face", options.save_face, "Write the neutral face to this file, for --face-file")
      ->output(".face .json")
      ->in_group(kLandmarkGroup);
  add_exact_option(cli, options.exact);
}

}  // namespace

const Command kImport{"import", "Convert a captured face (ARKit curves, landmarks) to FAPs",
                      "  animeme import take.csv -o take.fap\n"
                      "  animeme import take.csv --rate 29.97 -o take.fap\n"
                      "  animeme import take.csv -o - | animeme encode - -o take.fba\n"
                      "  animeme import openface.csv -o take.fap\n"
                      "  animeme import openface.csv --flat --neutral 0.5-1.2s -o take.fap\n"
                      "  animeme import mediapipe.csv --size 1280x720 --mirrored -o take.fap\n"
                      "  animeme import take.csv --column jaw=jawOpen*0.01 -o take.fap\n"
                      "  animeme import clip.mp4 --tracker \"track {in} {out}\" -o clip.fap\n"
                      "  animeme import a.csv b.csv c.csv --save-face me.face -o takes/\n"
                      "  animeme import later.csv --face-file me.face -o later.fap",
                      set_up<ImportOptions>};

}  // namespace animeme::tools

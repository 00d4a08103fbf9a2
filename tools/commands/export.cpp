// Motion for other programs: what they know are ARKit's shapes, not FAPs.
#include <memory>

#include "fap/fill.h"
#include "fap/head/model.h"
#include "fap/rate_text.h"
#include "tools/commands/arkit_export.h"
#include "tools/commands/common.h"
#include "tools/commands/export_glb.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string input;
  std::string output;
  std::string audio;
  GlbExport glb;
};

ArkitCurves to_arkit(const fap::Sequence& clip) {
  ArkitCurves curves{clip.rate, {}};
  fap::ArkitFitter fitter;
  ProgressLine progress("fitting");
  for (const fap::Frame& frame : clip.frames) {
    curves.frames.push_back(fitter.fit(frame));
    progress.update(double(curves.frames.size()) / double(clip.frames.size()));
  }
  return curves;
}

Result<int> run(const Options& options) {
  const std::string extension = extension_of(options.output);
  if (extension != ".csv" && extension != ".json" && extension != ".glb") {
    return usage_error("--output must end in .csv (Live Link Face), .json or .glb, not " +
                       options.output);
  }
  Result<FaceInput> input = read_face(options.input);
  if (!input) return input.error();
  Result<fap::Sequence> filled = fap::fill(input->clip, {.interpolate = true, .complete = true});
  if (!filled) return filled.error().in_file(options.input);
  const std::string sound = std::filesystem::path(options.audio).filename().string();
  if (extension == ".glb") {
    GlbExport settings = options.glb;
    settings.audio = sound;
    if (auto written = export_glb(options.output, *filled, settings); !written) {
      return written.error();
    }
    return kOk;
  }
  const ArkitCurves curves = to_arkit(*filled);
  const std::string text = extension == ".csv" ? live_link_csv(curves) : arkit_json(curves, sound);
  if (auto written = write_file(options.output, text); !written) return written.error();
  say(options.output + ": " + std::to_string(curves.frames.size()) + " frames of 52 shapes, " +
      fap::format_rate(curves.rate) + " frames a second");
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("input", options->input, "FAP text, FBA stream or container")->required();
  app.add_option("-o,--output", options->output,
                 "File to write: .csv (Live Link Face: Unreal, Blender, Maya), .json (the same "
                 "curves for scripts), .glb (a head with morph targets and animation)")
      ->required();
  app.add_option("--audio", options->audio, "Name of the sound to mention in .json and .glb");
  app.add_option("--head", options->glb.head, "glb: woman, man or child")
      ->check(
          CLI::IsMember(std::vector<std::string>(head::kHeadNames.begin(), head::kHeadNames.end())))
      ->capture_default_str();
  app.add_option("--morphs", options->glb.morphs,
                 "glb: morph targets by the names of ARKit (jawOpen ...) or of FAPs (open_jaw ...)")
      ->check(CLI::IsMember({"arkit", "fap"}))
      ->capture_default_str();
  app.add_flag("--normals", options->glb.normals,
               "glb: normals of the morph targets, for players that do not compute them");
  return [options] { return run(*options); };
}

}  // namespace

const Command kExport{"export", "Turn a face into curves for Unreal, Blender, Unity or scripts",
                      "  animeme export talk.mp4 -o talk.csv\n"
                      "  animeme export talk.fap --audio voice.wav -o talk.json\n"
                      "  animeme export talk.fba --head man -o talk.glb",
                      add};

}  // namespace animeme::tools

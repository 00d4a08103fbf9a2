#include "tools/app/commands/export_options.h"

#include <CLI/CLI.hpp>

#include "tools/app/commands/bounds.h"
#include "tools/app/commands/head_options.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/script_options.h"

namespace animeme::tools {

void add_options(CLI::App& app, ExportOptions& options) {
  app.add_option("input", options.input,
                 "FAP text, FBA stream or container; for visemes also a phoneme script or a "
                 "recorded voice")
      ->required();
  app.add_option("more", options.more,
                 "Further clips, for a head of your own: each becomes an animation");
  add_output(
      app.add_option(
          "-o,--output", options.output,
          "File to write: .csv (Live Link Face: Unreal, Blender, Maya), .json (the same "
          "curves for scripts), .glb (a head with morph targets and animation; your own "
          "file with the animation added, also .vrm and .gltf), .vrma (motion for your VRM 1.0 "
          "avatar), "
          ".visemes.json or .visemes.csv (15 weights a frame under "
          "the names of Oculus and Ready Player Me), .talkinghead.json, .tsv, .xml, .rhubarb.json "
          "or .dat "
          "(mouth shapes of Rhubarb Lip Sync)"),
      {}, OutputKind::file_or_dash);
  app.add_option("-f,--format,--exportFormat", options.format,
                 "Mouth shapes in a format of Rhubarb; without -o to standard output")
      ->check(CLI::IsMember({"tsv", "xml", "json", "dat"}));
  app.add_option("-d,--dialog-file,--dialogFile", options.dialog_file,
                 "What is said in a recorded voice, as text; else its sounds are recognised");
  app.add_option("--extended-shapes,--extendedShapes", options.rhubarb.extended,
                 "Which of Rhubarb's shapes G, H and X there are")
      ->option_text("SHAPES=GHX")
      ->check([](const std::string& text) {
        return text.find_first_not_of("GHX") == std::string::npos ? "" : "only G, H and X";
      });
  app.add_option("--dat-rate,--datFrameRate", options.rhubarb.dat_rate, "Frames a second of .dat")
      ->option_text("RATE=24")
      ->check(between(1.0, 1000.0));
  app.add_flag("--preston-blair,--datUsePrestonBlair", options.rhubarb.preston_blair,
               "Name mouths in .dat MBP, etc, E, AI, O, U, FV, L, rest");
  app.add_option("--what", options.what,
                 "What to write, whatever the file is called: arkit (52 shapes and 9 angles), "
                 "visemes, rhubarb, talkinghead (TalkingHead's speakAudio), head (.glb)")
      ->check(CLI::IsMember({"arkit", "visemes", "rhubarb", "talkinghead", "head"}));
  app.add_option(
      "--audio", options.audio,
      "Name of the sound to mention in .json, .xml and .glb; for Rhubarb and TalkingHead the "
      "input, if it has sound");
  app.add_option("--script", options.script,
                 "Phoneme script of the face: the events of visemes are its sounds; default: that "
                 "which a container carries; else what the face shows most");
  add_script_options(app, options.reading.reading, options.reading.language);
  app.add_option("--rate", options.rate, "Frames a second of visemes of a script")
      ->type_name("RATE")
      ->check(frame_rate())
      ->capture_default_str();
  app.add_option("--crossfade", options.crossfade,
                 "Seconds that one viseme of a script takes to fade into the next, at most")
      ->capture_default_str()
      ->check(between(0.0, 1.0));
  add_length_option(app, options.length);
  add_head_options(app, options.head);
  app.add_option("--morphs", options.morphs,
                 "glb: morph targets by the names of ARKit (jawOpen ...) or of FAPs (open_jaw ...)")
      ->check(CLI::IsMember({"arkit", "fap"}))
      ->capture_default_str();
  app.add_flag("--normals", options.normals,
               "glb: normals of the morph targets, for players that do not compute them");
  for (const char* name : {"--rate", "--crossfade"}) {
    options.of_scripts.push_back(app.get_option(name));
  }
  app.add_option("--sound", options.sounds,
                 "Sound to put into your own .glb or .vrm, one a clip: any sound file, or the clip "
                 "itself (talk.mp4); see the README of tools/view/gltf for who plays it");
  for (const char* name : {"--head", "--points", "--morphs", "--normals", "--sound"}) {
    options.of_heads.push_back(app.get_option(name));
  }
}

}  // namespace animeme::tools

#include "tools/app/commands/export_options.h"

#include "tools/app/commands/head_options.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/said_visemes.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/track_option.h"

namespace animeme::tools {

void add_options(OptionTable& cli, ExportOptions& options) {
  cli.add("input", options.input,
          "FAP text, FBA stream or container; for visemes also a phoneme script or a "
          "recorded voice")
      ->required();
  cli.add("more", options.more, "Further clips, for your own head: each becomes an animation");
  cli.add("-o,--output", options.output,
          "File to write: .csv (Live Link Face: Unreal, Blender, Maya), .json (the same "
          "curves for scripts), .glb (a head with morph targets and animation, or your own "
          "file with the animation added; also .vrm and .gltf), .vrma (motion for a VRM 1.0 "
          "avatar), .visemes.json or .visemes.csv (15 weights per frame with the names of "
          "Oculus and Ready Player Me), .talkinghead.json, .tsv, .xml, .rhubarb.json or .dat "
          "(mouth shapes of Rhubarb Lip Sync)")
      ->output("", OutputKind::file_or_dash);
  cli.add("-f,--format,--exportFormat", options.format,
          "Mouth shapes in a format of Rhubarb; without -o on standard output")
      ->one_of("tsv xml json dat");
  cli.add("-d,--dialog-file,--dialogFile", options.dialog_file,
          "Text that is spoken in a recorded voice; without it, phones are recognised");
  cli.add("--extended-shapes,--extendedShapes", options.rhubarb.extended,
          "Which of Rhubarb's shapes G, H and X are used")
      ->value("SHAPES=GHX")
      ->check([](const std::string& text) -> std::string {
        return text.find_first_not_of("GHX") == std::string::npos ? "" : "only G, H and X";
      });
  cli.add("--dat-rate,--datFrameRate", options.rhubarb.dat_rate, "Frames per second of .dat")
      ->value("RATE=24")
      ->between(1.0, 1000.0);
  cli.add("--preston-blair,--datUsePrestonBlair", options.rhubarb.preston_blair,
          "Use the mouth names MBP, etc, E, AI, O, U, FV, L, rest in .dat");
  cli.add("--what", options.what,
          "What to write, whatever the name of the file: arkit (52 shapes and 9 angles), "
          "visemes, rhubarb, talkinghead (TalkingHead's speakAudio), head (.glb)")
      ->one_of("arkit visemes rhubarb talkinghead head");
  cli.add("--audio", options.audio,
          "Name of the sound to mention in .json, .xml and .glb; default for Rhubarb and "
          "TalkingHead: the input, if it has sound");
  cli.add("--script", options.script,
          "Phoneme script for the times of visemes, and for --mouth; default: that in the "
          "container, else the visemes that the face shows most");
  add_mouth_option(cli, options.mouth);
  add_script_options(cli, options.reading.reading, options.reading.language);
  cli.add("--rate", options.rate, "Frames per second of the visemes of a script")
      ->frame_rate()
      ->show_default();
  cli.add("--crossfade", options.crossfade,
          "Longest crossfade between two visemes of a script, in seconds")
      ->show_default()
      ->between(0.0, 1.0);
  add_length_option(cli, options.length);
  add_head_options(cli, options.head);
  cli.add("--morphs", options.morphs,
          "glb: names of the morph targets: ARKit (jawOpen ...) or FAPs (open_jaw ...)")
      ->one_of("arkit fap")
      ->show_default();
  cli.add("--normals", options.normals,
          "glb: add normals of the morph targets, for players that do not compute them");
  for (const char* name : {"--rate", "--crossfade"}) {
    options.of_scripts.push_back(cli.get(name));
  }
  cli.add("--sound", options.sounds,
          "Sound to embed in your own .glb or .vrm, one per clip: any sound file, or the "
          "clip itself (talk.mp4); see the README of tools/view/gltf for players that "
          "support it");
  for (const char* name : {"--head", "--points", "--shape-name", "--shape-names", "--morphs",
                           "--normals", "--sound", "--mouth"}) {
    options.of_heads.push_back(cli.get(name));
  }
  add_track_option(cli, options.track);
}

}  // namespace animeme::tools

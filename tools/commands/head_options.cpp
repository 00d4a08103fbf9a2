#include "tools/commands/head_options.h"

#include <CLI/CLI.hpp>

namespace animeme::tools {

const char* const kHeadHelp =
    "woman, man or child, or a head of your own: .glb, .gltf or .vrm with shapes (ARKit's or "
    "visemes), .obj with --points, .fdp of Xface, .xmt with an FDP";
const char* const kPointsHelp =
    "Which vertex of your .obj or .glb is which feature point: lines such as 2.1,966 (animeme head "
    "--help)";

const char* const kGainHelp =
    "How much wider lips open than the clip says, 0.25..4; auto: so that a spoken AA opens 70 % of "
    "what the head's jaw can";

void add_head_options(CLI::App& app, studio::HeadChoice& choice) {
  app.add_option("--head", choice.head, kHeadHelp)->capture_default_str();
  app.add_option("--points", choice.points, kPointsHelp);
  app.add_option("--gain", choice.gain, kGainHelp)->capture_default_str();
}

}  // namespace animeme::tools

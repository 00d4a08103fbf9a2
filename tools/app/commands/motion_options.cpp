#include "tools/app/commands/motion_options.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {
namespace {

std::string read_symmetric(const std::string& text, bool& symmetric) {
  symmetric = text == "on";
  return symmetric || text == "off" ? "" : "must be on or off";
}

}  // namespace

void add_motion_options(OptionTable& cli, dam::SynthesisOptions& options) {
  options.articulation = std::nullopt;
  options.symmetric_rest = true;
  cli.add("--style", options.style,
          "Intensity of the motion: 0 keeps the mouth at rest, 1 is as learned, 1.5 "
          "exaggerates")
      ->value("0..1.5=1")
      ->between(0.0, dam::kMostStyle);
  cli.add("--sharpness", options.sharpness,
          "Speed of the movements: 0 has the least error, 1 is as quick as people are")
      ->value("0..3=1")
      ->between(0.0, dam::kMostSharpness);
  cli.add("--articulate", options.articulation,
          "Clearer vowels than learned: lips forward in o, u, w, the jaw lower in a, higher in i "
          "and s; 0 as learned; default: 1 for the built-in model, 0 for others")
      ->value("0..2")
      ->between(0.0, dam::kMostArticulation);
  cli.add("--symmetric", parsed<read_symmetric>(options.symmetric_rest),
          "The resting mouth is the same on both sides; off: as learned, with the smirk of the "
          "model's speaker")
      ->one_of("on off")
      ->value("on|off=on");
}

void add_tongue_option(OptionTable& cli, bool& tongue) {
  cli.add(
      "!--no-tongue", tongue,
      "Leave the tongue at rest, as --quant 0 does; else a rule moves it for models without it");
}

}  // namespace animeme::tools

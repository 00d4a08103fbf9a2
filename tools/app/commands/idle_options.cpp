#include "tools/app/commands/idle_options.h"

#include <string>

#include "tools/app/commands/options.h"

namespace animeme::tools {

namespace {

std::string take_still(const std::string& text, void* into) {
  if (text.empty()) return "name parts: gaze, head, brows, blinks";
  const auto still = dam::parse_still(text);
  if (!still) return still.error().message;
  *static_cast<dam::StillParts*>(into) = *still;
  return {};
}

std::string take_look(const std::string& text, void* into) {
  const auto look = dam::parse_look(text);
  if (!look) return look.error().message;
  *static_cast<dam::Look*>(into) = *look;
  return {};
}

}  // namespace

void add_idle_options(OptionTable& cli, IdleOptions& options, const char* note) {
  const std::string help =
      "Gaze, blinks, brows and a head that moves with the speech; " + std::string(note);
  cli.add("--idle-motion,.--life,!--no-idle-motion,!.--no-life", options.on, help.c_str());
  cli.add("--liveliness", options.motion.liveliness,
          "Amount of idle motion; 0: none (brows rise at question marks), 2: twice as much of head "
          "and brows")
      ->value("0..2=1")
      ->between(0.0, dam::kMostLiveliness);
  cli.add("--still", {take_still, &options.motion.still},
          "Parts without idle motion: gaze,head,brows,blinks")
      ->value("PARTS");
  cli.add("--look", {take_look, &options.motion.look},
          "Where the eyes look: camera, away, YAW,PITCH (degrees to its left, up) or X,Y,Z (metres "
          "from between the eyes)")
      ->value("TARGET=camera");
  cli.add("--seed", options.motion.seed,
          "Random seed of idle motion: another one blinks, looks and nods at other times")
      ->value("NUMBER=1")
      ->between(0, 1e9);
}

}  // namespace animeme::tools

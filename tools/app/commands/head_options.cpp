#include "tools/app/commands/head_options.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {

const char* const kHeadHelp =
    "woman, man, child, amara, mei, rosa, omar, kenji or george, with words such as "
    "woman:skin=5:hair=black-bob:age=60:glasses, or your own head: .glb, .gltf or .vrm with ARKit "
    "blend shapes or visemes, .obj with --points, a folder with neutral.obj and an .obj for each "
    "shape, .fdp (Xface), .xmt with an FDP";
const char* const kPointsHelp =
    "Table of feature points of your .obj or .glb: lines such as 2.1,966 (see animeme head --help)";

namespace {

const char* const kGainHelp =
    "Gain of the lip opening, 0.25..4; auto: a spoken AA opens the lips by 70 % of what the jaw of "
    "the head can";

std::string problem_of_gain(const std::string& text) {
  const bool known = text == "auto" || studio::gain_of(text);
  return known ? "" : "auto or a number from 0.25 to 4 is wanted, not \"" + text + "\"";
}

}  // namespace

Option* add_gain_option(OptionTable& cli, studio::HeadChoice& choice) {
  return cli.add("--gain", choice.gain, kGainHelp)->type("0.25..4|auto")->check(problem_of_gain);
}

void add_shape_options(OptionTable& cli, studio::HeadChoice& choice) {
  cli.add("--shape-name", choice.shape_names,
          "Meaning of a morph target with another name: NAME=jawOpen (a shape of ARKit), "
          "NAME=viseme_PP (a viseme); NAME=- leaves it at rest. May be repeated")
      ->one_at_a_time();
  cli.add("--shape-names", choice.shape_table, "The same as a table: shape,meaning")->value("FILE");
}

namespace {

void add_shared_options(OptionTable& cli, studio::HeadChoice& choice) {
  cli.add("--points", choice.points, kPointsHelp);
  add_shape_options(cli, choice);
  add_gain_option(cli, choice)->show_default();
}

}  // namespace

void add_head_options(OptionTable& cli, studio::HeadChoice& choice) {
  cli.add("--head", choice.head, kHeadHelp)->show_default();
  add_shared_options(cli, choice);
}

void add_heads_options(OptionTable& cli, std::vector<std::string>& heads,
                       studio::HeadChoice& choice) {
  cli.add("--head", heads, kHeadHelp)->one_at_a_time()->help +=
      ". Several (woman,man,me.glb, or repeat the option): the page offers a choice; a built-in "
      "head takes 0.6 to 0.8 MB. Default: woman";
  add_shared_options(cli, choice);
}

}  // namespace animeme::tools

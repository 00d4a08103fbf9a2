#include "tools/app/commands/head_options.h"
#include "tools/app/commands/bounds.h"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace animeme::tools {

const char* const kHeadHelp =
    "woman, man or child, or a head of your own: .glb, .gltf or .vrm with shapes (ARKit's or "
    "visemes), .obj with --points, .fdp of Xface, .xmt with an FDP";
const char* const kPointsHelp =
    "Which vertex of your .obj or .glb is which feature point: lines such as 2.1,966 (animeme head "
    "--help)";

namespace {

const char* const kGainHelp =
    "How much wider lips open than the clip says, 0.25..4; auto: so that a spoken AA opens 70 % of "
    "what the head's jaw can";

std::string problem_of_gain(const std::string& text) {
  const bool known = text == "auto" || studio::gain_of(text);
  return known ? "" : "auto or a number from 0.25 to 4 is wanted, not \"" + text + "\"";
}

}  // namespace

CLI::Option* add_gain_option(CLI::App& app, studio::HeadChoice& choice) {
  return app.add_option("--gain", choice.gain, kGainHelp)
      ->type_name("0.25..4|auto")
      ->check(written_so(problem_of_gain));
}

namespace {

void add_shared_options(CLI::App& app, studio::HeadChoice& choice) {
  app.add_option("--points", choice.points, kPointsHelp);
  add_gain_option(app, choice)->capture_default_str();
}

void add_heads(const std::string& value, std::vector<std::string>& heads) {
  std::error_code none;
  if (std::filesystem::exists(value, none)) {
    heads.push_back(value);
    return;
  }
  std::size_t from = 0;
  for (std::size_t comma; (comma = value.find(',', from)) != std::string::npos; from = comma + 1) {
    heads.push_back(value.substr(from, comma - from));
  }
  heads.push_back(value.substr(from));
}

}  // namespace

void add_head_options(CLI::App& app, studio::HeadChoice& choice) {
  app.add_option("--head", choice.head, kHeadHelp)->capture_default_str();
  add_shared_options(app, choice);
}

void add_heads_options(CLI::App& app, std::vector<std::string>& heads, studio::HeadChoice& choice) {
  const auto take = [&heads](const std::vector<std::string>& values) {
    for (const std::string& value : values) add_heads(value, heads);
  };
  app.add_option_function<std::vector<std::string>>(
         "--head", take,
         std::string(kHeadHelp) +
             ". Several (woman,man,me.glb, or the option again): the page lets people choose; one "
             "of ours is 0.6 to 0.8 MB of the page. Default: woman")
      ->allow_extra_args(false);
  add_shared_options(app, choice);
}

}  // namespace animeme::tools

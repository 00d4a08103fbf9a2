#include "tools/app/commands/did_you_mean.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

namespace animeme::tools {
namespace {

constexpr std::size_t kLongest = 64;  // of what is looked at

// Fewest single steps from one word to the other, a swap of neighbours being one.
std::size_t steps_between(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> steps(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        steps[i][j] = i + j;
        continue;
      }
      steps[i][j] = std::min({steps[i - 1][j] + 1, steps[i][j - 1] + 1,
                              steps[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        steps[i][j] = std::min(steps[i][j], steps[i - 2][j - 2] + 1);
      }
    }
  }
  return steps[a.size()][b.size()];
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

void add_option_names(const CLI::App& app, std::vector<std::string>& names) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
}

std::string question(const std::string& nearest) {
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace

std::string nearest_name(const std::string& typed, const std::vector<std::string>& names) {
  if (typed.size() > kLongest) return {};
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(1, typed.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t steps = steps_between(typed, name);
    if (steps >= fewest) continue;
    fewest = steps;
    nearest = name;
  }
  return nearest;
}

std::string did_you_mean(const CLI::App& program, std::span<const char* const> arguments) {
  const auto word = std::find_if(arguments.begin(), arguments.end(),
                                 [](const char* text) { return text[0] != '-'; });
  if (word == arguments.end()) return {};
  const std::vector<std::string> commands = command_names(program);
  const std::string name = *word;
  if (std::find(commands.begin(), commands.end(), name) == commands.end()) {
    return "there is no command \"" + name + "\"" + question(nearest_name(name, commands));
  }
  const CLI::App* const command = program.get_subcommand(name);
  std::vector<std::string> options;
  add_option_names(*command, options);
  add_option_names(program, options);
  for (const char* argument : arguments) {
    const std::string_view text = argument;
    if (text == "--") break;
    if (!text.starts_with("--")) continue;
    const std::string option(text.substr(0, text.find('=')));
    if (std::find(options.begin(), options.end(), option) != options.end()) continue;
    return name + " has no option " + option + question(nearest_name(option, options));
  }
  return {};
}

}  // namespace animeme::tools

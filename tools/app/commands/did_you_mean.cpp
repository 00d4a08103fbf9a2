#include "tools/app/commands/did_you_mean.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace animeme::tools {
namespace {

constexpr std::size_t kLongest = 64;  // of what is looked at

// What other programs call an option, FFmpeg, Praat and 3D packages among them, and what it is
// called here.
constexpr std::array<std::pair<std::string_view, std::string_view>, 24> kElsewhere = {{
    {"--fps", "--rate"},        {"--framerate", "--rate"},  {"--frame-rate", "--rate"},
    {"--bitrate", "--kbps"},    {"--bit-rate", "--kbps"},   {"--language", "--lang"},
    {"--locale", "--lang"},     {"--voice", "--lang"},      {"--emotion", "--mood"},
    {"--expression", "--mood"}, {"--gaze", "--look"},       {"--look-at", "--look"},
    {"--start", "--from"},      {"--begin", "--from"},      {"--ss", "--from"},
    {"--end", "--to"},          {"--resolution", "--size"}, {"--width", "--size"},
    {"--height", "--size"},     {"--avatar", "--head"},     {"--character", "--head"},
    {"--bg", "--background"},   {"--camera", "--view"},     {"--intensity", "--style"},
}};

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

std::vector<std::string> command_names(const OptionTable& program) {
  std::vector<std::string> names;
  for (const OptionTable& command : program.commands) names.push_back(command.name);
  return names;
}

void add_option_names(const OptionTable& table, std::vector<std::string>& names) {
  for (const std::unique_ptr<Option>& option : table.options) {
    for (const Option::Name& name : option->names) {
      if (name.text.starts_with("--")) names.push_back(name.text);
    }
  }
}

// The option that another program calls `typed`, else the one that is spelt most alike.
std::string meant_by(const std::string& typed, const std::vector<std::string>& options) {
  for (const auto& [elsewhere, here] : kElsewhere) {
    if (typed != elsewhere) continue;
    const auto found = std::find(options.begin(), options.end(), here);
    if (found != options.end()) return *found;
  }
  return nearest_name(typed, options);
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

std::string did_you_mean(const OptionTable& program, std::span<const char* const> words) {
  const auto word =
      std::find_if(words.begin(), words.end(), [](const char* text) { return text[0] != '-'; });
  const OptionTable* table = &program;
  std::vector<std::string> options;
  if (word != words.end()) {
    const std::vector<std::string> commands = command_names(program);
    const auto command = std::find(commands.begin(), commands.end(), *word);
    if (command == commands.end()) {
      return "there is no command \"" + std::string(*word) + "\"" +
             question(nearest_name(*word, commands));
    }
    table = &program.commands[std::size_t(command - commands.begin())];
    add_option_names(*table, options);
  }
  add_option_names(program, options);
  for (const char* one : words) {
    const std::string_view text = one;
    if (text == "--") break;
    if (!text.starts_with("--")) continue;
    const std::string option(text.substr(0, text.find('=')));
    if (std::find(options.begin(), options.end(), option) != options.end()) continue;
    return table->name + " has no option " + option + question(meant_by(option, options));
  }
  return {};
}

}  // namespace animeme::tools

#include "tools/app/commands/settings_file.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <string_view>

#include "tools/app/commands/did_you_mean.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {
namespace {

constexpr std::string_view kOption = "--settings";

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

// The path behind --settings; empty: it is not there.
std::string path_in(std::span<const char* const> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == kOption && i + 1 < words.size()) return words[i + 1];
    if (word.starts_with(std::string(kOption) + "=")) {
      return std::string(word.substr(kOption.size() + 1));
    }
  }
  return {};
}

bool on_command_line(const Option& option, std::span<const char* const> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return std::any_of(option.names.begin(), option.names.end(), [&](const Option::Name& name) {
      return word == name.text || word.starts_with(name.text + "=");
    });
  });
}

const Option* find_setting(const OptionTable& command, const std::string& name) {
  for (const std::unique_ptr<Option>& option : command.options) {
    if (option->argument == name && !name.empty()) return option.get();
  }
  const Option* const found = command.find("--" + name);
  return found != nullptr && found->variable.kind != Variable::Kind::none ? found : nullptr;
}

std::string unknown(const OptionTable& command, const std::string& name) {
  std::vector<std::string> names;
  for (const std::unique_ptr<Option>& option : command.options) {
    if (!option->argument.empty()) names.push_back(option->argument);
    for (const Option::Name& one : option->names) {
      if (one.text.starts_with("--") && one.text != kOption) names.push_back(one.text.substr(2));
    }
  }
  const std::string nearest = nearest_name(name, names);
  return "there is no setting '" + name.substr(0, 60) + "'" +
         (nearest.empty() ? "; names are those of the options of animeme " + command.name
                          : "; did you mean " + nearest + "?");
}

// A line as words; an error without its place.
Result<std::vector<std::string>> words_of(const OptionTable& command, const std::string& line,
                                          std::span<const char* const> words,
                                          std::set<std::string>& seen) {
  const auto bad = [](const std::string& what) { return make_error(Code::invalid_argument, what); };
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) return bad("write it as name = value");
  const std::string name = trimmed(line.substr(0, equals)),
                    value = trimmed(line.substr(equals + 1));
  const Option* const option = find_setting(command, name);
  if (option == nullptr || option->name() == kOption) return bad(unknown(command, name));
  if (!seen.insert(name).second && !option->variable.is_list()) {
    return bad("'" + name + "' is there twice");
  }
  if (on_command_line(*option, words)) return std::vector<std::string>();
  if (option->argument == name) return std::vector<std::string>{value};
  if (!option->variable.is_flag()) return std::vector<std::string>{"--" + name + "=" + value};
  if (value == "false") return std::vector<std::string>();
  if (value == "true") return std::vector<std::string>{"--" + name};
  return bad("'" + name + "' is true or false");
}

}  // namespace

Result<std::vector<std::string>> settings_words(const OptionTable& command,
                                                std::span<const char* const> words) {
  std::vector<std::string> all;
  const std::string path = command.find(std::string(kOption)) != nullptr ? path_in(words) : "";
  if (path.empty()) return all;
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  std::istringstream lines(std::string(bytes->begin(), bytes->end()));
  std::set<std::string> seen;
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    auto more = words_of(command, line, words, seen);
    if (!more) {
      return make_error(more.error().code,
                        "line " + std::to_string(number) + ": " + more.error().message)
          .in_file(path);
    }
    all.insert(all.end(), more->begin(), more->end());
  }
  return all;
}

}  // namespace animeme::tools

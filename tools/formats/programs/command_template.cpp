#include "tools/formats/programs/command_template.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace animeme::tools {
namespace {

Error bad(std::string message) { return make_error(Code::invalid_argument, std::move(message)); }

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool can_run(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

bool is_found(const std::string& program) {
  if (program.find('/') != std::string::npos) return can_run(program);
  const char* set = std::getenv("PATH");
  std::string_view path = set != nullptr ? set : "/usr/bin:/bin";
  while (true) {
    const std::size_t end = std::min(path.find(':'), path.size());
    const std::string folder(path.substr(0, end));
    if (can_run(std::filesystem::path(folder.empty() ? "." : folder) / program)) return true;
    if (end == path.size()) return false;
    path.remove_prefix(end + 1);
  }
}

Error would_be_option(const std::string& program, const std::string& argument,
                      const std::string& filled) {
  constexpr std::size_t kShown = 30;
  const std::string shown = filled.size() > kShown ? filled.substr(0, kShown) + "..." : filled;
  return bad("\"" + shown + "\" begins with - and would be an option of " + program +
             ": in the command, write -- before " + argument + " or join it to an option (--text=" +
             argument + "), or read it from a file or from standard input");
}

}  // namespace

Result<std::vector<std::string>> split_arguments(std::string_view line) {
  std::vector<std::string> out;
  bool open = false;  // an argument has begun, empty or not
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote == 0 && is_blank(c)) {
      open = false;
      continue;
    }
    if (!open) out.emplace_back();
    open = true;
    const bool escapes = c == '\\' && quote != '\'' && i + 1 < line.size() &&
                         (quote == 0 || line[i + 1] == '"' || line[i + 1] == '\\');
    if (escapes) {
      out.back() += line[++i];
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (quote != 0 && c == quote) {
      quote = 0;
    } else {
      out.back() += c;
    }
  }
  if (quote != 0) return bad(std::string("the command has a ") + quote + " that is not closed");
  return out;
}

Result<CommandTemplate> parse_command(std::string_view line) {
  Result<std::vector<std::string>> arguments = split_arguments(line);
  if (!arguments) return arguments.error();
  if (arguments->empty() || arguments->front().empty()) return bad("the command names no program");
  CommandTemplate command;
  command.arguments = std::move(*arguments);
  const std::string& program = command.arguments.front();
  if (!is_found(program)) return bad("cannot find an executable program " + program);
  return command;
}

bool CommandTemplate::names(std::string_view place) const {
  const std::string braced = "{" + std::string(place) + "}";
  return std::any_of(arguments.begin(), arguments.end(),
                     [&](const std::string& one) { return one.find(braced) != std::string::npos; });
}

std::string path_argument(std::string path) { return path.starts_with('-') ? "./" + path : path; }

Result<std::vector<std::string>> fill_in(const CommandTemplate& command,
                                         std::span<const Place> places) {
  std::vector<std::string> result;
  bool options_end = false;
  for (const std::string& argument : command.arguments) {
    options_end = options_end || argument == "--";
    std::string filled;
    for (std::size_t i = 0; i < argument.size();) {
      const auto here = [&](const Place& place) {
        const std::size_t end = i + place.name.size() + 1;
        return argument[i] == '{' && argument.compare(i + 1, place.name.size(), place.name) == 0 &&
               end < argument.size() && argument[end] == '}';
      };
      const auto place = std::find_if(places.begin(), places.end(), here);
      if (place == places.end()) {
        filled += argument[i++];
      } else {
        filled += place->text;
        i += place->name.size() + 2;
      }
    }
    // An option of the command's own begins with its own "-".
    if (filled.starts_with('-') && !argument.starts_with('-') && !options_end) {
      return would_be_option(command.arguments.front(), argument, filled);
    }
    result.push_back(std::move(filled));
  }
  return result;
}

}  // namespace animeme::tools

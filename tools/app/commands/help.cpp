#include "tools/app/commands/help.h"

#include <algorithm>
#include <string_view>

#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

constexpr std::size_t kColumn = 30;  // of what options do
constexpr std::size_t kIndent = 4;   // of what goes on below
constexpr const char* kArguments = "Arguments";

// Appends words to a text whose last line has `at` characters. Further lines begin at `indent`.
void wrap(std::string& out, std::size_t at, std::string_view text, std::size_t indent,
          std::size_t width) {
  bool first = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    const bool full = !first && at + 1 + end > width;
    if (full) out += "\n" + std::string(indent, ' ');
    if (!first && !full) out += ' ';
    at = (full ? indent : at + (first ? 0 : 1)) + end;
    out += text.substr(0, end);
    first = false;
    if (end < text.size() && text[end] == '\n') {
      out += "\n" + std::string(indent, ' ');
      at = indent;
      first = true;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  out += '\n';
}

void add_row(std::string& out, const std::string& left, const std::string& right,
             std::size_t width) {
  std::string line = "  ";
  // Long names and values have lines of their own.
  wrap(line, 2, left, 6, width);
  line.pop_back();
  const std::size_t last = line.size() - (line.rfind('\n') + 1);
  const bool below = last + 2 > kColumn || line.find('\n') != std::string::npos;
  line += below ? "\n" + std::string(kColumn, ' ') : std::string(kColumn - last, ' ');
  out += line;
  wrap(out, kColumn, right, kColumn, width);
}

// All that exclude each other name it, whichever of them declares it.
std::vector<std::string> exclusions(const OptionTable& table, const Option& option) {
  std::vector<std::string> names;
  for (const std::unique_ptr<Option>& other : table.options) {
    const auto has = [](const Option& one, const std::string& name) {
      return std::find(one.excluded.begin(), one.excluded.end(), name) != one.excluded.end();
    };
    if (has(option, other->name()) || has(*other, option.name())) names.push_back(other->name());
  }
  return names;
}

void add_options(std::string& out, const OptionTable& table, const std::string& title,
                 const std::vector<const Option*>& options, std::size_t width) {
  if (options.empty()) return;
  out += "\n" + title + ":\n";
  for (const Option* option : options) {
    const std::string names =
        title == kArguments ? option->argument : joined(option->shown_names(), ",");
    const std::string value = option->value_text();
    std::string beside;
    if (!option->needed.empty()) beside = "with " + joined(option->needed, ", ");
    if (const auto others = exclusions(table, *option); !others.empty()) {
      beside += (beside.empty() ? "not with " : "; not with ") + joined(others, ", ");
    }
    const std::string right = option->help + (beside.empty() ? "" : " (" + beside + ")");
    add_row(out, names + (value.empty() ? "" : " " + value), right, width);
  }
}

void add_usage(std::string& out, const OptionTable& table, bool of_program, std::size_t width) {
  std::string usage =
      of_program ? "animeme [OPTIONS] COMMAND" : "animeme " + table.name + " [OPTIONS]";
  for (const Option* option : table.arguments()) {
    const std::string name =
        option->argument + (option->variable.is_list() && !option->is_one_at_a_time ? "..." : "");
    usage += option->is_required ? " " + name : " [" + name + "]";
  }
  out += "Usage: ";
  wrap(out, 7, usage, 7, width);
}

// Where a line of a shell begins its comment.
std::size_t comment_of(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 1; i < line.size(); ++i) {
    quoted = quoted != (line[i] == '"' || line[i] == '\'');
    if (line[i] == '#' && line[i - 1] == ' ' && !quoted) return i;
  }
  return std::string_view::npos;
}

// A command of a shell that is too long: its comment stands above it, and it goes on below.
void add_command(std::string& out, std::string_view line, std::size_t width) {
  if (const std::size_t comment = comment_of(line); comment != std::string_view::npos) {
    out += "  " + std::string(line.substr(comment)) + "\n";
    line = line.substr(0, line.find_last_not_of(' ', comment - 1) + 1);
  }
  for (std::size_t room = width; line.size() > room; room = width - kIndent) {
    bool quoted = false;
    std::size_t blank = 0;
    for (std::size_t i = kIndent; i + 2 <= room; ++i) {
      quoted = quoted != (line[i] == '"' || line[i] == '\'');
      if (line[i] == ' ' && !quoted) blank = i;
    }
    if (blank == 0) break;
    out += std::string(line.substr(0, blank)) + " \\\n" + std::string(kIndent, ' ');
    line.remove_prefix(blank + 1);
  }
  out += std::string(line) + "\n";
}

void add_footer(std::string& out, std::string_view text, std::size_t width) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.size() > width && line.starts_with("  ")) {
      add_command(out, line, width);
    } else {
      wrap(out, 0, line, 0, width);
    }
  }
}

}  // namespace

std::string help_text(const OptionTable& table, const OptionTable& program, bool all, int columns) {
  const std::size_t width = std::size_t(std::max(columns, 60));
  std::string out;
  wrap(out, 0, table.summary, 0, width);
  add_usage(out, table, &table == &program, width);
  add_options(out, table, kArguments, table.arguments(), width);
  std::vector<std::string> titles;
  for (const Option* option : table.named()) {
    const bool shown = all || option->group.empty() || option->group != table.rest_title;
    const bool known = std::find(titles.begin(), titles.end(), option->group) != titles.end();
    if (shown && !known) titles.push_back(option->group);
  }
  for (const std::string& title : titles) {
    std::vector<const Option*> options = table.named();
    std::erase_if(options, [&](const Option* option) { return option->group != title; });
    add_options(out, table, title.empty() ? "Options" : title, options, width);
  }
  if (!table.commands.empty()) out += "\nCommands:\n";
  for (const OptionTable& command : table.commands) {
    add_row(out, command.name, command.summary, width);
  }
  out += "\n";
  add_footer(out, table.footer, width);
  return out;
}

}  // namespace animeme::tools

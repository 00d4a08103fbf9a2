#include "tools/app/commands/help_table.h"

#include <CLI/CLI.hpp>

namespace animeme::tools {
namespace {

// CLI11 writes the values that it checks for into the name of the type: "TEXT:{aac,opus}".
std::vector<std::string> words_of(const std::string& type) {
  const std::size_t open = type.find('{'), end = type.find('}');
  if (open == std::string::npos || end == std::string::npos || end < open) return {};
  std::vector<std::string> words;
  std::string word;
  for (const char c : type.substr(open + 1, end - open - 1) + ",") {
    if (c != ',') {
      word += c;
      continue;
    }
    // "name->value" of tables
    words.push_back(word.substr(0, word.find("->")));
    word.clear();
  }
  return words;
}

std::string trimmed(std::string text) {
  while (!text.empty() && text.front() == ' ') text.erase(text.begin());
  while (!text.empty() && (text.back() == ' ' || text.back() == '\n')) text.pop_back();
  return text;
}

HelpOption option_of(const CLI::Option& option, const CLI::Formatter& formatter, bool named) {
  HelpOption out;
  if (named) {
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
  } else {
    out.names.push_back(option.get_name(true));
  }
  out.value = trimmed(formatter.make_option_opts(&option));
  out.text = option.get_description();
  out.words = words_of(option.get_type_name());
  out.required = option.get_required();
  return out;
}

}  // namespace

HelpTable help_table(const CLI::App& app) {
  // The columns of the words behind an option are public to formatters alone.
  struct Columns : CLI::Formatter {
    using CLI::Formatter::make_option_opts;
  };
  const Columns formatter;
  HelpTable table{app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->nonpositional()) table.options.push_back(option_of(*option, formatter, true));
    if (option->get_positional()) table.arguments.push_back(option_of(*option, formatter, false));
  }
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty()) table.commands.push_back(help_table(*command));
  }
  return table;
}

}  // namespace animeme::tools

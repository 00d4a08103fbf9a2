// Completions of bash, zsh and fish.
#include <sstream>

#include "tools/app/commands/help.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {
namespace {

std::string names_of(const std::vector<const Option*>& options) {
  std::string out;
  for (const Option* option : options)
    out += (out.empty() ? "" : " ") + joined(option->shown_names(), " ");
  return out;
}

// Between single quotes, for all three shells.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + out + "'";
}

std::string first_sentence(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  constexpr std::size_t kMost = 72;
  if (line.size() <= kMost) return line;
  std::size_t end = line.rfind(' ', kMost);
  return line.substr(0, end == std::string::npos ? kMost : end) + " ...";
}

// Values of an option, by all its names, behind a command.
void bash_values(std::ostream& out, const std::string& command,
                 const std::vector<const Option*>& options) {
  for (const Option* option : options) {
    if (option->choices.empty()) continue;
    out << "    ";
    const std::vector<std::string> names = option->shown_names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      out << (i == 0 ? "" : " | ") << quoted(command + " " + names[i]);
    }
    out << ") COMPREPLY=($(compgen -W " << quoted(joined(option->choices, " "))
        << " -- \"$word\")); return ;;\n";
  }
}

std::string bash_completion(const OptionTable& program) {
  std::ostringstream out;
  const std::string& name = program.name;
  out << "# bash completion of " << name << "\n_" << name << "() {\n"
      << "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command= "
         "words= i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    case ${COMP_WORDS[i]} in\n      -*) ;;\n      *) command=${COMP_WORDS[i]}; break ;;\n"
         "    esac\n  done\n  COMPREPLY=()\n  case \"$command $before\" in\n";
  for (const OptionTable& command : program.commands) {
    bash_values(out, command.name, command.named());
  }
  out << "  esac\n  case $command in\n";
  std::string commands;
  for (const OptionTable& command : program.commands) {
    commands += command.name + " ";
    out << "    " << command.name << ") words=" << quoted(names_of(command.named())) << " ;;\n";
  }
  out << "    '') words=" << quoted(commands + names_of(program.named())) << " ;;\n  esac\n"
      << "  if [[ $word == -* || -z $command ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n  fi\n}\n"
      << "complete -o default -F _" << name << " " << name << "\n";
  return out.str();
}

// zsh has its own marks inside of "name[text]:value:action".
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : first_sentence(text)) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

void zsh_options(std::ostream& out, const std::vector<const Option*>& options) {
  for (const Option* option : options) {
    const std::string value = option->variable.is_flag() ? ""
                              : option->choices.empty()
                                  ? ":value:_files"
                                  : ":value:(" + joined(option->choices, " ") + ")";
    const std::string all = joined(option->shown_names(), " ");
    for (const std::string& name : option->shown_names()) {
      out << " \\\n        "
          << quoted("(" + all + ")" + name + "[" + zsh_text(option->help) + "]" + value);
    }
  }
}

std::string zsh_completion(const OptionTable& program) {
  std::ostringstream out;
  const std::string& name = program.name;
  out << "#compdef " << name << "\n_" << name << "() {\n  local state line\n  _arguments -C";
  zsh_options(out, program.named());
  out << " \\\n        '1: :->command' '*:: :->rest'\n  case $state in\n    command)\n"
         "      local -a commands=(\n";
  for (const OptionTable& command : program.commands) {
    out << "        " << quoted(command.name + ":" + zsh_text(command.summary)) << "\n";
  }
  out << "      )\n      _describe command commands ;;\n    rest)\n      case $line[1] in\n";
  for (const OptionTable& command : program.commands) {
    out << "        " << command.name << ") _arguments";
    zsh_options(out, command.named());
    out << " \\\n        '*:file:_files' ;;\n";
  }
  out << "      esac ;;\n  esac\n}\n_" << name << " \"$@\"\n";
  return out.str();
}

void fish_options(std::ostream& out, const std::string& name, const std::string& condition,
                  const std::vector<const Option*>& options) {
  for (const Option* option : options) {
    out << "complete -c " << name << " -n " << quoted(condition);
    for (const std::string& one : option->shown_names()) {
      out << (one.starts_with("--") ? " -l " + one.substr(2) : " -s " + one.substr(1));
    }
    if (!option->variable.is_flag()) out << " -r";
    if (!option->choices.empty()) out << " -f -a " << quoted(joined(option->choices, " "));
    out << " -d " << quoted(first_sentence(option->help)) << "\n";
  }
}

std::string fish_completion(const OptionTable& program) {
  std::ostringstream out;
  const std::string& name = program.name;
  out << "# fish completion of " << name << "\n";
  for (const OptionTable& command : program.commands) {
    out << "complete -c " << name << " -n __fish_use_subcommand -f -a " << command.name << " -d "
        << quoted(first_sentence(command.summary)) << "\n";
  }
  fish_options(out, name, "__fish_use_subcommand", program.named());
  for (const OptionTable& command : program.commands) {
    fish_options(out, name, "__fish_seen_subcommand_from " + command.name, command.named());
  }
  return out.str();
}

}  // namespace

std::string completion(const OptionTable& program, const std::string& shell) {
  if (shell == "zsh") return zsh_completion(program);
  if (shell == "fish") return fish_completion(program);
  return bash_completion(program);
}

}  // namespace animeme::tools

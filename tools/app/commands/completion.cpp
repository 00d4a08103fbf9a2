// Completions of bash, zsh and fish.
#include <sstream>

#include "tools/app/commands/help_table.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {
namespace {

std::string names_of(const std::vector<HelpOption>& options) {
  std::string out;
  for (const HelpOption& option : options)
    out += (out.empty() ? "" : " ") + joined(option.names, " ");
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
                 const std::vector<HelpOption>& options) {
  for (const HelpOption& option : options) {
    if (option.words.empty()) continue;
    out << "    ";
    for (std::size_t i = 0; i < option.names.size(); ++i) {
      out << (i == 0 ? "" : " | ") << quoted(command + " " + option.names[i]);
    }
    out << ") COMPREPLY=($(compgen -W " << quoted(joined(option.words, " "))
        << " -- \"$word\")); return ;;\n";
  }
}

std::string bash_completion(const HelpTable& program) {
  std::ostringstream out;
  const std::string& name = program.name;
  out << "# bash completion of " << name << "\n_" << name << "() {\n"
      << "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command= "
         "words= i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    case ${COMP_WORDS[i]} in\n      -*) ;;\n      *) command=${COMP_WORDS[i]}; break ;;\n"
         "    esac\n  done\n  COMPREPLY=()\n  case \"$command $before\" in\n";
  for (const HelpTable& command : program.commands) {
    bash_values(out, command.name, command.options);
  }
  out << "  esac\n  case $command in\n";
  std::string commands;
  for (const HelpTable& command : program.commands) {
    commands += command.name + " ";
    out << "    " << command.name << ") words=" << quoted(names_of(command.options)) << " ;;\n";
  }
  out << "    '') words=" << quoted(commands + names_of(program.options)) << " ;;\n  esac\n"
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

void zsh_options(std::ostream& out, const std::vector<HelpOption>& options) {
  for (const HelpOption& option : options) {
    const std::string value = option.value.empty()   ? ""
                              : option.words.empty() ? ":value:_files"
                                                     : ":value:(" + joined(option.words, " ") + ")";
    const std::string all = joined(option.names, " ");
    for (const std::string& name : option.names) {
      out << " \\\n        "
          << quoted("(" + all + ")" + name + "[" + zsh_text(option.text) + "]" + value);
    }
  }
}

std::string zsh_completion(const HelpTable& program) {
  std::ostringstream out;
  const std::string& name = program.name;
  out << "#compdef " << name << "\n_" << name << "() {\n  local state line\n  _arguments -C";
  zsh_options(out, program.options);
  out << " \\\n        '1: :->command' '*:: :->rest'\n  case $state in\n    command)\n"
         "      local -a commands=(\n";
  for (const HelpTable& command : program.commands) {
    out << "        " << quoted(command.name + ":" + zsh_text(command.summary)) << "\n";
  }
  out << "      )\n      _describe command commands ;;\n    rest)\n      case $line[1] in\n";
  for (const HelpTable& command : program.commands) {
    out << "        " << command.name << ") _arguments";
    zsh_options(out, command.options);
    out << " \\\n        '*:file:_files' ;;\n";
  }
  out << "      esac ;;\n  esac\n}\n_" << name << " \"$@\"\n";
  return out.str();
}

void fish_options(std::ostream& out, const std::string& name, const std::string& condition,
                  const std::vector<HelpOption>& options) {
  for (const HelpOption& option : options) {
    out << "complete -c " << name << " -n " << quoted(condition);
    for (const std::string& one : option.names) {
      out << (one.starts_with("--") ? " -l " + one.substr(2) : " -s " + one.substr(1));
    }
    if (!option.value.empty()) out << " -r";
    if (!option.words.empty()) out << " -f -a " << quoted(joined(option.words, " "));
    out << " -d " << quoted(first_sentence(option.text)) << "\n";
  }
}

std::string fish_completion(const HelpTable& program) {
  std::ostringstream out;
  const std::string& name = program.name;
  out << "# fish completion of " << name << "\n";
  for (const HelpTable& command : program.commands) {
    out << "complete -c " << name << " -n __fish_use_subcommand -f -a " << command.name << " -d "
        << quoted(first_sentence(command.summary)) << "\n";
  }
  fish_options(out, name, "__fish_use_subcommand", program.options);
  for (const HelpTable& command : program.commands) {
    fish_options(out, name, "__fish_seen_subcommand_from " + command.name, command.options);
  }
  return out.str();
}

}  // namespace

std::string completion(const HelpTable& program, const std::string& shell) {
  if (shell == "zsh") return zsh_completion(program);
  if (shell == "fish") return fish_completion(program);
  return bash_completion(program);
}

}  // namespace animeme::tools

// Man pages, by the macros of man(7).
#include <cctype>
#include <sstream>

#include "tools/app/commands/help.h"

namespace animeme::tools {
namespace {

// Text that is shown as it stands.
std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool first = i == 0 || text[i - 1] == '\n';
    if (first && text[i] == '.') out += "\\&";
    switch (text[i]) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";  // as on a keyboard, not a hyphen
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '~':
        out += "\\(ti";
        break;
      case '^':
        out += "\\(ha";
        break;
      default:
        out += text[i];
    }
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }

std::string upper(std::string text) {
  for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

void write_options(std::ostream& out, const char* title, const std::vector<const Option*>& options,
                   bool arguments) {
  if (options.empty()) return;
  out << ".SH " << title << "\n";
  for (const Option* option : options) {
    const std::vector<std::string> names =
        arguments ? std::vector<std::string>{option->argument} : option->shown_names();
    const std::string value = option->value_text();
    out << ".TP\n";
    for (std::size_t i = 0; i < names.size(); ++i) out << (i == 0 ? "" : ", ") << bold(names[i]);
    if (!value.empty()) out << " " << roff(value);
    out << "\n" << roff(option->help) << "\n";
  }
}

// Its first line is a title where it ends with a colon.
void write_footer(std::ostream& out, const std::string& footer) {
  std::string text = footer;
  std::string title = "NOTES";
  const std::size_t line = footer.find('\n');
  if (line != std::string::npos && line > 0 && footer[line - 1] == ':') {
    title = upper(footer.substr(0, line - 1));
    text = footer.substr(line + 1);
  }
  out << ".SH " << title << "\n.nf\n" << roff(text) << "\n.fi\n";
}

void write_synopsis(std::ostream& out, const OptionTable& table, const std::string& words) {
  out << ".SH SYNOPSIS\n" << bold(words) << " [\\fIOPTIONS\\fR]";
  for (const Option* argument : table.arguments()) {
    const std::string name = roff(argument->argument);
    out << (argument->is_required ? " \\fI" + name + "\\fR" : " [\\fI" + name + "\\fR]");
  }
  out << (table.commands.empty() ? "\n" : " \\fICOMMAND\\fR ...\n");
}

}  // namespace

std::string man_page(const OptionTable& table, const OptionTable& program,
                     const std::string& version) {
  const bool whole = &table == &program;
  const std::string page = whole ? program.name : program.name + "-" + table.name;
  std::string summary = table.summary;
  for (char& c : summary) c = c == '\n' ? ' ' : c;
  std::ostringstream out;
  out << ".TH " << upper(page) << " 1 \"\" \"" << program.name << " " << version
      << "\" \"User Commands\"\n"
      << ".nh\n.ad l\n.SH NAME\n"
      << roff(page) << " \\- " << roff(summary) << "\n";
  write_synopsis(out, table, whole ? program.name : program.name + " " + table.name);
  if (!table.commands.empty()) {
    out << ".SH COMMANDS\n";
    for (const OptionTable& command : table.commands) {
      out << ".TP\n" << bold(command.name) << "\n" << roff(command.summary) << "\n";
    }
  }
  write_options(out, "ARGUMENTS", table.arguments(), true);
  write_options(out, "OPTIONS", table.named(), false);
  write_footer(out, table.footer);
  out << ".SH SEE ALSO\n";
  if (whole) {
    for (std::size_t i = 0; i < table.commands.size(); ++i) {
      out << ".BR " << roff(program.name + "-" + table.commands[i].name) << " (1)"
          << (i + 1 < table.commands.size() ? ",\n" : "\n");
    }
  } else {
    out << ".BR " << roff(program.name) << " (1)\n";
  }
  return out.str();
}

}  // namespace animeme::tools

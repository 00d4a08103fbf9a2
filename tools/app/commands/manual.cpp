// `animeme manual`: pages of man and completions of shells, from the tables of --help.
#include <filesystem>
#include <iostream>

#include "tools/app/commands/common.h"
#include "tools/app/commands/help.h"
#include "tools/app/commands/line.h"
#include "tools/app/commands/report.h"

namespace animeme::tools {
namespace {

struct ManualOptions {
  std::string form;
  std::string folder;
};

void add_options(OptionTable& cli, ManualOptions& options) {
  cli.add("form", options.form, "man: pages; bash, zsh, fish: a completion")
      ->required()
      ->one_of("man bash zsh fish");
  cli.add("-o,--output", options.folder,
          "Folder for the pages, which is created, or file for a completion; default: "
          "standard output")
      ->output("", OutputKind::file_or_folder);
}

Result<int> done(const Result<void>& written, const std::string& path, std::size_t files) {
  if (!written) return written.error();
  report_output(path, std::to_string(files) + (files == 1 ? " file" : " files"),
                {{"files", files}});
  return kOk;
}

Result<int> run(const ManualOptions& options) {
  if (options.form == "man" && options.folder.empty()) {
    return usage_error("man pages need a folder: animeme manual man -o man1");
  }
  const OptionTable program = program_table();
  if (options.form != "man") {
    const std::string script = completion(program, options.form);
    if (options.folder.empty()) {
      if (const std::string wrong = problem_with_report(); !wrong.empty())
        return usage_error(wrong);
      std::cout << script;
      return kOk;
    }
    return done(write_file(options.folder, std::string_view(script)), options.folder, 1);
  }
  std::error_code problem;
  std::filesystem::create_directories(options.folder, problem);
  const auto write = [&](const OptionTable& table, const std::string& name) {
    const std::string path = (std::filesystem::path(options.folder) / (name + ".1")).string();
    return write_file(path, std::string_view(man_page(table, program, ANIMEME_VERSION)));
  };
  Result<void> written = write(program, program.name);
  for (std::size_t i = 0; i < program.commands.size() && written; ++i) {
    written = write(program.commands[i], program.name + "-" + program.commands[i].name);
  }
  return done(written, options.folder, program.commands.size() + 1);
}

}  // namespace

const Command kManual{"manual", "Write man pages, and completions for bash, zsh and fish",
                      "  animeme manual man -o ~/.local/share/man/man1 && man animeme-speak\n"
                      "  animeme manual bash >~/.local/share/bash-completion/completions/animeme\n"
                      "  animeme manual zsh >~/.zfunc/_animeme\n"
                      "  animeme manual fish >~/.config/fish/completions/animeme.fish",
                      set_up<ManualOptions>};

}  // namespace animeme::tools

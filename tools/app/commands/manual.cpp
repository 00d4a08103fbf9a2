// `animeme manual`: pages of man and completions of shells, from the tables of --help.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "tools/app/commands/common.h"
#include "tools/app/commands/help_table.h"
#include "tools/app/commands/line.h"

namespace animeme::tools {
namespace {

struct ManualOptions {
  std::string form;
  std::string folder;
};

void add_options(CLI::App& app, ManualOptions& options) {
  app.add_option("form", options.form, "man: pages; bash, zsh, fish: a completion")
      ->required()
      ->check(CLI::IsMember({"man", "bash", "zsh", "fish"}));
  add_output(app.add_option("-o,--output", options.folder,
                            "Folder for the pages, which is made, or file for a completion; "
                            "default: standard output"),
             {}, OutputKind::file_or_folder);
}

Result<int> done(const Result<void>& written) {
  if (!written) return written.error();
  return kOk;
}

Result<int> run(const ManualOptions& options) {
  if (options.form == "man" && options.folder.empty()) {
    return usage_error("--output: pages need a folder, as in: animeme manual man -o man1");
  }
  CLI::App app;
  set_up_program(app);
  const HelpTable program = help_table(app);
  if (options.form != "man") {
    const std::string script = completion(program, options.form);
    if (options.folder.empty()) {
      std::cout << script;
      return kOk;
    }
    return done(write_file(options.folder, std::string_view(script)));
  }
  std::error_code problem;
  std::filesystem::create_directories(options.folder, problem);
  const auto write = [&](const HelpTable& table, const std::string& name) {
    const std::string path = (std::filesystem::path(options.folder) / (name + ".1")).string();
    return write_file(path, std::string_view(man_page(table, program, ANIMEME_VERSION)));
  };
  Result<void> written = write(program, program.name);
  for (std::size_t i = 0; i < program.commands.size() && written; ++i) {
    written = write(program.commands[i], program.name + "-" + program.commands[i].name);
  }
  return done(written);
}

}  // namespace

const Command kManual{"manual", "Man pages of all commands, and completions for bash, zsh and fish",
                      "  animeme manual man -o ~/.local/share/man/man1 && man animeme-speak\n"
                      "  animeme manual bash >~/.local/share/bash-completion/completions/animeme\n"
                      "  animeme manual zsh >~/.zfunc/_animeme\n"
                      "  animeme manual fish >~/.config/fish/completions/animeme.fish",
                      set_up<ManualOptions>};

}  // namespace animeme::tools

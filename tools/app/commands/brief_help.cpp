#include "tools/app/commands/brief_help.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

namespace animeme::tools {

namespace {

class BriefHelp : public CLI::Formatter {
 public:
  explicit BriefHelp(std::string title) : title_(std::move(title)) { column_width(30); }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    all_ = mode == CLI::AppFormatMode::All;
    return CLI::Formatter::make_help(app, std::move(name), mode);
  }
  std::string make_group(std::string group, bool positional,
                         std::vector<const CLI::Option*> options) const override {
    if (group == title_ && !all_) return {};
    return CLI::Formatter::make_group(std::move(group), positional, std::move(options));
  }

 private:
  std::string title_;
  mutable bool all_ = false;  // one help is made at a time
};

}  // namespace

void show_in_help_all(CLI::App& app, const std::string& title,
                      const std::vector<std::string>& names) {
  app.set_help_all_flag("--help-all", "Print all options: " + title);
  for (const std::string& name : names) app.get_option(name)->group(title);
  app.formatter(std::make_shared<BriefHelp>(title));
}

}  // namespace animeme::tools

#include "tools/app/commands/script_options.h"

#include <algorithm>

#include "dam/script/table_text_internal.h"
#include "tools/app/commands/options.h"
#include "tools/app/commands/terminal.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::tools {

namespace {

std::string list_of_formats() {
  std::string list;
  for (const dam::ScriptFormat& format : scripts::script_formats()) {
    list += "\n  " + std::string(format.name) +
            std::string(12 - std::min<std::size_t>(11, format.name.size()), ' ') +
            std::string(format.title);
  }
  return list;
}

}  // namespace

std::string parse_script_format(const std::string& text, dam::ScriptOptions& reading) {
  if (text.empty()) return "a name is needed; help prints a list";
  std::string_view name = text;
  const std::size_t at = name.find('@');
  if (at != std::string_view::npos) {
    const auto rate = dam::parse_number(name.substr(at + 1));
    if (!rate || !(*rate > 0) || !(*rate < 1e12)) {
      return "after @ comes the number of time units per second, as in timit@8000";
    }
    reading.rate = *rate;
    name = name.substr(0, at);
  }
  const std::size_t colon = name.find(':');
  if (colon != std::string_view::npos) {
    const std::string_view unit = name.substr(colon + 1);
    if (unit != "words" && unit != "phones") return "after : comes words or phones";
    reading.unit = unit == "words" ? dam::LabelUnit::words : dam::LabelUnit::phones;
    name = name.substr(0, colon);
  }
  const auto formats = scripts::script_formats();
  const bool known = name.empty() || std::any_of(formats.begin(), formats.end(),
                                                 [&](const auto& f) { return f.name == name; });
  if (!known) return "there is no format " + std::string(name) + "; these are:" + list_of_formats();
  reading.format = name;
  return {};
}

Result<dam::Script> script_for(const std::string& path, const std::vector<std::string>& files,
                               const speech::ScriptInput& reading) {
  if (!path.empty()) return speech::read_script(path, reading, terminal_log());
  for (const std::string& file : files) {
    auto carried = speech::carried_script(file, reading, terminal_log());
    if (carried) return std::move(*carried);
  }
  return dam::Script{};
}

void add_script_options(OptionTable& cli, dam::ScriptOptions& reading) {
  cli.add("--tier", reading.tier,
          "Tier of the script (its name or number), or recording of the table, if it has several")
      ->value("NAME");
  cli.add("--speaker", reading.speaker, "Read what this speaker says, if the script names speakers")
      ->value("NAME");
  cli.add("--speak-marks", reading.speak_marks,
          "Say marks such as [noise], <unk> and (laughs) as words; else they are silence");
  cli.add("--script-format", parsed<parse_script_format>(reading),
          "Format of the script, NAME[:words][@RATE], if it cannot be detected; help prints "
          "a list")
      ->value("FORMAT");
}

void add_script_options(OptionTable& cli, dam::ScriptOptions& reading, std::string& language) {
  add_script_options(cli, reading);
  cli.add("--lang", language, "Language of a script that has words only: en, de, fr ...")
      ->show_default();
}

}  // namespace animeme::tools

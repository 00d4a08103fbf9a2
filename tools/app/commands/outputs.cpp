#include "tools/app/commands/outputs.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "fap/detail/text_scanner.h"
#include "tools/formats/files/files.h"
#include "tools/formats/files/output_file.h"
#include "tools/formats/files/output_folder.h"
#include "tools/formats/media/mux.h"

namespace animeme::tools {

namespace fs = std::filesystem;

namespace {

struct Given {
  std::string option;  // as it is called in messages
  std::string path;
};
std::vector<Given>& inputs() {
  static std::vector<Given> all;
  return all;
}

std::string list(const std::vector<std::string>& endings) {
  std::string text;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    const bool last = i + 1 == endings.size();
    text += (i == 0 ? "" : last ? " or " : ", ") + endings[i];
  }
  return text;
}

bool is_special(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

bool names_folder(const std::string& path) {
  std::error_code ignored;
  return path.ends_with('/') || fs::is_directory(path, ignored);
}

std::string wrong_ending(const Given& output, const Option& rule) {
  if (rule.extensions.empty() || (output.path == "-" && rule.output_kind != OutputKind::file))
    return {};
  const std::string ending = extension_of(output.path);
  if (rule.output_kind == OutputKind::file_or_folder && names_folder(output.path)) return {};
  if (rule.output_kind != OutputKind::file && rule.output_kind != OutputKind::file_or_dash &&
      (ending.empty() || is_special(output.path)))
    return {};
  for (const std::string& fits : rule.extensions) {
    if (fap::detail::lower_case(fits) == ending) return {};
  }
  return output.option + " must end in " + list(rule.extensions) + ", not " + output.path;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code unknown;
  if (!fs::is_regular_file(a, unknown)) return false;
  return fs::equivalent(a, b, unknown) && !unknown;
}

bool lies_in(const std::string& file, const std::string& folder) {
  std::error_code unknown;
  if (folder.empty() || !fs::is_directory(folder, unknown)) return false;
  for (fs::path up = fs::weakly_canonical(file, unknown); up.has_relative_path();
       up = up.parent_path()) {
    if (fs::equivalent(up, folder, unknown)) return true;
  }
  return false;
}

std::string harm(const Given& output, const Given& other) {
  if (is_same_file(output.path, other.path)) {
    return output.option + " " + output.path + " is also what " + other.option +
           " names, and would be overwritten; give another name";
  }
  const std::string folder = media::segment_folder(output.path);  // replaced as a whole
  if (lies_in(other.path, folder)) {
    return output.option + " " + output.path + " replaces the folder " + folder +
           ", in which what " + other.option + " names lies; give another name";
  }
  return {};
}

}  // namespace

std::string problem_with_outputs(const OptionTable& command) {
  std::vector<Given> outputs;
  inputs().clear();
  for (const std::unique_ptr<Option>& option : command.options) {
    if (option->variable.is_flag()) continue;
    for (const std::string& value : option->values) {
      Given given{option->name(), value};
      if (option->output_kind == OutputKind::none) {
        if (value != "-") inputs().push_back(std::move(given));
        continue;
      }
      if (std::string text = wrong_ending(given, *option); !text.empty()) return text;
      if (value != "-") outputs.push_back(std::move(given));
    }
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const Given& input : inputs()) {
      if (std::string text = harm(outputs[i], input); !text.empty()) return text;
    }
    for (std::size_t k = 0; k < i; ++k) {
      std::error_code unknown;
      if (is_special(outputs[i].path)) continue;
      if (is_same_file(outputs[i].path, outputs[k].path) ||
          fs::weakly_canonical(outputs[i].path, unknown) ==
              fs::weakly_canonical(outputs[k].path, unknown)) {
        return outputs[i].option + " and " + outputs[k].option + " name the same file, " +
               outputs[i].path + "; give two names";
      }
    }
  }
  return {};
}

Result<void> outputs_can_be_written(const OptionTable& command) {
  for (const std::unique_ptr<Option>& option : command.options) {
    const OutputKind kind = option->output_kind;
    if (kind == OutputKind::none) continue;
    for (const std::string& path : option->values) {
      // Either: what has no ending and is not there will be made as the command needs it.
      std::error_code ignored;
      const bool either = kind == OutputKind::file_or_folder && path != "-";
      const bool unknown = extension_of(path).empty() && !fs::exists(path, ignored);
      const bool folder = kind == OutputKind::folder || (either && (names_folder(path) || unknown));
      auto can = folder ? try_output_folder(path) : try_output(path);
      if (can && !media::segment_folder(path).empty()) can = media::try_segments(path);
      if (!can) return can;
    }
  }
  return {};
}

std::string problem_with_another_output(const std::string& path) {
  for (const Given& input : inputs()) {
    if (is_same_file(path, input.path)) {
      return path + ", which is written beside the output, is also what " + input.option +
             " names; give the output another name";
    }
  }
  return {};
}

}  // namespace animeme::tools

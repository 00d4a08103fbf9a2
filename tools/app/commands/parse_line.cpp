// The only file that knows CLI11.
#include "tools/app/commands/parse_line.h"

#include <CLI/CLI.hpp>

namespace animeme::tools {

namespace {

using Kind = Variable::Kind;
using Values = CLI::results_t;

template <class T>
bool set(const Variable& variable, const std::string& text) {
  T value{};
  if (!CLI::detail::lexical_cast(text, value)) return false;
  *static_cast<T*>(variable.address) = value;
  return true;
}

template <class T>
bool set_optional(const Variable& variable, const std::string& text) {
  T value{};
  if (!CLI::detail::lexical_cast(text, value)) return false;
  *static_cast<std::optional<T>*>(variable.address) = value;
  return true;
}

bool set_numbers(const Variable& variable, const Values& texts) {
  std::vector<double> numbers(texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!CLI::detail::lexical_cast(texts[i], numbers[i])) return false;
  }
  *static_cast<std::vector<double>*>(variable.address) = std::move(numbers);
  return true;
}

bool set_variable(const Variable& variable, const Values& texts) {
  const std::string& text = texts.front();
  switch (variable.kind) {
    case Kind::integer:
      return set<int>(variable, text);
    case Kind::whole:
      return set<unsigned>(variable, text);
    case Kind::long_integer:
      return set<std::int64_t>(variable, text);
    case Kind::long_whole:
      return set<std::uint64_t>(variable, text);
    case Kind::number:
      return set<double>(variable, text);
    case Kind::optional_integer:
      return set_optional<int>(variable, text);
    case Kind::optional_whole:
      return set_optional<std::uint64_t>(variable, text);
    case Kind::optional_number:
      return set_optional<double>(variable, text);
    case Kind::text:
      *static_cast<std::string*>(variable.address) = text;
      return true;
    case Kind::optional_text:
      *static_cast<std::optional<std::string>*>(variable.address) = text;
      return true;
    case Kind::texts:
      *static_cast<std::vector<std::string>*>(variable.address) = texts;
      return true;
    case Kind::numbers:
      return set_numbers(variable, texts);
    case Kind::parsed:  // see add_value()
    case Kind::none:
    case Kind::flag:
    case Kind::optional_flag:
      break;
  }
  return false;
}

std::string names_of(const Option& option) {
  std::string text = option.argument;
  for (const Option::Name& name : option.names) {
    text += (text.empty() ? "" : ",") + std::string(name.negates ? "!" : "") + name.text;
  }
  return text;
}

CLI::Option* add_flag(CLI::App& app, const Option& option) {
  const Variable variable = option.variable;
  if (variable.kind == Kind::flag) {
    return app.add_flag(names_of(option), *static_cast<bool*>(variable.address));
  }
  return app.add_flag_function(names_of(option), [variable](std::int64_t times) {
    *static_cast<std::optional<bool>*>(variable.address) = times > 0;
  });
}

CLI::Option* add_value(CLI::App& app, const Option& option) {
  const Variable variable = option.variable;
  CLI::Option* const out =
      app.add_option(names_of(option), [&option, variable](const Values& texts) {
        if (variable.kind != Kind::parsed) return set_variable(variable, texts);
        const std::string problem = variable.parse(texts.front(), variable.address);
        if (!problem.empty()) throw CLI::ValidationError(option.name(), problem);
        return true;
      });
  out->type_name(option.type_text());
  if (variable.is_list()) out->expected(CLI::detail::expected_max_vector_size);
  if (option.most > 0) out->expected(1, option.most);
  if (option.splits_at_commas) out->delimiter(',');
  if (option.is_one_at_a_time) out->allow_extra_args(false);
  out->check([&option](const std::string& text) { return option.problem_with(text); }, "", "");
  return out;
}

void add_options(CLI::App& app, const OptionTable& table, std::vector<CLI::Option*>& added) {
  for (const std::unique_ptr<Option>& option : table.options) {
    if (option->variable.kind == Kind::none) {
      added.push_back(nullptr);  // CLI11 has its own
      continue;
    }
    CLI::Option* const one =
        option->variable.is_flag() ? add_flag(app, *option) : add_value(app, *option);
    one->required(option->is_required);
    if (bool* const flag = option->was_given; flag != nullptr) {
      one->each([flag](const std::string&) { *flag = true; });
    }
    added.push_back(one);
  }
  for (const std::unique_ptr<Option>& option : table.options) {
    for (const std::string& other : option->needed) {
      app.get_option(option->name())->needs(app.get_option(other));
    }
    for (const std::string& other : option->excluded) {
      app.get_option(option->name())->excludes(app.get_option(other));
    }
  }
  if (!table.rest_title.empty()) app.set_help_all_flag("--help-all");
}

void keep_values(OptionTable& table, const std::vector<CLI::Option*>& added) {
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (added[i] != nullptr) table.options[i]->values = added[i]->results();
  }
}

}  // namespace

ParsedLine parse_line(OptionTable& program, OptionTable* command,
                      std::span<const char* const> words) {
  using What = ParsedLine::Action;
  CLI::App app("", program.name);
  app.set_version_flag("-V,--version", std::string());
  app.fallthrough();
  std::vector<CLI::Option*> common, own;
  add_options(app, program, common);
  if (command != nullptr) add_options(*app.add_subcommand(command->name), *command, own);
  std::vector<std::string> backwards(words.rbegin(), words.rend());
  try {
    app.parse(std::move(backwards));
  } catch (const CLI::CallForHelp&) {
    return {What::help, {}};
  } catch (const CLI::CallForAllHelp&) {
    return {What::help_all, {}};
  } catch (const CLI::CallForVersion&) {
    return {What::version, {}};
  } catch (const CLI::ExcludesError& error) {  // "--text excludes --script"
    std::string pair = error.what();
    if (const std::size_t at = pair.find(" excludes "); at != pair.npos) {
      pair.replace(at, 10, " and ");
    }
    return {What::fail, pair + " cannot be used together"};
  } catch (const CLI::ParseError& error) {
    return {What::fail, error.what()};
  }
  keep_values(program, common);
  if (command != nullptr) keep_values(*command, own);
  return {};
}

}  // namespace animeme::tools

#include "tools/app/commands/options.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "fap/rate_text.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::tools {

namespace {

constexpr double kManyAtMost = 1e9;  // seconds of thirty years, frames of one

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    if (end > 0) parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

const char* type_of(Variable::Kind kind) {
  switch (kind) {
    case Variable::Kind::none:
    case Variable::Kind::flag:
    case Variable::Kind::optional_flag:
      break;
    case Variable::Kind::integer:
    case Variable::Kind::long_integer:
    case Variable::Kind::optional_integer:
      return "INT";
    case Variable::Kind::whole:
    case Variable::Kind::long_whole:
    case Variable::Kind::optional_whole:
      return "UINT";
    case Variable::Kind::number:
    case Variable::Kind::optional_number:
    case Variable::Kind::numbers:
      return "FLOAT";
    case Variable::Kind::text:
    case Variable::Kind::optional_text:
    case Variable::Kind::parsed:
    case Variable::Kind::texts:
      return "TEXT";
  }
  return "";
}

// The value of a variable, as help prints a default.
std::string value_of(const Variable& variable) {
  const void* const at = variable.address;
  switch (variable.kind) {
    case Variable::Kind::integer:
      return std::to_string(*static_cast<const int*>(at));
    case Variable::Kind::whole:
      return std::to_string(*static_cast<const unsigned*>(at));
    case Variable::Kind::long_integer:
      return std::to_string(*static_cast<const std::int64_t*>(at));
    case Variable::Kind::long_whole:
      return std::to_string(*static_cast<const std::uint64_t*>(at));
    case Variable::Kind::number:
      return format("%g", *static_cast<const double*>(at));
    case Variable::Kind::text:
      return *static_cast<const std::string*>(at);
    case Variable::Kind::texts:
      return joined(*static_cast<const std::vector<std::string>*>(at), ",");
    default:
      return {};
  }
}

// What is resampled has at most so many frames; nothing that shows a face is faster.
constexpr double kLowestRate = 0.01, kHighestRate = 1000;

std::string problem_of_rate(const std::string& text) {
  const Result<fap::Rate> rate = fap::parse_rate(text);
  const bool is_rate = rate ? rate->valid() : rate.error().code == Code::out_of_range;
  if (!is_rate) return "'" + text + "' is not a frame rate; write 25 or 29.97";
  const double value = rate ? rate->frames_per_second() : 0;
  if (value >= kLowestRate && value <= kHighestRate) return "";
  return "'" + text + "' is not a frame rate from " +
         format("%g to %g frames per second", kLowestRate, kHighestRate) + "; write 25 or 29.97";
}

std::string problem_of_picture_size(const std::string& text) {
  return exchange::parse_picture_size(text)
             ? ""
             : "'" + text + "' is not a picture size; write 1280x720";
}

}  // namespace

std::string problem_of_number(const std::string& text, double low, double high,
                              const std::string& what) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole = !text.empty() && *end == 0;
  // NaN is in no range.
  if (whole && value >= low && value <= high) return {};
  const std::string ends = format("a number from %.10g to %.10g", low, high);
  return "'" + text + "' is not " + (what.empty() ? ends : what);
}

Option::Option(const char* all_names, Variable sets, const char* what)
    : variable(sets), help(what), type_name(type_of(sets.kind)) {
  for (std::string& text : split(all_names, ',')) {
    Name one;
    for (; text[0] == '!' || text[0] == '.'; text.erase(0, 1)) {
      (text[0] == '!' ? one.negates : one.hidden) = true;
    }
    if (text[0] != '-') {
      argument = text;
      continue;
    }
    one.text = text;
    names.push_back(one);
  }
}

Option* Option::required() {
  is_required = true;
  return this;
}

Option* Option::between(double least, double greatest) {
  low = least, high = greatest;
  range = format("%.10g..%.10g", low, high);
  return this;
}

Option* Option::above_zero() {
  low = 1e-6, high = kManyAtMost;
  range = ">0";
  return this;
}

Option* Option::at_least_zero() {
  low = 0, high = kManyAtMost;
  range = ">=0";
  return this;
}

Option* Option::one_of(const std::string& words) {
  choices = split(words, ' ');
  return this;
}

Option* Option::frame_rate() { return check(problem_of_rate)->type("RATE"); }

Option* Option::picture_size() { return check(problem_of_picture_size)->type("WIDTHxHEIGHT"); }

Option* Option::check(Problem other) {
  problem = other;
  return this;
}

Option* Option::type(const char* text) {
  type_name = text;
  return this;
}

Option* Option::value(const char* text) {
  shown = text;
  return this;
}

Option* Option::show_default() {
  preset = value_of(variable);
  return this;
}

Option* Option::at_commas() {
  splits_at_commas = true;
  return this;
}

Option* Option::one_at_a_time() {
  is_one_at_a_time = true;
  return this;
}

Option* Option::at_most(int count) {
  most = count;
  return this;
}

Option* Option::in_group(const char* title) {
  group = title;
  return this;
}

Option* Option::needs(const char* option) {
  needed.emplace_back(option);
  return this;
}

Option* Option::excludes(const char* others) {
  for (std::string& one : split(others, ' ')) excluded.push_back(std::move(one));
  return this;
}

Option* Option::sets(bool& flag) {
  was_given = &flag;
  return this;
}

Option* Option::output(const std::string& fitting, OutputKind what) {
  output_kind = what;
  extensions = split(fitting, ' ');
  type_name = what == OutputKind::folder ? "OUT/" : "OUT";
  return this;
}

const std::string& Option::name() const {
  for (const Name& one : names) {
    if (one.text.starts_with("--")) return one.text;
  }
  return names.empty() ? argument : names.front().text;
}

std::vector<std::string> Option::shown_names() const {
  std::vector<std::string> all;
  for (const Name& one : names) {
    if (!one.hidden) all.push_back(one.text);
  }
  return all;
}

std::string Option::type_text() const {
  std::string text = type_name;
  if (!range.empty()) text += ":" + range;
  if (!choices.empty()) text += ":{" + joined(choices, ",") + "}";
  return text;
}

std::string Option::value_text() const {
  if (variable.is_flag()) return {};
  std::string text = shown;
  if (shown.empty()) {
    text = type_text() + (preset.empty() ? "" : "=" + preset);
    if (variable.is_list() && !is_one_at_a_time && most == 0) text += " ...";
  }
  return text + (is_required ? " REQUIRED" : "");
}

std::string Option::problem_with(const std::string& text) const {
  if (!range.empty()) {
    const char* const what = range == ">0"    ? "a number above 0"
                             : range == ">=0" ? "a number of 0 or more"
                                              : "";
    if (std::string wrong = problem_of_number(text, low, high, what); !wrong.empty()) return wrong;
  }
  const bool chosen = std::find(choices.begin(), choices.end(), text) != choices.end();
  if (!choices.empty() && !chosen) return text + " not in {" + joined(choices, ",") + "}";
  return problem == nullptr ? std::string() : problem(text);
}

OptionTable::OptionTable(const char* called, const char* does, std::string ends_with)
    : name(called), summary(does), footer(std::move(ends_with)) {
  add("-h,--help", {}, "Print this help and exit");
}

OptionTable::~OptionTable() = default;

OptionTable::OptionTable(OptionTable&&) noexcept = default;

Option* OptionTable::add(const char* names, Variable variable, const char* help) {
  options.push_back(std::make_unique<Option>(names, variable, help));
  return options.back().get();
}

const Option* OptionTable::find(const std::string& wanted) const {
  for (const std::unique_ptr<Option>& option : options) {
    for (const Option::Name& one : option->names) {
      if (one.text == wanted) return option.get();
    }
  }
  return nullptr;
}

Option* OptionTable::get(const char* wanted) const {
  const Option* option = find(wanted);
  if (option == nullptr) throw std::logic_error(name + " has no option " + wanted);
  return const_cast<Option*>(option);
}

std::vector<const Option*> OptionTable::named() const {
  std::vector<const Option*> list;
  for (const std::unique_ptr<Option>& option : options) {
    if (!option->names.empty()) list.push_back(option.get());
  }
  return list;
}

std::vector<const Option*> OptionTable::arguments() const {
  std::vector<const Option*> list;
  for (const std::unique_ptr<Option>& option : options) {
    if (!option->argument.empty()) list.push_back(option.get());
  }
  return list;
}

void OptionTable::show_in_help_all(const char* title, const char* names) {
  rest_title = title;
  add("--help-all", {}, "Print all options, also those that are rarely needed");
  std::rotate(options.begin() + 1, options.end() - 1, options.end());
  for (const std::string& one : split(names, ' ')) get(one.c_str())->in_group(title);
}

}  // namespace animeme::tools

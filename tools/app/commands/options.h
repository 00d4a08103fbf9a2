/// @file
/// The options of a command as data. A command fills an OptionTable; the command line is parsed by
/// it (parse_line.h), and help, man pages, completions and suggestions are made from it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// The variable that an option sets. It lives at least as long as the table. A bool makes the
/// option a flag, which takes no value; a vector takes several values. None: the parser itself
/// handles the flag (--help, --version).
struct Variable {
  /// Its type.
  enum class Kind : unsigned char {
    none,
    flag,
    optional_flag,
    integer,
    whole,
    long_integer,
    long_whole,
    number,
    text,
    optional_integer,
    optional_whole,
    optional_number,
    optional_text,
    parsed,
    texts,
    numbers,
  };
  /// Reads a text into a variable; returns a sentence about what is wrong, or an empty string.
  using Parse = std::string (*)(const std::string& text, void* into);

  Variable() = default;
  /// @{
  /// A variable of this type, or one of any type with the function that reads it.
  Variable(bool& v) : address(&v), kind(Kind::flag) {}
  Variable(std::optional<bool>& v) : address(&v), kind(Kind::optional_flag) {}
  Variable(int& v) : address(&v), kind(Kind::integer) {}
  Variable(unsigned& v) : address(&v), kind(Kind::whole) {}
  Variable(std::int64_t& v) : address(&v), kind(Kind::long_integer) {}
  Variable(std::uint64_t& v) : address(&v), kind(Kind::long_whole) {}
  Variable(double& v) : address(&v), kind(Kind::number) {}
  Variable(std::string& v) : address(&v), kind(Kind::text) {}
  Variable(std::optional<int>& v) : address(&v), kind(Kind::optional_integer) {}
  Variable(std::optional<std::uint64_t>& v) : address(&v), kind(Kind::optional_whole) {}
  Variable(std::optional<double>& v) : address(&v), kind(Kind::optional_number) {}
  Variable(std::optional<std::string>& v) : address(&v), kind(Kind::optional_text) {}
  Variable(Parse by, void* into) : address(into), parse(by), kind(Kind::parsed) {}
  Variable(std::vector<std::string>& v) : address(&v), kind(Kind::texts) {}
  Variable(std::vector<double>& v) : address(&v), kind(Kind::numbers) {}
  /// @}

  void* address = nullptr;  ///< of the variable
  Parse parse = nullptr;    ///< for Kind::parsed
  Kind kind = Kind::none;   ///< its type

  /// The option takes no value.
  bool is_flag() const { return kind <= Kind::optional_flag; }
  /// The option takes several values.
  bool is_list() const { return kind >= Kind::texts; }
};

/// A variable of any type, with the function that reads it: `std::string by(text, T& into)`.
template <auto by, class T>
Variable parsed(T& into) {
  return {[](const std::string& text, void* v) { return by(text, *static_cast<T*>(v)); }, &into};
}

/// What an option that names an output may write.
enum class OutputKind : unsigned char {
  none,            ///< it is no output
  file,            ///< a file whose extension says what is written, no "-"
  file_or_dash,    ///< likewise, or "-" for standard output
  stream,          ///< also "-", devices, pipes and names without an extension
  folder,          ///< a folder, which is created if it does not exist
  file_or_folder,  ///< a stream, or a folder
};

/// Finds out whether a value is valid: returns a sentence about what is wrong, or an empty string.
using Problem = std::string (*)(const std::string& value);

/// One option, or one positional argument. Members that return the option set it up.
struct Option {
  /// As OptionTable::add().
  Option(const char* names, Variable variable, const char* help);

  Option* required();                          ///< The command does not run without it.
  Option* between(double low, double high);    ///< A number in this range; no NaN.
  Option* above_zero();                        ///< A number above 0, up to 1e9.
  Option* at_least_zero();                     ///< A number of 0 or more, up to 1e9.
  Option* one_of(const std::string& choices);  ///< One of these words, separated by blanks.
  Option* frame_rate();                        ///< Frames per second: 25, 29.97, 30000/1001.
  Option* picture_size();                      ///< 1280x720
  Option* check(Problem check);                ///< Any other check.
  Option* type(const char* name);              ///< What help calls the value: "RATE".
  Option* value(const char* text);             ///< Help prints this in place of type and default.
  Option* show_default();                      ///< Help prints the value that it has now.
  Option* at_commas();                         ///< "a,b" are two values.
  Option* one_at_a_time();                     ///< Each value of a list needs the option's name.
  Option* at_most(int values);                 ///< A list of at most so many values.
  Option* in_group(const char* title);         ///< Help lists it below this title.
  Option* needs(const char* option);           ///< Only together with the option of this name.
  Option* excludes(const char* options);       ///< Not with these, separated by blanks.
  Option* sets(bool& flag);                    ///< Is true once the option was given.
  /// It names a file that the command writes. `extensions`: those that fit, in lower case,
  /// separated by blanks (".fap .txt"); none: the command checks the name itself.
  Option* output(const std::string& extensions, OutputKind what = OutputKind::stream);

  /// "--output" of "-o,--output"; of an argument "input".
  const std::string& name() const;
  /// All names that help shows, as "-o", "--output"; empty for an argument.
  std::vector<std::string> shown_names() const;
  /// What help prints after the names: "INT:0..31=1 REQUIRED". Empty: a flag.
  std::string value_text() const;
  /// Of type_name, or what its variable is: "TEXT", "INT:0..31".
  std::string type_text() const;
  /// What is wrong with a value, as a sentence; empty: nothing.
  std::string problem_with(const std::string& text) const;
  /// It was on the command line.
  bool given() const { return !values.empty(); }

  /// A name as it is typed.
  struct Name {
    std::string text;      ///< "--idle-motion"
    bool negates = false;  ///< it clears the flag
    bool hidden = false;   ///< it works, but is not shown
  };
  std::vector<Name> names;            ///< with dashes
  std::string argument;               ///< name as an argument without dashes; empty: it is none
  Variable variable;                  ///< what it sets
  std::string help;                   ///< what it does
  std::string type_name;              ///< type()
  std::string shown;                  ///< value()
  std::string preset;                 ///< show_default()
  std::string group;                  ///< in_group()
  std::vector<std::string> choices;   ///< one_of()
  std::string range;                  ///< between() and others, as help prints it: ">0"
  double low = 0;                     ///< start of the range
  double high = 0;                    ///< end of the range
  Problem problem = nullptr;          ///< check()
  bool is_required = false;           ///< required()
  bool splits_at_commas = false;      ///< at_commas()
  bool is_one_at_a_time = false;      ///< one_at_a_time()
  int most = 0;                       ///< at_most(); 0: any number
  std::vector<std::string> needed;    ///< needs()
  std::vector<std::string> excluded;  ///< excludes()
  bool* was_given = nullptr;          ///< sets()
  OutputKind output_kind = OutputKind::none;  ///< output()
  std::vector<std::string> extensions;        ///< output()
  std::vector<std::string> values;            ///< on the command line that was parsed
};

/// The options of a command, or those of the program with all its commands.
struct OptionTable {
  /// `called`: name; `does`: summary; `ends_with`: footer.
  OptionTable(const char* called, const char* does, std::string ends_with);
  ~OptionTable();
  OptionTable(OptionTable&&) noexcept;  ///< options keep their addresses

  /// Adds an option. `names`: separated by commas. Without dashes ("input") it is a positional
  /// argument, "input,--input" is both. "!--no-x" clears a flag. A name after "." is not shown.
  Option* add(const char* names, Variable variable, const char* help);
  /// The option of this name, with dashes; there has to be one.
  Option* get(const char* called) const;
  /// The option of this name, or nullptr.
  const Option* find(const std::string& called) const;
  /// All options but positional arguments.
  std::vector<const Option*> named() const;
  /// Positional arguments.
  std::vector<const Option*> arguments() const;
  /// Was it on the command line?
  bool given(const char* called) const { return get(called)->given(); }
  /// Adds --help-all, which alone shows the options of these names (separated by blanks), below
  /// a title.
  void show_in_help_all(const char* title, const char* names);

  std::string name;                              ///< "speak"; of the program "animeme"
  std::string summary;                           ///< one line; of the program several
  std::string footer;                            ///< what help prints below the options
  std::string rest_title;                        ///< of show_in_help_all()
  std::vector<std::unique_ptr<Option>> options;  ///< in the order of help
  std::vector<OptionTable> commands;             ///< of the program
};

/// What is wrong with a text as a number in a range, as a sentence. `what`: what the range is
/// called; empty: by its ends.
std::string problem_of_number(const std::string& text, double low, double high,
                              const std::string& what = {});

/// What a reader finds wrong with a text, for Option::check(): its message.
template <auto read>
std::string problem_of(const std::string& text) {
  const auto value = read(text);
  return value ? std::string() : value.error().message;
}

}  // namespace animeme::tools

/// @file
/// JSON values: building, printing and parsing. Only json.cpp includes nlohmann_json, whose
/// templates take seconds to compile.
///
///     Json json = {{"frames", 25}, {"names", names}};     // a list of pairs is an object
///     json["rate"] = "25";
///     std::puts(pretty(json).c_str());
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// A container that converts to an array: std::vector, std::array, std::span, std::set ...
template <class List>
concept JsonList =
    !std::same_as<typename List::value_type, List> &&
    !std::convertible_to<const List&, std::string_view> && requires(const List& list) {
  list.begin();
};

/// null, a boolean, a number, a string, an array or an object. An object keeps its members in the
/// order of insertion, and its names are unique. Strings are UTF-8; invalid bytes become U+FFFD in
/// the output. NaN and infinity become null in the output.
class Json {
 public:
  struct Member;  ///< a name and a value of an object

  Json() noexcept = default;  ///< null
  /// @{
  /// A value of the type that the argument has.
  Json(std::nullptr_t) noexcept {}
  Json(bool value) noexcept;
  Json(int value) noexcept : Json(static_cast<long long>(value)) {}
  Json(unsigned value) noexcept : Json(static_cast<unsigned long long>(value)) {}
  Json(long value) noexcept : Json(static_cast<long long>(value)) {}
  Json(unsigned long value) noexcept : Json(static_cast<unsigned long long>(value)) {}
  Json(long long value) noexcept;
  Json(unsigned long long value) noexcept;
  Json(double value) noexcept;
  Json(const char* text);
  Json(std::string text);
  Json(std::string_view text);
  /// @}
  template <class T>
  Json(const T* pointer) = delete;  // it would be a bool
  /// An object if every element is a pair of a string and a value; an array otherwise.
  Json(std::initializer_list<Json> list);
  /// An array of the elements of a container.
  template <JsonList List>
  Json(const List& list) : Json(array()) {
    for (const auto& one : list) push_back(one);
  }
  Json(const Json& other);  ///< a deep copy
  /// Leaves null behind.
  Json(Json&& other) noexcept : kind_(other.kind_), payload_(other.payload_) {
    other.kind_ = Kind::null;
  }
  Json& operator=(Json other) noexcept;
  ~Json();

  static Json array(std::initializer_list<Json> list = {});  ///< an array, also of pairs
  static Json object();                                      ///< an empty object

  /// Settings of parse(). A lookup in a sorted object takes logarithmic time.
  struct Reading {
    bool sorted = false;             ///< sort members by name instead of keeping the text's order
    std::size_t deepest = 1U << 30;  ///< maximum nesting of arrays and objects
  };
  /// Parses a text. The last member of a repeated name counts. Errors: syntax (where.column is the
  /// offset of the byte, from 1), out_of_range (nested too deep).
  static Result<Json> parse(std::string_view text) { return parse(text, Reading()); }
  /// Likewise, with settings.
  static Result<Json> parse(std::string_view text, const Reading& reading);

  /// @{
  /// The kind of the value.
  bool is_null() const { return kind_ == Kind::null; }
  bool is_boolean() const { return kind_ == Kind::boolean; }
  bool is_number() const { return kind_ >= Kind::integer && kind_ <= Kind::real; }
  bool is_number_float() const { return kind_ == Kind::real; }  ///< with a decimal point
  bool is_number_integer() const { return is_number() && !is_number_float(); }
  bool is_number_unsigned() const;  ///< a non-negative integer
  bool is_string() const { return kind_ == Kind::text; }
  bool is_array() const { return kind_ == Kind::array; }
  bool is_object() const { return kind_ == Kind::object; }
  bool is_structured() const { return kind_ >= Kind::array; }  ///< an array or an object
  /// @}

  /// The value as bool, int, long, unsigned long, double, std::string or std::vector<std::string>.
  /// Converts between numbers; throws std::runtime_error for a value of another kind.
  template <class T>
  T get() const;
  const std::string& text() const;  ///< a string without a copy
  /// Likewise, to be changed in place.
  std::string& text() { return const_cast<std::string&>(std::as_const(*this).text()); }

  std::size_t size() const;  ///< number of entries or members; null: 0, scalars: 1
  /// True if size() is 0.
  bool empty() const { return size() == 0; }

  /// The member `key`, which is added if missing; null becomes an object. The reference is valid
  /// until a member is added.
  Json& operator[](std::string_view key);
  const Json& operator[](std::string_view key) const;  ///< null if missing
  const Json* find(std::string_view key) const;        ///< nullptr if missing
  /// True if there is a member of that name.
  bool contains(std::string_view key) const { return find(key) != nullptr; }
  std::span<const Member> items() const;  ///< members of an object; empty for other values
  Json erase(std::string_view key);       ///< returns the removed member; null if missing
  void update(const Json& object);        ///< adds or replaces its members; null becomes an object
  void sort();  ///< sorts the members of all objects by name and keeps them sorted

  /// An entry of an array, from 0; undefined beyond its end.
  Json& operator[](std::size_t index);
  const Json& operator[](std::size_t index) const;
  /// @{
  /// The first and the last entry, and the entries of an array; begin() equals end() for other
  /// values.
  Json& front() { return (*this)[std::size_t(0)]; }
  const Json& front() const { return (*this)[std::size_t(0)]; }
  Json& back() { return (*this)[size() - 1]; }
  const Json& back() const { return (*this)[size() - 1]; }
  const Json* begin() const;
  const Json* end() const;
  Json* begin() { return const_cast<Json*>(std::as_const(*this).begin()); }
  Json* end() { return const_cast<Json*>(std::as_const(*this).end()); }
  /// @}
  void push_back(Json value);  ///< null becomes an array

  /// Formats the value: `indent` spaces a level, or a single line without spaces (-1). `ascii`
  /// writes other characters as escapes of four digits.
  std::string dump(int indent = -1, bool ascii = false) const;

  /// Compares values: 1 equals 1.0, and the order of members matters.
  friend bool operator==(const Json& a, const Json& b);

 private:
  enum class Kind : std::uint8_t { null, boolean, integer, natural, real, text, array, object };
  struct Object;
  union Payload {
    bool boolean;
    std::int64_t integer;
    std::uint64_t natural;
    double real;
    std::string* text;
    std::vector<Json>* array;
    Object* object;
  };
  friend struct JsonBuilder;

  void write(std::string& out, int indent, bool ascii, int level) const;
  Object& make_object();

  mutable Kind kind_ = Kind::null;  // lists in braces are const, and what they hold is moved
  Payload payload_{};
};

/// A member of an object.
struct Json::Member {
  std::string key;  ///< its name
  Json value;       ///< its value
};

/// @cond
template <>
bool Json::get() const;
template <>
int Json::get() const;
template <>
long Json::get() const;
template <>
unsigned long Json::get() const;
template <>
double Json::get() const;
template <>
std::string Json::get() const;
template <>
std::vector<std::string> Json::get() const;
/// @endcond

/// An array with the result of `entry`, a function or a member, for each element of a list.
template <class List, class Entry>
Json json_list(const List& list, Entry entry) {
  Json json = Json::array();
  for (const auto& one : list) json.push_back(std::invoke(entry, one));
  return json;
}

/// Formats JSON with an indentation of two.
inline std::string pretty(const Json& json) { return json.dump(2); }

}  // namespace animeme::tools

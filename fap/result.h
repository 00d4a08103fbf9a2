/// @file
/// Result<T>: the one way in which Animeme reports failure.
///
/// Every function that can fail returns a Result. It holds either a value or an Error: a code for
/// programs, a message for people, and the position in the input. No exception leaves the libraries
/// and no input makes them abort.
///
///     animeme::Result<animeme::fap::Sequence> clip = animeme::fap::read_text(text);
///     if (!clip) return clip.error();          // an Error converts to any Result
///     use(*clip);
///
/// The member names are those of std::expected (C++23), which may replace this class later.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

/// Animeme: MPEG-4 facial animation.
namespace animeme {

/// Kind of failure, for programs that have to react to it.
enum class Code : std::uint8_t {
  invalid_argument,  ///< a setting or parameter is outside its documented range
  syntax,            ///< the input breaks the grammar of its format
  out_of_range,      ///< the input is well formed but a value cannot be represented
  truncated,         ///< the input ends before it is complete
  need_data,         ///< not a failure: a push decoder has consumed all its input
  end_of_stream,     ///< not a failure: nothing comes after this
  unsupported,       ///< legal input that this build or version does not handle
  not_found,         ///< a file, a track, a phone or a column does not exist
  io,                ///< the operating system refused to read or write
  internal,          ///< a bug in Animeme; please report it
};

/// Position of an error in the input. Fields that do not apply keep their default.
struct Position {
  std::string file;         ///< path as the caller gave it; empty: unknown or memory
  std::int64_t line = 0;    ///< 1 is the first line; 0: not a text position
  std::int64_t column = 0;  ///< 1 is the first byte of the line; 0: whole line
  std::int64_t bit = -1;    ///< bits from the start of the stream; -1: not a bit position
};

/// A failure. `message` is one sentence without a full stop that names the remedy if there is one.
struct Error {
  Code code = Code::internal;  ///< kind of failure
  std::string message;         ///< one sentence without a full stop
  Position where;              ///< file, line or bit, as far as known

  /// "file:line:column: message" or "file: bit N: message", as far as known.
  std::string describe() const {
    std::string text;
    if (!where.file.empty()) text += where.file + ":";
    if (where.line > 0) {
      if (text.empty()) text += "line ";
      text += std::to_string(where.line) + ":";
      if (where.column > 0) text += std::to_string(where.column) + ":";
    }
    if (!text.empty()) text += " ";
    if (where.bit >= 0) text += "bit " + std::to_string(where.bit) + ": ";
    return text + message;
  }

  /// The same error with the file name filled in, if there was none.
  Error in_file(std::string file) && {
    if (where.file.empty()) where.file = std::move(file);
    return std::move(*this);
  }
  /// The same, leaving this error unchanged.
  Error in_file(std::string file) const& { return Error(*this).in_file(std::move(file)); }
};

/// Builds an Error without a position.
inline Error make_error(Code code, std::string message) { return {code, std::move(message), {}}; }

/// Builds an Error at a line (from 1) and column (from 1, 0: whole line) of a text.
inline Error error_at_line(Code code, std::string message, std::int64_t line,
                           std::int64_t column = 0) {
  return {code, std::move(message), {{}, line, column, -1}};
}

/// Builds an Error at a bit (from 0) of a stream.
inline Error error_at_bit(Code code, std::string message, std::int64_t bit) {
  return {code, std::move(message), {{}, 0, 0, bit}};
}

/// A value of type T or an Error. Calling value() without one is a programming error and throws
/// std::bad_variant_access (undefined for operator*), so test first.
template <class T>
class [[nodiscard]] Result {
 public:
  /// A value.
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}  // NOLINT: implicit
  /// A failure.
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit

  bool has_value() const { return state_.index() == 0; }  ///< true: value() may be called
  explicit operator bool() const { return has_value(); }  ///< has_value()

  /// The value; throws std::bad_variant_access if there is none.
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }    ///< the value, likewise
  T&& value() && { return std::get<0>(std::move(state_)); }  ///< the value, moved out, likewise
  T& operator*() & { return *std::get_if<0>(&state_); }
  const T& operator*() const& { return *std::get_if<0>(&state_); }
  T&& operator*() && { return std::move(*std::get_if<0>(&state_)); }
  T* operator->() { return std::get_if<0>(&state_); }
  const T* operator->() const { return std::get_if<0>(&state_); }

  /// The error; throws std::bad_variant_access if there is none.
  Error& error() & { return std::get<1>(state_); }
  const Error& error() const& { return std::get<1>(state_); }    ///< the error, likewise
  Error&& error() && { return std::get<1>(std::move(state_)); }  ///< the error, moved out, likewise

 private:
  std::variant<T, Error> state_;
};

/// Success without a value: `return {};`.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  /// A failure.
  Result(Error error) : error_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit

  bool has_value() const { return error_.index() == 0; }  ///< true: success
  explicit operator bool() const { return has_value(); }  ///< has_value()
  /// The error; throws std::bad_variant_access if there is none.
  Error& error() & { return std::get<1>(error_); }
  const Error& error() const& { return std::get<1>(error_); }    ///< the error, likewise
  Error&& error() && { return std::get<1>(std::move(error_)); }  ///< the error, moved out, likewise

 private:
  std::variant<std::monostate, Error> error_;
};

}  // namespace animeme

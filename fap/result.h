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

#include <concepts>
#include <cstdint>
#include <cstdlib>
#include <memory>
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

namespace internal {
/// @cond internal
// Out of line: every caller of a function that can fail would have its own copy of these, which was
// a fifth of the time to compile the programs.
#if defined(__GNUC__)
#define ANIMEME_OUT_OF_LINE [[gnu::noinline]]
#else
#define ANIMEME_OUT_OF_LINE
#endif
ANIMEME_OUT_OF_LINE inline void destroy(Error& error) noexcept { std::destroy_at(&error); }
ANIMEME_OUT_OF_LINE inline void move_to(Error* place, Error&& error) noexcept {
  std::construct_at(place, std::move(error));
}
ANIMEME_OUT_OF_LINE inline void copy_to(Error* place, const Error& error) {
  std::construct_at(place, error);
}
[[noreturn]] ANIMEME_OUT_OF_LINE inline void throw_bad_access() {
#ifdef __cpp_exceptions
  throw std::bad_variant_access();
#else
  std::abort();
#endif
}
#undef ANIMEME_OUT_OF_LINE
/// @endcond
}  // namespace internal

/// A value of type T or an Error. Calling value() without one is a programming error and throws
/// std::bad_variant_access (undefined for operator*), so test first. Copyable and movable as T is.
template <class T>
class [[nodiscard]] Result {
 public:
  /// A value.
  Result(T value) : has_value_(true), value_(std::move(value)) {}  // NOLINT: implicit
  /// A failure.
  Result(Error&& error) : has_value_(false), none_() {  // NOLINT: implicit
    internal::move_to(&error_, std::move(error));
  }
  /// A failure, likewise.
  Result(const Error& error) : has_value_(false), none_() {  // NOLINT: implicit
    internal::copy_to(&error_, error);
  }
  /// Moves.
  Result(Result&& other) noexcept : has_value_(other.has_value_), none_() {
    take(std::move(other));
  }
  /// Copies, where T can be copied.
  Result(const Result& other) requires std::copy_constructible<T> : has_value_(other.has_value_),
                                                                    none_() {
    if (has_value_) {
      std::construct_at(&value_, other.value_);
    } else {
      internal::copy_to(&error_, other.error_);
    }
  }
  Result& operator=(Result other) noexcept {  ///< copies or moves
    destroy();
    has_value_ = other.has_value_;
    take(std::move(other));
    return *this;
  }
  ~Result() { destroy(); }

  bool has_value() const { return has_value_; }           ///< true: value() may be called
  explicit operator bool() const { return has_value(); }  ///< has_value()

  /// The value; throws std::bad_variant_access if there is none.
  T& value() & {
    if (!has_value_) internal::throw_bad_access();
    return value_;
  }
  const T& value() const& { return const_cast<Result*>(this)->value(); }  ///< the value, likewise
  T&& value() && { return std::move(value()); }  ///< the value, moved out, likewise
  T& operator*() & { return value_; }
  const T& operator*() const& { return value_; }
  T&& operator*() && { return std::move(value_); }
  T* operator->() { return &value_; }
  const T* operator->() const { return &value_; }

  /// The error; throws std::bad_variant_access if there is none.
  Error& error() & {
    if (has_value_) internal::throw_bad_access();
    return error_;
  }
  const Error& error() const& {
    return const_cast<Result*>(this)->error();
  }                                                  ///< the error, likewise
  Error&& error() && { return std::move(error()); }  ///< the error, moved out, likewise

 private:
  void take(Result&& other) noexcept {
    if (has_value_) {
      std::construct_at(&value_, std::move(other.value_));
    } else {
      internal::move_to(&error_, std::move(other.error_));
    }
  }
  void destroy() noexcept {
    if (has_value_) {
      std::destroy_at(&value_);
    } else {
      internal::destroy(error_);
    }
  }

  bool has_value_;
  union {
    char none_;  // while neither has been made
    T value_;
    Error error_;
  };
};

/// Success without a value: `return {};`.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() : failed_(false), none_() {}
  /// A failure.
  Result(Error&& error) : failed_(true), none_() {  // NOLINT: implicit
    internal::move_to(&error_, std::move(error));
  }
  /// A failure, likewise.
  Result(const Error& error) : failed_(true), none_() {  // NOLINT: implicit
    internal::copy_to(&error_, error);
  }
  Result(Result&& other) noexcept : failed_(other.failed_), none_() {  ///< moves
    if (failed_) internal::move_to(&error_, std::move(other.error_));
  }
  Result(const Result& other) : failed_(other.failed_), none_() {  ///< copies
    if (failed_) internal::copy_to(&error_, other.error_);
  }
  Result& operator=(Result other) noexcept {  ///< copies or moves
    if (failed_) internal::destroy(error_);
    failed_ = other.failed_;
    if (failed_) internal::move_to(&error_, std::move(other.error_));
    return *this;
  }
  ~Result() {
    if (failed_) internal::destroy(error_);
  }

  bool has_value() const { return !failed_; }             ///< true: success
  explicit operator bool() const { return has_value(); }  ///< has_value()
  /// The error; throws std::bad_variant_access if there is none.
  Error& error() & {
    if (!failed_) internal::throw_bad_access();
    return error_;
  }
  const Error& error() const& {
    return const_cast<Result*>(this)->error();
  }                                                  ///< the error, likewise
  Error&& error() && { return std::move(error()); }  ///< the error, moved out, likewise

 private:
  bool failed_;
  union {
    char none_;  // while there is no error
    Error error_;
  };
};

}  // namespace animeme

/// @file
/// Work with a library that may end the process, as pocketsphinx does without memory: in a forked
/// child, so that only the child ends. Internal.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>

#include "fap/result.h"

namespace animeme::voice {

/// Takes how far the work is, 0..1.
using Told = std::function<void(double)>;

/// Runs `work` in a child and returns its bytes, or its error. `what` names the library. What the
/// work tells goes to `told`, which may be empty.
///
/// Errors: those of `work`; io (the child cannot be started, the library ended it, there is no
/// memory, it took more than `seconds`).
Result<std::string> run_guarded(std::string_view what, unsigned seconds,
                                const std::function<Result<std::string>(const Told& tell)>& work,
                                const Told& told = {});

/// Values as bytes, in the byte order of the machine.
class Packed {
 public:
  /// Appends a number.
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  /// Appends a text.
  void put_text(std::string_view text) {
    put(text.size());
    bytes_ += text;
  }
  std::string take() { return std::move(bytes_); }  ///< all of them

 private:
  std::string bytes_;
};

/// The same, read. What is missing is zero or empty, and good() false.
class Unpacked {
 public:
  explicit Unpacked(std::string_view bytes) : rest_(bytes) {}  ///< `bytes` is borrowed
  /// The next number.
  template <class T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    good_ = good_ && rest_.size() >= sizeof value;
    if (!good_) return value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  /// The next text.
  std::string get_text() {
    const auto size = get<std::size_t>();
    good_ = good_ && size <= rest_.size();
    if (!good_) return {};
    std::string text(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return text;
  }
  /// How many follow, of which each has `least` bytes or more.
  std::size_t get_count(std::size_t least) {
    const auto count = get<std::size_t>();
    good_ = good_ && count <= rest_.size() / least;
    return good_ ? count : 0;
  }
  bool good() const { return good_; }  ///< nothing was missing

 private:
  std::string_view rest_;
  bool good_ = true;
};

}  // namespace animeme::voice

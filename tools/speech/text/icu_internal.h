// ICU's C interface, which is kept stable from version to version, made safe. Inside of the files
// that use it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace animeme::text {

/// ICU's objects have a function each that closes them.
template <auto Close>
struct Closer {
  template <class T>
  void operator()(T* object) const {
    Close(object);
  }
};
template <class T, auto Close>
using Owned = std::unique_ptr<T, Closer<Close>>;

std::string utf8_of(const char16_t* text, std::int32_t length);
std::u16string utf16_of(std::string_view text);

/// What a function writes into a buffer of fixed size; what does not fit is nothing. Status is
/// UErrorCode, which the files that use this include: failures are above 0.
template <class Status, class Write>
std::string written(Write write) {
  std::array<char16_t, 400> buffer{};
  Status status{};
  const std::int32_t length = write(buffer.data(), std::int32_t(buffer.size()), &status);
  if (status > 0 || length < 0 || length > std::int32_t(buffer.size())) return {};
  return utf8_of(buffer.data(), length);
}

/// The locale of a tag or of a code of espeak-ng.
std::string locale_of(std::string_view language);

/// ICU answers for any locale, by its root data if there are no others: false for those.
bool has_locale(const std::string& locale);

}  // namespace animeme::text

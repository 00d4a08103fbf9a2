// ICU's C interface, which is kept stable from version to version, made safe. Inside of the files
// that use it.
#pragma once

#include <unicode/utypes.h>

#include <array>
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

std::string utf8_of(const UChar* text, std::int32_t length);
std::u16string utf16_of(std::string_view text);

/// What a function writes into a buffer of fixed size; what does not fit is nothing.
template <class Write>
std::string written(Write write) {
  std::array<UChar, 400> buffer{};
  UErrorCode status = U_ZERO_ERROR;
  const std::int32_t length = write(buffer.data(), std::int32_t(buffer.size()), &status);
  if (U_FAILURE(status) || length < 0 || length > std::int32_t(buffer.size())) return {};
  return utf8_of(buffer.data(), length);
}

/// The locale of a tag or of a code of espeak-ng.
std::string locale_of(std::string_view language);

/// ICU answers for any locale, by its root data if there are no others: false for those.
bool has_locale(const std::string& locale);

}  // namespace animeme::text

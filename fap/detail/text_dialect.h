// What differs between FAP text and body animation text (BAP); the grammar is the same. Internal.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace animeme::fap::detail {

struct TextDialect {
  std::string_view format;                  ///< for messages, "FAP text"
  std::string_view parameter;               ///< for messages, "FAP"
  std::string_view known_as;                ///< how another version is read, "2.1"
  std::span<const std::string_view> known;  ///< versions that need no warning
  std::string_view other_format;            ///< what is taken for this by mistake
  std::span<const std::string_view> other;  ///< its versions
  int flags = 68;                           ///< mask values of a frame

  static bool has(std::span<const std::string_view> versions, std::string_view version) {
    return std::find(versions.begin(), versions.end(), version) != versions.end();
  }
};

inline constexpr std::string_view kFapVersions[] = {"2.0", "2.1", "2.2"};
inline constexpr std::string_view kBapVersions[] = {"3.1", "3.2"};

inline constexpr TextDialect kFapDialect = {
    "FAP text", "FAP", "2.1", kFapVersions, "body animation text (BAP)", kBapVersions, 68};

}  // namespace animeme::fap::detail

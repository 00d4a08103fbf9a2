/// @file
/// Three-letter codes of languages that have two of them in ISO 639-2.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace animeme::media {

/// The terminological code and the bibliographic one, which Matroska has and users of FFmpeg know.
inline constexpr std::array<std::string_view, 20> kBothLanguageCodes = {
    "sqialb", "hyearm", "eusbaq", "myabur", "zhochi", "cescze", "nlddut",
    "frafre", "katgeo", "deuger", "ellgre", "islice", "mkdmac", "mrimao",
    "msamay", "fasper", "ronrum", "slkslo", "bodtib", "cymwel"};

/// "ger" for "deu"; a code without another one as it is.
inline std::string bibliographic_code(std::string_view code) {
  for (const std::string_view both : kBothLanguageCodes) {
    if (both.substr(0, 3) == code) return std::string(both.substr(3));
  }
  return std::string(code);
}

/// "deu" for "ger"; a code without another one as it is.
inline std::string terminological_code(std::string_view code) {
  for (const std::string_view both : kBothLanguageCodes) {
    if (both.substr(3) == code) return std::string(both.substr(0, 3));
  }
  return std::string(code);
}

}  // namespace animeme::media

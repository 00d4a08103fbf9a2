/// @file
/// Helpers for writing XML, SVG and HTML.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace animeme::tools {

/// Escapes text for an element, or for an attribute in quotes of either kind.
inline std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&apos;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Formats a coordinate or a length of a drawing: "12.5".
inline std::string drawn(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

}  // namespace animeme::tools

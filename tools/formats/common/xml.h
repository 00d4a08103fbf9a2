/// @file
/// Small texts of XML, SVG and HTML.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace animeme::tools {

/// Text as the content of an element, or of an attribute in quotes of either kind. (fap/xml has its
/// own, xml_escaped(): it must not use the tools, and keeps the line ends of attributes.)
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

/// A place or a length in a drawing: "12.5".
inline std::string drawn(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

}  // namespace animeme::tools

// XML as a tree of plain values. All of libxml2 is behind this header.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::head::detail {

struct XmlElement {
  struct Attribute {
    std::string name;
    std::string value;
  };
  std::string name;  ///< without a namespace prefix
  std::vector<Attribute> attributes;
  std::vector<XmlElement> children;
  std::string text;       ///< all text directly within, in one
  std::int64_t line = 0;  ///< where its start tag ends

  /// The value of an attribute; nothing if it is not there.
  const std::string* attribute(std::string_view wanted) const;
  /// The first child of a name; nothing if there is none.
  const XmlElement* child(std::string_view wanted) const;
  /// An error at this element: line, no column.
  Error error(Code code, std::string message) const;
};

/// Parses a document and returns its root.
///
/// What is refused, whatever libxml2 would do with it: document types with declarations (entities
/// could multiply the text, or name files), more than 200 MB, a million elements, 1000
/// attributes of one, or 100 levels.
/// Nothing outside the text is read. Predefined entities and character references are resolved.
/// Errors: syntax with line and column, out_of_range for the limits, unsupported (declarations, or
/// an encoding that libxml2 does not know).
Result<XmlElement> parse_xml(std::string_view text);

}  // namespace animeme::head::detail

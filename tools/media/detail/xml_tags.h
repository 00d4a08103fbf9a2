// The tags of a small XML document, one after the other: no entities but the five, no DTD.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

struct XmlTag {
  std::string name;    ///< without a namespace prefix
  bool begins = true;  ///< <name ...>
  bool ends = false;   ///< </name> or <name .../>
  std::int64_t line = 0;
  std::string text;  ///< what stands between this tag and the next
  std::vector<std::pair<std::string, std::string>> attributes;

  const std::string* find(std::string_view attribute) const {
    for (const auto& [key, value] : attributes) {
      if (key == attribute) return &value;
    }
    return nullptr;
  }
};

/// All tags in order; comments and processing instructions are left out. Tags are not checked to
/// match. Errors: syntax (line), unsupported (a DTD, CDATA), out_of_range (over a million tags).
Result<std::vector<XmlTag>> read_tags(std::string_view xml);

}  // namespace animeme::media

#include "fap/xml/detail/document.h"

namespace animeme::head::detail {

const std::string* XmlElement::attribute(std::string_view wanted) const {
  for (const Attribute& a : attributes) {
    if (a.name == wanted) return &a.value;
  }
  return nullptr;
}

const XmlElement* XmlElement::child(std::string_view wanted) const {
  for (const XmlElement& c : children) {
    if (c.name == wanted) return &c;
  }
  return nullptr;
}

Error XmlElement::error(Code code, std::string message) const {
  return error_at_line(code, std::move(message), line);
}

}  // namespace animeme::head::detail

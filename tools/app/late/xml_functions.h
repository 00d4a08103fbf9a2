/// @file
/// What animeme_xml.so has: the parser of fap/xml, which is libxml2's.
#pragma once

#include "fap/xml/detail/document.h"

namespace animeme::head::detail {

struct XmlFunctions {
  decltype(&detail::parse_xml) parse_xml;
};

}  // namespace animeme::head::detail

#include "tools/app/late/xml_functions.h"
#include "tools/formats/common/module.h"

namespace animeme::head::detail {

Result<XmlElement> parse_xml(std::string_view text) {
  static const auto loaded = tools::load_functions<XmlFunctions>(tools::kXmlModule);
  if (!loaded) return loaded.error();
  return (*loaded)->parse_xml(text);
}

}  // namespace animeme::head::detail

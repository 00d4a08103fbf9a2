#include "tools/app/late/xml_functions.h"
#include "tools/formats/common/module.h"

namespace animeme::head::detail {
namespace {

constexpr XmlFunctions kTable = {parse_xml};

}  // namespace
}  // namespace animeme::head::detail

ANIMEME_MODULE(animeme::head::detail::kTable);

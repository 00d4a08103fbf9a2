// The sources of the page, packed into the program when it is built (pack.cmake).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace animeme::viewer::detail {

extern const std::string_view kTemplate;     ///< page.html with the marks that page.cpp replaces
extern const std::string_view kStyle;        ///< page.css
extern const std::string_view kHeadModules;  ///< the modules that draw a head
extern const std::string_view kPageModules;  ///< the others
extern const std::span<const std::uint8_t> kRigModule;  ///< rig/rig.wasm

}  // namespace animeme::viewer::detail

/// @file
/// The page at `/`, which lists the heads and shows one: the files of `page/`, made by the build.
#pragma once

#include <string_view>

namespace animeme::serve {

std::string_view index_page();    ///< page/index.html
std::string_view index_script();  ///< page/index.js
std::string_view index_style();   ///< page/index.css

}  // namespace animeme::serve

// The page that the server shows, put into the program by the build from the folder page.
#pragma once

#include <string_view>

namespace animeme::web {

std::string_view page_text();
std::string_view page_style();
std::string_view page_script();

/// What makes the page show a head; to follow viewer::head_script() in one module.
std::string_view head_glue();

}  // namespace animeme::web

// The page that the server shows, put into the program by the build from page.html.
#pragma once

#include <string_view>

namespace animeme::web {

std::string_view page_text();

}  // namespace animeme::web

// Names of languages for the menus of players.
#pragma once

#include <string>
#include <string_view>

namespace animeme::media {

/// A language as its speakers call it, by its tag: "Deutsch", "português (BR)". The tag itself if
/// the language is not in the table.
std::string autonym_of(std::string_view tag);

}  // namespace animeme::media

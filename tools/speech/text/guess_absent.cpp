// Stands in for guess_cld2.cpp where the library was not there at build time.
#include "tools/speech/text/guess.h"

namespace animeme::text {

bool can_guess() { return false; }
std::string guess_language(std::u32string_view) { return {}; }

}  // namespace animeme::text

// In place of guess_cld2.cpp: in the program, and where CLD2 was not there at build time.
#include "tools/speech/text/late_internal.h"

namespace animeme::text {

bool can_guess() { return late_text() && (*late_text())->can_guess(); }

std::string guess_language(std::u32string_view text) {
  return late_text() ? (*late_text())->guess_language(text) : std::string();
}

}  // namespace animeme::text

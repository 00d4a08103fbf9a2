/// @file
/// The text of a person or program as it is to be said or aligned.
#pragma once

#include <string>
#include <string_view>

#include "tools/formats/files/log.h"

namespace animeme::speech {

/// A text or transcript as UTF-8, without marks that name a sound, "(laughs)" or "[lacht]", as
/// dam::without_marks() finds them in prose. U+FFFD between letters becomes an apostrophe. Bytes
/// that are not UTF-8 in a text that is, and marks, are reported to log.warn. SSML, and any text
/// with `speak_marks`, keeps its marks.
std::string text_to_say(std::string_view bytes, bool speak_marks, const tools::Log& log = {});

/// text_to_say() of one line among others. A byte order mark of UTF-16 before a line that has no
/// zero byte is damage: it is left out and reported to log.warn.
std::string line_to_say(std::string_view line, bool speak_marks, const tools::Log& log = {});

/// The line without such a mark, as bytes.
std::string_view without_stray_mark(std::string_view line, const tools::Log& log = {});

}  // namespace animeme::speech

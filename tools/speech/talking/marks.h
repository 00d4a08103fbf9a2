/// @file
/// Scripts with SSML marks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {

/// dam::write_script() with marks: a TextGrid has a tier of points "marks" for them, WebVTT a
/// comment each ("NOTE mark 00:00:01.234 name"). Other formats do not support marks. Without marks
/// the bytes are those of dam::write_script().
std::string write_marked_script(const dam::Script& script,
                                const std::vector<voice::SpeechMark>& marks,
                                std::string_view ending);

}  // namespace animeme::speech

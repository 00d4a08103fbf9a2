// Abbreviations in seven languages. Inside of written.cpp and transcript_words.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/speech/text/amounts_internal.h"

namespace animeme::text {

/// What is said for the abbreviation that begins at `at`, where no letter or digit is before, by
/// what stands around it: "Dr." before a name is "Doctor", behind one "Drive". The full stop of one
/// that ends its sentence is kept. `end` is 0 if there is none, or none that is said so there.
Amount abbreviation_at(std::u32string_view text, std::size_t at, std::string_view base);

/// All that is said for a token, wherever it stands: "Dr." "doctor", "drive". Empty if none.
std::vector<std::u32string> meanings_of(std::u32string_view token, std::string_view base);

/// C#, F♯, B♭, C++ as people say them.
Amount sharp_at(std::u32string_view text, std::size_t at, std::string_view base);

}  // namespace animeme::text

// Names of bones and shapes as words: "mixamorig:LeftEye", "eye.L", "J_Adj_L_FaceEye".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::gltf {

/// Small letters, split at anything but letters and digits, and where a capital or a digit follows
/// a small letter ("Eye_Blink_L", "eyeBlinkLeft" -> eye blink left). A single l or r is left or
/// right. Bytes beyond ASCII are letters.
std::vector<std::string> words_of(std::string_view name);

/// Words from `first` on, without spaces.
std::string joined(const std::vector<std::string>& words, std::size_t first = 0);

/// "A, B, C and 9 more": at most `most` names, each cut at 60 bytes.
std::string list_of(const std::vector<std::string>& names, std::size_t most);

bool has_word(const std::vector<std::string>& words, std::string_view word);

}  // namespace animeme::gltf

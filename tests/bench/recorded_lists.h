// Recordings with what is said in them, as Debian's asterisk-core-sounds-LANGUAGE has them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace animeme::bench {

struct Recorded {
  std::filesystem::path file;
  std::string id, text;
};

// FOLDER/ID.g722 or .wav for the lines "ID: text" of a list; without lines of less than 60 bytes
// and those with brackets, which hold what is not said.
std::vector<Recorded> recorded_lines(const std::string& folder, const std::string& list);

}  // namespace animeme::bench

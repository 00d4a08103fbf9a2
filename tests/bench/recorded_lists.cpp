#include "tests/bench/recorded_lists.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "tests/support/files.h"

namespace animeme::bench {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastText = 60;  // bytes

}  // namespace

std::vector<Recorded> recorded_lines(const std::string& folder, const std::string& list) {
  std::istringstream in(test::slurp(list));
  std::vector<Recorded> lines;
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    if (line.starts_with(";") || colon == std::string::npos) continue;
    const std::size_t begin = std::min(line.find_first_not_of(' ', colon + 1), line.size());
    Recorded one{{}, line.substr(0, colon), line.substr(begin)};
    while (!one.text.empty() && std::isspace(static_cast<unsigned char>(one.text.back())) != 0) {
      one.text.pop_back();
    }
    if (one.text.size() < kLeastText || one.text.find_first_of("[<(") != std::string::npos) {
      continue;
    }
    one.file = fs::path(folder) / (one.id + ".g722");
    if (!fs::exists(one.file)) one.file.replace_extension(".wav");
    if (fs::exists(one.file)) lines.push_back(std::move(one));
  }
  return lines;
}

}  // namespace animeme::bench

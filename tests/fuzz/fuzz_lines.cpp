// Lines that come while somebody speaks: text for a voice (stream --say) and phones (follow). The
// first byte says in which pieces they come; the lines must not depend on it, and none is long.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/require.h"
#include "tools/speech/talking/line_cutter_internal.h"
#include "tools/speech/talking/phone_line.h"

using animeme::test::require;

namespace {

using namespace animeme;
using speech::LineCutter;

constexpr std::size_t kMost = 1000;  // bytes of a line

std::vector<std::string> cut(std::string_view text, std::size_t piece, bool long_ones) {
  LineCutter cutter(kMost, long_ones);
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, piece);
    text.remove_prefix(part.size());
    for (std::string& line : cutter.push(part)) lines.push_back(std::move(line));
  }
  lines.push_back(cutter.rest());
  return lines;
}

void check_phone(const std::string& line) {
  const auto phone = speech::parse_phone_line(line);
  if (!phone) return require(!phone.error().message.empty());
  if (!*phone) return;
  // NaN and infinity are no times.
  require((*phone)->start - (*phone)->start == 0 && (*phone)->end - (*phone)->end == 0);
  require(!(*phone)->label.empty());
  // Told once more, it is the same phone.
  const std::string again = std::to_string((*phone)->start) + "\t" + std::to_string((*phone)->end) +
                            " " + (*phone)->label + " # word";
  const auto back = speech::parse_phone_line(again);
  require(back && *back && (*back)->label == (*phone)->label);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  for (const bool long_ones : {true, false}) {
    const std::vector<std::string> lines = cut(text, std::size_t(data[0]) + 1, long_ones);
    for (const std::string& line : lines) {
      require(line.size() <= (long_ones ? kMost : kMost + 1));
      check_phone(line);
    }
    require(lines == cut(text, text.size() + 1, long_ones));
  }
  return 0;
}

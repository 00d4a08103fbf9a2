// Programs of others, and what they say.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>

#include "tests/formats/media/media_support.h"

/// Ends a test, visibly, when a program is not installed. `package` is what Debian calls it.
#define NEEDS_PROGRAM(program, package)                                      \
  if (!animeme::test::has_program(program))                                  \
  GTEST_SKIP() << program << " is not installed (Debian package " << package \
               << "; tools/setup.sh tests installs it)"

namespace animeme::test {

using Json = nlohmann::json;

/// The JSON that a command prints; null, and a failure of the test, if it prints none.
inline Json run_json(const std::string& command) {
  int status = 0;
  const std::string output = run(command + " 2>/dev/null", &status);
  Json json = Json::parse(output, nullptr, false);
  EXPECT_EQ(status, 0) << command;
  EXPECT_FALSE(json.is_discarded()) << command << "\nprinted\n" << output;
  return json.is_discarded() ? Json() : json;
}

/// A file of 32-bit floats of one channel.
inline media::Pcm read_floats(const std::string& path, int sample_rate) {
  const Bytes bytes = read_bytes(path);
  media::Pcm pcm{sample_rate, std::vector<float>(bytes.size() / sizeof(float))};
  std::memcpy(pcm.samples.data(), bytes.data(), pcm.samples.size() * sizeof(float));
  return pcm;
}

/// "4A" or "4a" for each byte, anything else is left out.
inline Bytes from_hex(std::string_view text) {
  Bytes out;
  int high = -1;
  for (const char c : text) {
    const std::size_t digit = std::string_view("0123456789abcdefABCDEF").find(c);
    if (digit == std::string_view::npos) continue;
    const int value = int(digit < 16 ? digit : digit - 6);
    if (high < 0) {
      high = value;
    } else {
      out.push_back(std::uint8_t(high << 4 | value));
      high = -1;
    }
  }
  return out;
}

/// The bytes of the dumps of ffprobe, "00000000: 0000 01ba 7f00  ......" lines.
inline Bytes from_dump(const std::string& dump) {
  Bytes out;
  std::istringstream lines(dump);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 10) continue;
    const Bytes part = from_hex(std::string_view(line).substr(10, 40));
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

}  // namespace animeme::test

// What the targets of a source do, and files with something changed in them.
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "fap/head/own_head.h"

namespace animeme::test {

/// How far a value of a FAP moves a vertex of a piece, in units of the file.
inline head::Vec3 moved(const head::Source& source, int fap, float value, std::uint32_t vertex,
                        std::size_t piece = 0) {
  head::Vec3 sum;
  for (const head::PieceTarget& target : source.targets) {
    if (target.control != fap || target.piece != piece) continue;
    const float units =
        std::clamp(value, target.low, target.high) - std::clamp(0.0f, target.low, target.high);
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
      if (target.vertices[k] == vertex) sum += target.deltas[k] * units;
    }
  }
  return sum;
}

inline void expect_near(head::Vec3 a, head::Vec3 b) {
  EXPECT_LT(length(a - b), 1e-5f * std::max(1.0f, length(b)))
      << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

/// A text with each `from` changed to `to`; a failure if there is none.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  for (std::size_t i = 0; (i = text.find(from, i)) != std::string::npos; i += to.size()) {
    text.replace(i, from.size(), to);
  }
  return text;
}

/// A change to a file, and the error that it has to give.
struct Damage {
  const char* from;
  const char* to;
  Code code;
  std::int64_t line;
  const char* message;
};

/// What came of a changed file: its error has the code, the line and a part of the sentence.
inline void expect_refused(const Result<head::Source>& read, const Damage& damage) {
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, damage.code) << read.error().describe();
  EXPECT_EQ(read.error().where.line, damage.line) << read.error().describe();
  EXPECT_THAT(read.error().message, ::testing::HasSubstr(damage.message));
}

}  // namespace animeme::test

// `animeme import` of captures that went wrong: tests/data/captures_broken, whose README is the
// table of what is said and done.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme {
namespace broken_captures_test {

using test::TempDir;
using testing::HasSubstr;

struct Case {
  std::string file, wrong, options, exit, says, off_by;
};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" `");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" `") - first + 1);
}

// The rows of the table of the README.
std::vector<Case> cases() {
  std::vector<Case> out;
  std::istringstream lines(test::data_file("captures_broken/README.md"));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    std::istringstream fields(line.substr(1));
    for (std::string cell; std::getline(fields, cell, '|');) cells.push_back(trimmed(cell));
    EXPECT_EQ(cells.size(), 6U) << line;
    if (cells.size() == 6) {
      out.push_back({cells[0], cells[1], cells[2], cells[3], cells[4], cells[5]});
    }
  }
  return out;
}

// Words of a line; "double quotes" keep blanks.
std::vector<std::string> words(const std::string& line) {
  std::vector<std::string> out;
  bool quoted = false;
  bool open = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ' ' && !quoted) {
      open = false;
    } else {
      if (!open) out.emplace_back();
      open = true;
      out.back() += c;
    }
  }
  return out;
}

// The largest difference of a FAP of the mouth: all that the face does.
double off_by(const fap::Sequence& a, const fap::Sequence& b) {
  EXPECT_EQ(a.frames.size(), b.frames.size());
  double most = 0;
  for (std::size_t i = 0; i < std::min(a.frames.size(), b.frames.size()); ++i) {
    for (int fap = 3; fap <= 13; ++fap) {
      const auto k = std::size_t(fap);
      if (!a.frames[i].mask[k] || !b.frames[i].mask[k]) continue;
      most = std::max(most, double(std::abs(a.frames[i].value[k] - b.frames[i].value[k])));
    }
  }
  return most;
}

TEST(BrokenCaptures, EachHasItsMessageOrItsRepair) {
  const TempDir dir;
  const std::filesystem::path folder = test::data_dir() / "captures_broken";
  const auto read = [&](const std::string& file, std::vector<std::string> more) {
    std::filesystem::remove(dir / "take.fap");
    std::vector<std::string> arguments = {"import", (folder / file).string(), "--smooth", "0",
                                          "-o",     dir / "take.fap"};
    for (std::string& word : more) {
      if (word == "whole.csv") word = (folder / word).string();
      arguments.push_back(std::move(word));
    }
    return test::animeme(arguments);
  };
  ASSERT_EQ(read("whole.csv", {}).exit_code, 0);
  const fap::Sequence whole = test::read_clip(dir / "take.fap");
  int moved = 0;
  for (const fap::Frame& frame : whole.frames) moved = std::max(moved, -frame.value[5]);
  EXPECT_GT(moved, 150) << "the face does not talk";

  std::set<std::string> files;
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.file + " " + one.options);
    files.insert(one.file);
    const auto result = read(one.file, words(one.options));
    EXPECT_EQ(std::to_string(result.exit_code), one.exit) << result.err;
    EXPECT_THAT(result.err, HasSubstr(one.says));
    EXPECT_EQ(std::filesystem::exists(dir / "take.fap"), one.exit == "0");
    if (one.off_by == "-" || result.exit_code != 0) continue;
    EXPECT_LE(off_by(test::read_clip(dir / "take.fap"), whole), std::stod(one.off_by));
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(files.contains(name) || name == "README.md" || name == "make.py") << name;
  }
  EXPECT_GT(files.size(), 30U);
}

}  // namespace broken_captures_test
}  // namespace animeme

// Figures in the documentation that the program prints the same everywhere: each stands beside its
// command in a page, and the command prints it again here. Timings are not among them:
// tests/bench/figures.sh prints those.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace figures_test {

namespace fs = std::filesystem;
using test::TempDir;

// The words of a page with one blank between them, so that a figure may stand at the end of a line.
std::string words_of(const std::string& page) {
  const std::string text = test::slurp(fs::path(test::kSourceFolder) / page);
  return std::regex_replace(text, std::regex("\\s+"), " ");
}

// What the groups of a pattern match in a text, all of which have to be there.
std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  std::smatch found;
  if (!std::regex_search(text, found, std::regex(pattern))) {
    ADD_FAILURE() << "nothing matches " << pattern << "\nin " << text.substr(0, 2000);
    return {};
  }
  return {found.begin() + 1, found.end()};
}

// What a run of the program says, on both channels.
std::string said(const std::vector<std::string>& arguments) {
  const auto result = test::animeme(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out + result.err;
}

// The sentence that tools/hello.sh speaks when it is given none.
std::string hello_sentence() {
  const std::string script = test::slurp(fs::path(test::kSourceFolder) / "tools/hello.sh");
  const auto found = matches(script, "text=\\$\\{1:-\"([^\"]+)\"\\}");
  return found.empty() ? std::string() : found[0];
}

std::string kilobits(const std::vector<std::string>& options) {
  const TempDir dir;
  std::vector<std::string> arguments{"speak", "--text", hello_sentence(), "-o", dir / "a.fba"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto result = test::animeme(arguments);
  if (result.err.find("built without") != std::string::npos) return {};
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto found = matches(result.out + result.err, "([0-9.]+) kbit/s");
  return found.empty() ? std::string() : found[0];
}

TEST(Figures, BitRatesOfTheCodecPage) {
  const std::string plain = kilobits({}), coarse = kilobits({"--rms", "2"});
  if (plain.empty()) GTEST_SKIP() << "built without voices (Debian: libespeak-ng-dev)";
  EXPECT_THAT(
      matches(words_of("codec/README.md"),
              "takes ([0-9.]+) kbit/s at `fap_quant` 1, ([0-9.]+) kbit/s with an error of 2"),
      testing::ElementsAre(plain, coarse));
}

TEST(Figures, ConformanceOfTheReadme) {
  const auto printed = matches(said({"check", std::string(test::kSourceFolder) + "/conformance"}),
                               "(\\d+) of (\\d+) cases right .*?(\\d+) of (\\d+) streams");
  EXPECT_EQ(matches(words_of("README.md"), "byte \\| (\\d+) of (\\d+); (\\d+) of (\\d+) \\|"),
            printed);
}

// The carriers of codec/standards.md are measured on takes that are not part of the project.
TEST(Figures, CarriersOfTheReadme) {
  const std::string page = words_of("codec/standards.md"), readme = words_of("README.md");
  const auto live =
      matches(page, "FBA, joins each second \\| quant 2 \\| ([0-9.]+) \\| ([0-9.]+) ");
  const auto link = matches(page, "Live Link Face, 61 values \\| \\| [0-9.]+ \\| ([0-9.]+) ");
  ASSERT_EQ(live.size(), 2u);
  ASSERT_EQ(link.size(), 1u);
  EXPECT_THAT(readme, testing::HasSubstr(link[0] + " kbit/s"));
  EXPECT_THAT(readme, testing::HasSubstr(live[1] + " kbit/s"));
}

// Errors of scripts of other programs, as dam/script/phoneme_scripts.md has measured them.
TEST(Figures, ErrorsOfOtherScripts) {
  const std::string page = words_of("dam/script/phoneme_scripts.md"),
                    readme = words_of("README.md");
  for (const char* row :
       {"\\| phones \\| ([0-9.]+) \\|", "\\| Azure's 22 visemes \\| ([0-9.]+) \\|",
        "\\| Rhubarb's 9 mouths \\| ([0-9.]+) \\|"}) {
    const auto found = matches(page, row);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_THAT(readme, testing::HasSubstr(found[0] + " from")) << row;
  }
}

}  // namespace figures_test
}  // namespace animeme

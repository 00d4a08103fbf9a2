// Whoever reads "codec/bitstream.md, section 4" in a comment or a README finds that section. Within
// a page "section 4" is its own; sections of RFCs, ISO standards and titled papers are theirs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/structure/tree.h"

namespace animeme::test {
namespace citations_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Numbered headings of pages, by path.
using Sections = std::map<std::string, std::set<std::string>, std::less<>>;

std::set<std::string> sections_of(const std::string& page) {
  static const std::regex heading(R"((?:^|\n)#+ ([0-9.]*[0-9]) )");
  std::set<std::string> out;
  for (std::sregex_iterator at(page.begin(), page.end(), heading), end; at != end; ++at) {
    out.insert((*at)[1]);
  }
  return out;
}

/// A file as running text: without line ends, marks of comments and code quotes.
struct Running {
  std::string text;
  std::vector<int> line;  ///< of each character
};

Running running(std::string_view file) {
  Running out;
  const auto put = [&](char c, int line) {
    if (c == '`' || (c == ' ' && (out.text.empty() || out.text.back() == ' '))) return;
    out.text += c;
    out.line.push_back(line);
  };
  int line = 1;
  bool begins = true;
  for (const char c : file) {
    if (c == '\n') {
      put(' ', line++);
      begins = true;
    } else if (!begins || !std::strchr(" \t/<", c)) {
      put(c == '\t' ? ' ' : c, line);
      begins = false;
    }
  }
  return out;
}

// Which page is meant by what stands in front of "section 4"; nothing: a work of others.
std::optional<std::string> page_before(const std::string& before, const std::string& path) {
  static const std::regex page(R"(([^\s(]+\.md),? $)");
  static const std::regex of_others(R"((?:(?:RFC|ISO/IEC) [0-9-]+,?|",) $)");
  std::smatch found;
  if (std::regex_search(before, found, page)) return found[1];
  if (std::regex_search(before, of_others)) return std::nullopt;
  return path;
}

std::vector<std::string> violations(const std::string& path, std::string_view file,
                                    const Sections& pages) {
  // The second is the name of codec/bitstream.md in the notes of conformance cases.
  static const std::regex citation(
      R"((?:[Ss]ections? |fba_bitstream, )([0-9.]*[0-9](?:(?:, | and | to )[0-9.]*[0-9])*))");
  static const std::regex number("[0-9.]*[0-9]");
  std::vector<std::string> out;
  const Running all = running(file);
  for (std::size_t at = 0; at < all.text.size(); ++at) {
    at = all.text.find_first_of("Ssf", at);
    if (at == std::string::npos) break;
    const auto begin = all.text.begin() + std::ptrdiff_t(at);
    const auto end = all.text.size() - at > 80 ? begin + 80 : all.text.end();
    std::smatch found;
    if (!std::regex_search(begin, end, found, citation, std::regex_constants::match_continuous)) {
      continue;
    }
    const std::size_t context = at < 80 ? 0 : at - 80;
    const std::optional<std::string> page =
        *begin == 'f' ? "codec/bitstream.md"
                      : page_before(all.text.substr(context, at - context), path);
    if (!page) continue;
    const std::string where = path + ":" + std::to_string(all.line[at]) + ": ";
    const auto known = pages.find(*page);
    if (known == pages.end() || known->second.empty()) {
      out.push_back(where + "whose section? " + found.str());
      continue;
    }
    const std::string numbers = found[1];
    for (std::sregex_iterator n(numbers.begin(), numbers.end(), number), none; n != none; ++n) {
      if (known->second.count(n->str()) == 0) {
        out.push_back(where + *page + " has no section " + n->str());
      }
    }
  }
  return out;
}

TEST(Citations, NameSectionsThatExist) {
  Sections pages;
  for (const SourceFile& file : tree()) {
    if (file.path.ends_with(".md")) pages[file.path] = sections_of(file.text);
  }
  std::vector<std::string> wrong;
  for (const SourceFile& file : tree()) {
    if (file.path == "tests/structure/citations_test.cpp") continue;
    const bool prose = file.path.ends_with(".md") || file.path.ends_with("/case.json");
    if (!prose && !is_code(file.path)) continue;
    const std::vector<std::string> found = violations(file.path, file.text, pages);
    wrong.insert(wrong.end(), found.begin(), found.end());
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(CitationRules, Fire) {
  const Sections pages = {{"a/b.md", {"1", "2.1"}}, {"codec/bitstream.md", {"4"}}, {"c.md", {}}};
  const auto wrong = [&](const char* text) { return violations("x.h", text, pages); };
  EXPECT_THAT(wrong("// See a/b.md, section 2.1.\n"), IsEmpty());
  EXPECT_THAT(wrong("// See a/b.md, section 2.2.\n"),
              ElementsAre("x.h:1: a/b.md has no section 2.2"));
  EXPECT_THAT(wrong("\n/// (`a/b.md`,\n  /// sections 1,\n  /// 3 and 2.1)\n"),
              ElementsAre("x.h:3: a/b.md has no section 3"));
  EXPECT_THAT(wrong("// a/gone.md, section 1\n"), ElementsAre(HasSubstr("whose section?")));
  EXPECT_THAT(wrong("// c.md, section 1\n"), SizeIs(1));
  EXPECT_THAT(wrong("// section 1\n"), SizeIs(1));
  EXPECT_THAT(wrong("// a/b, section 1\n"), SizeIs(1));
  EXPECT_THAT(wrong("// RFC 3550 section 6.4, RFC 6716, section 3.1\n"), IsEmpty());
  EXPECT_THAT(wrong("// RFC 3550 section 6.4; section 9\n"), SizeIs(1));
  EXPECT_THAT(wrong("\"note\": \"fba_bitstream, 4 and 15.1\"\n"), SizeIs(1));
  EXPECT_THAT(violations("a/b.md", "as section 2.1 has it, section 3 not", pages), SizeIs(1));
}

TEST(CitationRules, ReadHeadings) {
  EXPECT_THAT(sections_of("# Title\n\n## 1 One\ntext 2 two\n### 2.1 Sub\n#5 no\n"),
              ElementsAre("1", "2.1"));
}

}  // namespace citations_test
}  // namespace animeme::test

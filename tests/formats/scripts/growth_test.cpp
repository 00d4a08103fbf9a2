// Reading takes as long as a script is: no character makes it look at the rest again and again.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "tests/support/growth.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::scripts {
namespace growth_test {

std::string repeated(const std::string& pattern, std::size_t bytes) {
  std::string text;
  while (text.size() + pattern.size() <= bytes) text += pattern;
  return text;
}

struct Wrap {
  const char* name;
  const char* head;
  const char* tail;
};

// What stands around the text in each format, and nothing, where the text is the file.
constexpr Wrap kWraps[] = {
    {"", "", ""},
    {"srt", "1\n00:00:00,000 --> 00:00:05,000\n", "\n"},
    {"vtt", "WEBVTT\n\n00:00.000 --> 00:05.000\n", "\n"},
    {"two cues", "WEBVTT\n\n00:00.000 --> 00:05.000\na\nb\n\n00:05.000 --> 00:09.000\n", "\n"},
    {"lrc", "[00:00.00]", ">\n[00:05.00]\n"},
    {"ttml", "<tt xmlns=\"http://www.w3.org/ns/ttml\"><body><div><p begin=\"0s\" end=\"5s\">",
     "</p></div></body></tt>"},
    {"json", R"([{"start": 0, "end": 5, "word": ")", "\"}]"},
    {"labels", "0.0 0.5 SIL\n0.5 5.0 ", "\n"},
    {"TextGrid",
     "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\nxmin = 0\nxmax = 5\ntiers? "
     "<exists>\n"
     "size = 1\nitem []:\n item [1]:\n class = \"IntervalTier\"\n name = \"words\"\n xmin = 0\n"
     " xmax = 5\n intervals: size = 1\n intervals [1]:\n xmin = 0\n xmax = 5\n text = \"",
     "\"\n"},
    {"ass",
     "[Script Info]\n[Events]\nFormat: Layer, Start, End, Style, Name, MarginL, MarginR, MarginV, "
     "Effect, Text\nDialogue: 0,0:00:00.00,0:00:05.00,Default,,0,0,0,,",
     "}\n"},
};

std::vector<std::string> patterns() {
  std::vector<std::string> all;
  for (const char c : std::string("a1 \t\n<>{}[]()&;:,.\"'\\/-_#|~=+*?!%@")) all.emplace_back(1, c);
  for (const char* more :
       {"< ",    "<a>",      "</",      "<u>a",    "{\\",  "{\\k1}",  "&a",   "&#1;",
        "&amp;", "[a",       "[00:01]", "<00:01>", "(a",   "a)",      "[a]",  "a\n",
        "a b\n", "1 2 a\n",  "1,",      "-->",     "\n\n", "<!--",    "<p>",  "a[",
        "1:",    "\xC3\xA4", "\xFF",    "\"a\",",  "\\\"", "0 1 a\n", "a(2)", "*a*",
        "♪",     "<v a>",    "a;",      "1.",      "a-"}) {
    all.emplace_back(more);
  }
  return all;
}

TEST(Growth, ReadingTakesAsLongAsTheScript) {
  for (const Wrap& wrap : kWraps) {
    for (const std::string& pattern : patterns()) {
      const auto read = [&](std::size_t bytes) {
        const auto labels = read_labels(wrap.head + repeated(pattern, bytes) + wrap.tail, {});
        EXPECT_TRUE(labels || !labels.error().message.empty());
      };
      // Up to 48,000 bytes of one cue, which is within what is read.
      EXPECT_LT(test::growth(read, 12'000), test::kMoreThanLinear)
          << wrap.name << " of " << pattern;
    }
  }
}

}  // namespace growth_test
}  // namespace animeme::scripts

// Reading takes as long as a script is: no character makes it look at the rest again and again.
#include <gtest/gtest.h>

#include <ctime>

#include <algorithm>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::scripts {
namespace growth_test {

double cpu_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

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

// The least of three: what another program takes of the caches is not ours.
double cost(const Wrap& wrap, const std::string& pattern, std::size_t bytes, int tries) {
  const std::string text = wrap.head + repeated(pattern, bytes) + wrap.tail;
  double least = 1e9;
  for (int i = 0; i < tries; ++i) {
    const double begun = cpu_seconds();
    const auto read = read_labels(text, {});
    EXPECT_TRUE(read || !read.error().message.empty());
    least = std::min(least, cpu_seconds() - begun);
  }
  return least;
}

TEST(Growth, ReadingTakesAsLongAsTheScript) {
  constexpr std::size_t kShort = 12'000, kLong = 48'000;  // of one cue, within what is read
  constexpr double kQuick = 0.1;                          // seconds, which says nothing of growth
  for (const Wrap& wrap : kWraps) {
    for (const std::string& pattern : patterns()) {
      const double long_once = cost(wrap, pattern, kLong, 1);
      if (long_once < kQuick) continue;
      // Twice a doubling of at most 2.5 each.
      const double ratio = cost(wrap, pattern, kLong, 3) / cost(wrap, pattern, kShort, 3);
      EXPECT_LE(ratio, 2.5 * 2.5) << wrap.name << " of " << pattern << ": " << long_once << " s";
    }
  }
}

}  // namespace growth_test
}  // namespace animeme::scripts
